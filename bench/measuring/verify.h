#pragma once

#include "bench/rows/row_run.h"
#include "bench/rows/row_tracing.h"
#include "bench/truth/crossings.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace tetrace {

/// A verified image.
struct SeenImage {
    const RowRun& row;
    std::size_t view; ///< index in SceneWork::views()
    std::span<const Hit> hits;
    std::span<const Hit> reference; ///< openmp's; empty if there was nothing to compare
    const ImageVerdict& verdict;
};

/// How much the row's answers may differ from openmp's: what its device's self-test allows.
[[nodiscard]] Allowance allowance_of(const RowRun& row);

/// openmp's row that the row must agree with; empty if there is nothing to compare with.
[[nodiscard]] std::optional<RowKey> reference_of(const RowKey& key);

/// openmp's walk of each ray of a view (an index in SceneWork::views()), tet by tet, for a row of a task that crosses
/// tets. The row, and its scene, must outlive it. Throws Error{internal} if openmp has no such kernel.
[[nodiscard]] std::function<CrossedTets(std::size_t)> walks_of(const RowRun& row, std::size_t view);

/// One scene's verification, image by image, for callers that visit the images in their own order.
class Verifier {
public:
    /// clock: the host's; tests of budgets pass their own.
    Verifier(SceneWork& scene, const Options& options, Clock clock = host_clock());
    ~Verifier();

    /// Traces a view (an index in SceneWork::views()) with an opened row and judges each ray by two questions: does the
    /// device return what openmp returns (our kernels, exact mode), and is the method right (the oracle)? Leaves the
    /// row unchanged. Fastest where all rows of a view come before the next view. Throws what the session throws, and
    /// Error{wrong_result} where a ray was never written.
    [[nodiscard]] ImageVerdict verify(RowRun& row, std::size_t view);
    /// Traces a view without judging; returns the hash of its hits.
    [[nodiscard]] std::uint64_t trace(RowRun& row, std::size_t view);
    [[nodiscard]] std::span<const Hit> hits() const; ///< of the last verify() or trace()
    [[nodiscard]] std::span<const Hit>
    reference() const; ///< openmp's, of the last verify(); empty if there was nothing to compare

private:
    class Parts;
    std::unique_ptr<Parts> parts_;
};

/// What a row's rays of a view (an index in SceneWork::views()) visit in a BVH, counted by openmp's counting build of
/// the kernels. Empty for rows of other structures, of Embree and of other backends, whose answers are openmp's. hits:
/// the row's own. Throws Error{internal} if the counting build's answers differ.
[[nodiscard]] Visits count_visits(const RowRun& row, std::size_t view, std::span<const Hit> hits, unsigned threads);

/// The same of one of these rays.
[[nodiscard]] Visits count_visits_of_ray(const RowRun& row, std::size_t view, std::span<const Hit> hits,
                                         std::size_t ray, unsigned threads);

/// Of each ray of a view, as openmp traces it through a row's BVH, on whatever device the row is. Empty for rows of
/// other structures and of Embree.
[[nodiscard]] std::vector<Visits> visits_by_ray(const RowRun& row, std::size_t view, unsigned threads);

} // namespace tetrace
