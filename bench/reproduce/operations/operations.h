#pragma once

#include "core/pack/kernel_id.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tetrace {

/// What an exit search of a method costs: floating-point additions, subtractions and multiplications, and side products
/// of the ray and an edge. Counted by the kernels themselves, compiled with numbers that count.
struct MethodCost {
    Method method{};
    int least = 0, most = 0; ///< operations of a search
    double mean = 0;
    double mean_error = 0;                ///< standard error of the mean over these searches
    std::optional<double> products;       ///< side products of a search, on average; empty if it has none (plane)
    double products_error = 0;            ///< standard error of that mean
    std::optional<double> max_products;   ///< of a single search
    std::optional<double> start_products; ///< in the tet where a ray starts
    double start = 0;                     ///< operations there, on average
};

/// Tets and rays that costs are counted over, of the set of random searches (core/rays/search_set.h).
inline constexpr std::uint32_t counted_tets = 500, counted_rays = 64;

/// The costs of the exit searches, in the order of all_kernels(). The same on every machine. Throws Error{internal}
/// if a count is not a whole number of side products.
[[nodiscard]] std::vector<MethodCost> count_operations();

/// Bytes by which a packed scene grows with a tet. layout: of tets that hold their corners.
[[nodiscard]] double tet_bytes(Layout layout);

} // namespace tetrace
