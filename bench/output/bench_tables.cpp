#include "bench/output/bench_tables.h"

#include "bench/measuring/figures.h"
#include "core/base/hash.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace tetrace {

namespace {

Cell text_or_nothing(const std::string& text)
{
    return text.empty() ? Cell() : Cell(text);
}

SetupTimes setup_of(const RowRun& row)
{
    return row.session ? row.session->setup_times() : SetupTimes{};
}

Cell milliseconds(double seconds)
{
    return seconds > 0 ? Cell(1e3 * seconds) : Cell();
}

Cell milliseconds(const std::optional<double>& seconds)
{
    return seconds ? Cell(1e3 * *seconds) : Cell();
}

/// The rows' numbers, ordered by device; rows that were not opened come last.
std::vector<std::size_t> by_device(const BenchResult& result)
{
    const auto& rows = result.run.rows;
    std::vector<std::size_t> places(rows.size()), order(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        places[i] = device_of(rows[i], result.devices).value_or(result.devices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
    return order;
}

/// What rows are shown under: those of one heading may be ranked with each other.
std::string heading_of(const RowRun& row, const std::vector<RowDevice>& devices)
{
    if (!device_of(row, devices)) return "not run";
    if (row.device.type == "emulated") return "emulated by the processor, not to be ranked with GPUs";
    return fmt::format("{} ({})", row.device.name, row.device.type);
}

/// Heads the rows that are added one after the other, where what they run on changes.
class Headings {
public:
    Headings(Table& table, const BenchResult& result) : table_(&table), result_(&result)
    {
        std::set<std::string> all;
        for (const RowRun& row : result.run.rows)
            all.insert(heading_of(row, result.devices));
        needed_ = all.size() > 1;
    }

    void before(const RowRun& row)
    {
        std::string heading = heading_of(row, result_->devices);
        if (needed_ && heading != last_) table_->add_heading(heading);
        last_ = std::move(heading);
    }

private:
    Table* table_;
    const BenchResult* result_;
    bool needed_ = false;
    std::string last_;
};

std::string status_text(const RowRun& row)
{
    std::string text(name_of(status_of(row)));
    if (status_of(row) == Status::flawed) text += ": " + reason_of(row);
    const auto figures = figures_of(row);
    if (figures && figures->kernel_s.noisy()) text += ", noisy";
    return text;
}

std::string comparison_text(const Comparison& comparison)
{
    const MedianRatio& rate = comparison.rate;
    return fmt::format("{:5.2f} [{:.2f}, {:.2f}]", rate.value, rate.low, rate.high);
}

/// "x openmp", or "x reference" where the rows have several.
std::string comparison_title(const BenchResult& result)
{
    std::set<std::string> references;
    for (const auto& comparison : result.comparisons)
        if (comparison) references.insert(comparison->reference->key.backend);
    return references.size() == 1 ? "x " + *references.begin() : "x reference";
}

Cell comparison_cell(const std::optional<Comparison>& comparison)
{
    return comparison ? Cell(comparison_text(*comparison)) : Cell();
}

Cell percent(const std::optional<double>& share, int decimals)
{
    return share ? Cell(fmt::format("{:{}.{}f} %", 100 * *share, 3 + decimals, decimals)) : Cell();
}

} // namespace

Table rate_table(const std::string& scene, const BenchResult& result)
{
    Table table({{"row", "row"},
                 {"backend", "backend"},
                 {"mrays", "Mrays/s"},
                 {"msteps", "Msteps/s", {}, 1},
                 {"comparison", comparison_title(result)},
                 {"single", "x single"},
                 {"copy", "of copy"},
                 {"spread", "spread"},
                 {"status", "status"}});
    Headings headings(table, result);
    for (const std::size_t i : by_device(result)) {
        const RowRun& row = result.run.rows[i];
        if (row.key.scene != scene) continue;
        const auto figures = figures_of(row);
        headings.before(row);
        table.add({kernel_title(row.key), device_label(row.key), figures ? Cell(figures->mrays_per_s) : Cell(),
                   figures ? cell_of(figures->msteps_per_s) : Cell(), comparison_cell(result.comparisons.at(i)),
                   cell_of(ratio_to_single(row, result.run.rows)), percent(share_of_copy(row, result.devices), 0),
                   figures ? percent(figures->kernel_s.spread(), 1) : Cell(), status_text(row)});
    }
    return table;
}

Table time_table(const BenchResult& result)
{
    Table table({{"row", "row"},
                 {"backend", "backend"},
                 {"compile", "compile", "ms", 1},
                 {"cached", "cached"},
                 {"upload", "upload", "ms", 1},
                 {"first", "first", "ms", 1},
                 {"kernel", "kernel", "ms", 1},
                 {"overhead", "launch", "ms", 2},
                 {"download", "download", "ms", 1},
                 {"wall", "wall", "ms", 1},
                 {"bytes", "size", "MB", 1}});
    for (const auto& scene : result.run.scenes) {
        table.add_heading(scene->label());
        for (const std::size_t i : by_device(result)) {
            const RowRun& row = result.run.rows[i];
            const auto figures = figures_of(row);
            if (row.key.scene != scene->label() || !figures) continue;
            const SetupTimes setup = setup_of(row);
            table.add({kernel_title(row.key), device_label(row.key), milliseconds(setup.compile_s + setup.build_s),
                       setup.compile_cached ? Cell("yes") : Cell(), milliseconds(setup.upload_s),
                       milliseconds(traced(row)->wall_s), milliseconds(figures->kernel_s.median),
                       milliseconds(figures->overhead_s), milliseconds(traced(row)->download_s),
                       milliseconds(figures->wall_s),
                       row.session ? Cell(1e-6 * static_cast<double>(row.session->bytes())) : Cell()});
        }
    }
    return table;
}

Table device_table(const std::vector<RowDevice>& devices)
{
    Table table({{"backend", "backend"},
                 {"implementation", "device"},
                 {"type", "type"},
                 {"copy", "copy", "GB/s", 1},
                 {"launch", "launch", "us", 1},
                 {"self_test", "self-test"},
                 {"division", "division", "ulp"},
                 {"square_root", "root", "ulp"},
                 {"denormals", "denormals"},
                 {"problem", "problem"}});
    std::optional<std::size_t> hardware;
    for (const RowDevice& device : devices) {
        if (hardware != device.hardware) table.add_heading(device.device.name);
        hardware = device.hardware;
        const SelfTest* test = device.self_tests.empty() ? nullptr : &device.self_tests.begin()->second;
        const std::string verdict = test != nullptr ? test->text().substr(0, test->text().find(';')) : "";
        table.add({device_label({{}, device.backend->name(), {}, {}, {}, device.index}), device.device.implementation,
                   device.device.type, device.yardstick ? Cell(1e-9 * device.yardstick->copy_bytes_per_s) : Cell(),
                   device.yardstick ? Cell(1e6 * device.yardstick->launch_s) : Cell(), text_or_nothing(verdict),
                   test != nullptr ? Cell(std::uint64_t{test->division_ulps}) : Cell(),
                   test != nullptr ? Cell(std::uint64_t{test->square_root_ulps}) : Cell(),
                   test != nullptr ? Cell(test->denormals_kept ? "kept" : "flushed") : Cell(),
                   text_or_nothing(device.problem)});
    }
    return table;
}

Table flat_table(const BenchResult& result)
{
    Table table({{"name", "name"},
                 {"scene", "scene"},
                 {"structure", "structure"},
                 {"method", "method"},
                 {"layout", "layout"},
                 {"backend", "backend"},
                 {"device", "device"},
                 {"type", "type"},
                 {"rays", "rays"},
                 {"math", "math"},
                 {"order", "order"},
                 {"status", "status"},
                 {"reason", "reason"},
                 {"mrays_per_s", "rate", "Mrays/s"},
                 {"msteps_per_s", "rate", "Msteps/s", 1},
                 {"mean_steps", "steps per ray"},
                 {"mean_steps_hit", "steps per hit"},
                 {"mean_steps_miss", "steps per miss"},
                 {"ratio", "ratio to reference"},
                 {"ratio_low", "low"},
                 {"ratio_high", "high"},
                 {"reference", "reference"},
                 {"ratio_to_single", "ratio to Embree single"},
                 {"estimated_gb_per_s", "estimated", "GB/s", 1},
                 {"share_of_copy_bandwidth", "share of copy"},
                 {"bytes", "size", "bytes"},
                 {"compile_s", "compile", "s", 6},
                 {"upload_s", "upload", "s", 6},
                 {"first_wall_s", "first", "s", 6},
                 {"median_s", "median", "s", 6},
                 {"spread", "spread", {}, 3},
                 {"overhead_s", "launch overhead", "s", 6},
                 {"download_s", "download", "s", 6},
                 {"wall_s", "wall", "s", 6},
                 {"samples", "samples"},
                 {"ray_count", "rays traced"},
                 {"hit_count", "hits"},
                 {"ties", "ties"},
                 {"wrong", "wrong"},
                 {"lost", "lost"},
                 {"hit_hash", "hit hash"}});
    for (std::size_t i = 0; i < result.run.rows.size(); ++i) {
        const RowRun& row = result.run.rows[i];
        const auto& comparison = result.comparisons.at(i);
        const SetupTimes setup = setup_of(row);
        const auto figures = figures_of(row);
        const Traced* trace = traced(row);
        const MeanSteps mean = trace ? mean_steps(trace->totals) : MeanSteps{};
        const auto count = [&](std::uint64_t value) { return trace ? Cell(value) : Cell(); };
        const auto text = [](std::string_view value) { return Cell(std::string(value)); };
        const std::string reason = reason_of(row);
        const RayTotals totals = trace ? trace->totals : RayTotals{};
        const Verdicts verdicts = trace ? trace->verdicts : Verdicts{};
        table.add({row_name(row.key),
                   row.key.scene,
                   text(name_of(row.key.kernel.structure)),
                   text(name_of(row.key.kernel.method)),
                   text(name_of(row.key.kernel.layout)),
                   row.key.backend,
                   text_or_nothing(row.device.name),
                   text_or_nothing(row.device.type),
                   text(name_of(row.key.rays)),
                   text(name_of(row.key.kernel.math)),
                   text(name_of(row.key.order)),
                   text(name_of(status_of(row))),
                   text_or_nothing(reason),
                   figures ? Cell(figures->mrays_per_s) : Cell(),
                   figures ? cell_of(figures->msteps_per_s) : Cell(),
                   cell_of(mean.all),
                   cell_of(mean.hit),
                   cell_of(mean.miss),
                   comparison ? Cell(comparison->rate.value) : Cell(),
                   comparison ? Cell(comparison->rate.low) : Cell(),
                   comparison ? Cell(comparison->rate.high) : Cell(),
                   comparison ? Cell(row_name(comparison->reference->key)) : Cell(),
                   cell_of(ratio_to_single(row, result.run.rows)),
                   figures ? cell_of(figures->gb_per_s) : Cell(),
                   cell_of(share_of_copy(row, result.devices)),
                   row.session ? Cell(row.session->bytes()) : Cell(),
                   setup.compile_s > 0 ? Cell(setup.compile_s) : Cell(),
                   setup.upload_s > 0 ? Cell(setup.upload_s) : Cell(),
                   trace ? Cell(trace->wall_s) : Cell(),
                   figures ? Cell(figures->kernel_s.median) : Cell(),
                   figures ? Cell(figures->kernel_s.spread()) : Cell(),
                   figures ? cell_of(figures->overhead_s) : Cell(),
                   trace ? Cell(trace->download_s) : Cell(),
                   figures ? cell_of(figures->wall_s) : Cell(),
                   std::uint64_t{row.samples_s.size()},
                   count(totals.rays),
                   count(totals.hits),
                   count(verdicts.ties),
                   count(verdicts.wrong),
                   count(verdicts.lost),
                   trace ? Cell(hash_text(trace->hit_hash)) : Cell()});
    }
    return table;
}

} // namespace tetrace
