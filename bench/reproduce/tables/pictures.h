#pragma once

#include "bench/pictures/images.h"
#include "bench/reproduce/scene_run.h"

#include <filesystem>
#include <string>

namespace tetrace {

/// The picture of a view, darkened, with marks on the pixels of its wrong and lost rays that are larger than the
/// pixels.
/// flawed: pixels (y * width + x). Throws as shade_hits() does.
[[nodiscard]] Pixmap draw_flawed(std::span<const Hit> hits, std::span<const std::uint32_t> flawed,
                                 const SceneWork& scene, std::size_t view);

/// Writes a result's pictures into the result's folder; their names start with the result file's stem.
class ResultPictures {
public:
    /// result: the result's file.
    explicit ResultPictures(std::filesystem::path result);

    /// Draws the pictures that tables and figures show of a scene whose views are traced: for each method the view with
    /// the most wrong and lost rays and, for the first method, surface and steps of the views with the fewest and the
    /// most tets. The run records pictures that cannot be made.
    void draw(SceneRun& run, bool flawed, bool extremes) const;

private:
    /// Does nothing if the row has no such ray in any view.
    void draw_worst(SceneRun& run, std::size_t row) const;
    void draw_view(SceneRun& run, std::size_t row, std::size_t view) const;
    [[nodiscard]] std::string write(const SceneRun& run, std::size_t view, const std::string& kind,
                                    const Pixmap& pixmap) const;

    std::filesystem::path result_;
    std::string ending_;
    PictureWriter writer_;
};

} // namespace tetrace
