#pragma once

#include "bench/measuring/row_recorder.h"
#include "bench/measuring/verify.h"

namespace tetrace {

/// Records the views of one scene.
class ViewRecorder : public RowRecorder {
public:
    /// Called with each record of an image before it is kept, and with its hits.
    using Examined = std::function<void(const SeenImage&, ImageRecord&)>;

    /// rows: of the scene, opened. verifier: null for a merged journal. See RowRecorder for the others.
    ViewRecorder(std::vector<RowRun*> rows, std::vector<std::vector<ImageRecord>>& images, Verifier* verifier,
                 SceneWork& scene, unsigned samples, double sample_s, const Recording& shared, Examined examined = {})
        : RowRecorder(std::move(rows), images, samples, sample_s, shared), verifier_(verifier), scene_(&scene),
          examined_(std::move(examined))
    {
    }

    /// Records all views that restore() has not taken. After an interrupt, rows and scene keep the views that all rows
    /// have completed.
    void run();

private:
    [[nodiscard]] nlohmann::json head_of(std::size_t view) const override;
    [[nodiscard]] bool is_ours(const nlohmann::json& entry) const override;
    void check_entry(std::size_t view, const nlohmann::json& entry) const override;
    [[nodiscard]] std::string name_of_part(std::size_t view) const override;
    [[nodiscard]] std::size_t rays_of(const RowRun& row, std::size_t view) const override;
    [[nodiscard]] std::vector<TraceJob> prepare(RowRun& row, std::size_t view) override;
    [[nodiscard]] std::optional<TraceJob> pulse_job(RowRun& row) override;
    [[nodiscard]] ImageRecord examine(std::size_t row, std::size_t view) override;
    [[nodiscard]] std::uint64_t hash_of_answers(RowRun& row, std::size_t view) override;
    [[nodiscard]] std::uint64_t repeat(RowRun& row, std::size_t view) override;

    Verifier* verifier_;
    SceneWork* scene_;
    Examined examined_;
    std::vector<Hit> hits_;
};

/// Called after each image.
using ImageSeen = std::function<void(const SeenImage&)>;

/// Traces every view of a scene once with each of its rows, and judges each ray (see Verifier). Then traces the first
/// view again: its hits must be the same. Rows that cannot be traced end with their reason.
/// rows: all of one scene, opened. shared: the journal, and the budget, which gets the time of each step.
void verify_rows(const std::vector<RowRun*>& rows, SceneWork& scene, const Options& options,
                 const ImageSeen& image_seen = {}, const Recording& shared = {});

} // namespace tetrace
