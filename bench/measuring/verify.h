#pragma once

#include "bench/measuring/budget.h"
#include "bench/rows/row_run.h"

#include <functional>
#include <memory>
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
/// Called after each image.
using ImageSeen = std::function<void(const SeenImage&)>;

/// How much the row's answers may differ from openmp's: what its device's self-test allows.
[[nodiscard]] Allowance allowance_of(const RowRun& row);

/// openmp's row that the row must agree with; empty if there is nothing to compare with.
[[nodiscard]] std::optional<RowKey> reference_of(const RowKey& key);

/// One scene's verification, image by image, for callers that visit the images in their own order.
class Verifier {
public:
    /// budget: whose clock is read; must outlive the verifier.
    Verifier(SceneWork& scene, const Options& options, const Budget& budget = no_budget());
    ~Verifier();

    /// Traces a view (an index in SceneWork::views()) with an opened row and judges each ray, as verify_rows() does;
    /// leaves the row unchanged. Fastest where all rows of a view come before the next view.
    /// Throws what the session throws, and Error{wrong_result} where a ray was never written.
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

/// Traces every view of a scene once with each of its rows, and judges each ray by two questions: does the device
/// return what openmp returns (our kernels, exact mode), and is the method right (the oracle)? Then traces the first
/// view again: its hits must be the same. Rows that cannot be traced end with their reason.
/// After an interrupt, rows and scene keep the views that all rows have completed.
/// rows: all of one scene, opened. budget: gets the time of each step, and may skip rows.
void verify_rows(const std::vector<RowRun*>& rows, SceneWork& scene, const Options& options,
                 const ImageSeen& image_seen = {}, Budget& budget = no_budget());

} // namespace tetrace
