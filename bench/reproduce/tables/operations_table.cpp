#include "bench/reproduce/operations/operations.h"
#include "bench/reproduce/tables/tables.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// What the paper says of a method's search; empty if it says nothing.
struct PapersCost {
    std::optional<double> operations, products, start_products;
};

PapersCost papers_cost(Method method)
{
    if (method == Method::maria) return {paper::maria_operations, paper::maria_products, paper::start_products};
    if (method == Method::ms06) return {{}, paper::ms06_products, {}};
    return {};
}

/// A mean over random searches, with its 95 % interval where searches differ.
Estimate mean_of(double mean, double error)
{
    if (error == 0) return {mean, {}, {}, true};
    return {mean, mean - 1.96 * error, mean + 1.96 * error, false};
}

PaperCell optional_cell(const std::optional<double>& ours, std::optional<double> papers)
{
    return ours ? exact_cell(*ours, papers) : PaperCell();
}

std::vector<PaperCell> cells_of(const MethodCost& cost)
{
    const PapersCost papers = papers_cost(cost.method);
    return {std::string(name_of(cost.method)),
            exact_cell(cost.least),
            Quantity{mean_of(cost.mean, cost.mean_error), papers.operations},
            exact_cell(cost.most),
            cost.products ? PaperCell(Quantity{mean_of(*cost.products, cost.products_error), papers.products})
                          : PaperCell(),
            optional_cell(cost.max_products, {}),
            exact_cell(cost.start),
            optional_cell(cost.start_products, papers.start_products)};
}

const MethodCost& cost_of(const std::vector<MethodCost>& costs, Method method)
{
    return *std::ranges::find(costs, method, &MethodCost::method);
}

ClaimVerdict verdict_of(bool holds)
{
    return holds ? ClaimVerdict::holds : ClaimVerdict::does_not_hold;
}

Claim products_claim(const MethodCost& maria)
{
    const bool holds = maria.products == paper::maria_products && maria.max_products == paper::maria_products;
    return {"maria-takes-two-side-products", "a search of maria takes exactly 2 side products", verdict_of(holds),
            fmt::format("{} on average, {} at most.", *maria.products, *maria.max_products)};
}

Claim operations_claim(const MethodCost& maria)
{
    const bool holds = maria.least == maria.most && maria.most == paper::maria_operations;
    return {"maria-takes-28-operations", "a search of maria takes 28 operations", verdict_of(holds),
            fmt::format("{} at least, {} at most.", maria.least, maria.most)};
}

Claim start_claim(const MethodCost& maria)
{
    return {"a-start-takes-three-side-products", "maria takes 3 side products in the tet where a ray starts",
            verdict_of(maria.start_products == paper::start_products),
            fmt::format("{} on average, in {} operations.", *maria.start_products, maria.start)};
}

/// Two side products of ms06 share nothing.
Claim saving_claim(const MethodCost& maria, const MethodCost& ms06)
{
    const double saved = 1 - maria.mean / ms06.least;
    return {"maria-saves-40-percent", "maria saves about 40 % of the operations of two independent side products",
            judge_equal(100 * saved, 40, 0.05),
            fmt::format("{:.1f} %: {} operations instead of {}, the paper's {}. Within 5 % of its share counts as "
                        "equal.",
                        100 * saved, maria.mean, ms06.least, paper::naive_operations)};
}

Claim ms06_claim(const MethodCost& ms06)
{
    const Estimate mean = mean_of(*ms06.products, ms06.products_error);
    const double reach = 0.01 * paper::ms06_products;
    return {"ms06-takes-2.67-side-products", "a search of ms06 takes 2.67 side products on average",
            judge_within({Estimate{mean.value - paper::ms06_products, *mean.low - paper::ms06_products,
                                   *mean.high - paper::ms06_products, false}},
                         reach),
            fmt::format("{}. Within 1 % counts as equal.", estimate_text(mean))};
}

Claim bytes_claim()
{
    const double cpu = tet_bytes(Layout::tet80), gpu = tet_bytes(Layout::tet96);
    return {"a-tet-takes-80-and-96-bytes", "a tet has 80 bytes on the CPU and 96 on the GPU",
            verdict_of(cpu == paper::cpu_tet_bytes && gpu == paper::gpu_tet_bytes),
            fmt::format("tet80 has {}, tet96 {}. A half-face is 30 bits for the tet and 2 for its face.", cpu, gpu)};
}

} // namespace

PaperTable operations_table()
{
    const std::vector<MethodCost> costs = count_operations();
    PaperTable table{"operations",
                     "Cost of an exit search",
                     fmt::format("{}, sections 3.1 and 3.4", paper::citation),
                     {{"method", "method"},
                      {"least_operations", "operations, min", "", 0},
                      {"operations", "mean", "", 2},
                      {"most_operations", "max", "", 0},
                      {"products", "side products", "", 3},
                      {"most_products", "max", "", 0},
                      {"start_operations", "operations of a start", "", 1},
                      {"start_products", "side products of a start", "", 2}},
                     {fmt::format("Counted by the kernels themselves, compiled with numbers that count additions, "
                                  "subtractions and multiplications, over {} random tets of table5 and {} rays "
                                  "through each: layout tet96, the same on every machine. Intervals are of the mean "
                                  "over random searches. docs/spec/methods.md, M2, describes the parts of a search.",
                                  counted_tets, counted_rays),
                      "plane has no side products; project uses signs, and a start needs six."}};
    for (const MethodCost& cost : costs)
        table.rows.push_back(cells_of(cost));
    const MethodCost &maria = cost_of(costs, Method::maria), &ms06 = cost_of(costs, Method::ms06);
    table.claims = {products_claim(maria), operations_claim(maria),   start_claim(maria),
                    ms06_claim(ms06),      saving_claim(maria, ms06), bytes_claim()};
    return table;
}

} // namespace tetrace
