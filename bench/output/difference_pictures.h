#pragma once

#include "bench/measuring/verify.h"
#include "bench/pictures/images.h"

#include <filesystem>
#include <vector>

namespace tetrace {

/// openmp's picture of a view, darkened, with the pixels marked where the hits differ.
/// hits, reference: row after row, of the scene's size. Throws Error{internal} as shade_hits() does.
[[nodiscard]] Pixmap draw_differences(std::span<const Hit> hits, std::span<const Hit> reference, Allowance allowed,
                                      const SceneWork& scene, std::size_t view);

/// Writes such a picture for each image that differs into a folder: PNG, or PPM without the images module.
class DifferencePictures {
public:
    /// Makes the folder. Throws Error{invalid_input} naming it where it cannot be made.
    explicit DifferencePictures(std::filesystem::path folder);

    /// Writes nothing if the image equals openmp's. Throws as PictureWriter::write() does.
    void see(const SeenImage& image);
    [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

private:
    std::filesystem::path folder_;
    std::string ending_;
    PictureWriter writer_;
    std::vector<std::filesystem::path> files_;
};

} // namespace tetrace
