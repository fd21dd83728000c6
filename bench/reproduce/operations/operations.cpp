#include "bench/reproduce/operations/operations.h"

#include "bench/reproduce/operations/counted_methods.h"
#include "core/base/error.h"
#include "core/rays/search_set.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

using Search = void (*)(const PackedScene& packed, std::uint32_t tet, std::uint32_t entry, Float3 origin,
                        Float3 direction);
using Start = void (*)(const PackedScene& packed, std::uint32_t tet, Float3 origin, Float3 direction);

/// How a method's operations are made up (docs/spec/methods.md, M2).
struct Products {
    int shared, each;
};

struct CountingMethod {
    Method method;
    Search search;
    Start start;
    std::optional<Products> products;       ///< of a search
    std::optional<Products> start_products; ///< of a start
};

#define COUNTING(name)                                                                                                 \
    Method::name,                                                                                                      \
        [](const PackedScene& packed, std::uint32_t tet, std::uint32_t entry, Float3 origin, Float3 direction) {       \
            using namespace counted::name;                                                                             \
            const auto ray = make_ray(to_vec3(origin), to_vec3(direction));                                            \
            Counted::operations = 0; /* the ray's moment is once a ray */                                              \
            (void)exit_face(view_of(packed), tet, entry, ray);                                                         \
        },                                                                                                             \
        [](const PackedScene& packed, std::uint32_t tet, Float3 origin, Float3 direction) {                            \
            using namespace counted::name;                                                                             \
            const auto ray = make_ray(to_vec3(origin), to_vec3(direction));                                            \
            Counted::operations = 0;                                                                                   \
            (void)start_face(view_of(packed), tet, ray);                                                               \
        }

/// A product of Plücker coordinates is 3 operations for the edge, 9 for its moment and 11; of stp 3 for a vertex
/// and 14. maria shares the moment at the apex, 12, and takes 3 + 5 a product; a start takes 3 + 9 + 3 + 5.
const std::vector<CountingMethod>& methods()
{
    static constexpr Products start{0, 20};
    static const std::vector<CountingMethod> list = {{COUNTING(plane), {}, {}},
                                                     {COUNTING(plucker), Products{0, 23}, start},
                                                     {COUNTING(stp), Products{0, 17}, start},
                                                     {COUNTING(ms06), Products{0, 23}, start},
                                                     {COUNTING(maria), Products{12, 8}, start},
                                                     {COUNTING(project), Products{0, 23}, {}}};
    return list;
}

double products_in(int operations, const Products& products, Method method)
{
    const int rest = operations - products.shared;
    if (rest % products.each != 0)
        throw Error(ErrorKind::internal, fmt::format("{} operations of {} are not a whole number of side products",
                                                     operations, name_of(method)));
    return static_cast<double>(rest / products.each);
}

Float3 float_of(const Quad& quad)
{
    return {std::bit_cast<float>(quad.x), std::bit_cast<float>(quad.y), std::bit_cast<float>(quad.z)};
}

/// Sums over searches.
class Counts {
public:
    explicit Counts(const CountingMethod& method) : method_(&method) {}

    void add(const PackedScene& tets, const SearchRays& rays, std::size_t number, Float3 inside)
    {
        const Float3 direction = float_of(rays.quads[number]), origin = float_of(rays.quads[rays.count() + number]);
        const std::uint32_t half_face = rays.half_face(number);
        method_->search(tets, half_face_tet(half_face), half_face_index(half_face), origin, direction);
        const int operations = Counted::operations;
        cost_.least = searches_ == 0 ? operations : std::min(cost_.least, operations);
        cost_.most = std::max(cost_.most, operations);
        sum_ += operations;
        squares_ += static_cast<double>(operations) * operations;
        if (method_->products) products_ += products_in(operations, *method_->products, method_->method);
        method_->start(tets, half_face_tet(half_face), inside, direction);
        start_ += Counted::operations;
        if (method_->start_products)
            start_products_ += products_in(Counted::operations, *method_->start_products, method_->method);
        ++searches_;
    }

    [[nodiscard]] MethodCost cost() const
    {
        const auto count = static_cast<double>(searches_);
        MethodCost cost = cost_;
        cost.method = method_->method;
        cost.mean = sum_ / count;
        cost.mean_error = std::sqrt(std::max(squares_ / count - cost.mean * cost.mean, 0.0) / count);
        cost.start = start_ / count;
        if (method_->products) {
            cost.products = products_ / count;
            cost.products_error = cost.mean_error / method_->products->each;
            cost.max_products = products_in(cost.most, *method_->products, method_->method);
        }
        if (method_->start_products) cost.start_products = start_products_ / count;
        return cost;
    }

private:
    const CountingMethod* method_;
    MethodCost cost_;
    std::size_t searches_ = 0;
    double sum_ = 0, squares_ = 0, products_ = 0, start_ = 0, start_products_ = 0;
};

/// The middle of a tet of the set.
Float3 middle_of(const PackedScene& tets, std::uint32_t tet)
{
    Float3 middle{};
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
        const auto at = counted::maria::vertex(counted::maria::view_of(tets), tet, corner);
        middle = {middle.x + 0.25f * at.x.value, middle.y + 0.25f * at.y.value, middle.z + 0.25f * at.z.value};
    }
    return middle;
}

} // namespace

std::vector<MethodCost> count_operations()
{
    const PackedScene tets = search_tets(counted_tets, Layout::tet96);
    const SearchRays rays = search_rays(0, counted_tets, counted_rays);
    std::vector<MethodCost> costs;
    for (const CountingMethod& method : methods()) {
        Counts counts(method);
        for (std::size_t number = 0; number < rays.count(); ++number)
            counts.add(tets, rays, number, middle_of(tets, half_face_tet(rays.half_face(number))));
        costs.push_back(counts.cost());
    }
    return costs;
}

double tet_bytes(Layout layout)
{
    return static_cast<double>(search_tets(2, layout).bytes() - search_tets(1, layout).bytes());
}

} // namespace tetrace
