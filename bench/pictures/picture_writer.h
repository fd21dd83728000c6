#pragma once

#include "bench/pictures/images.h"

#include <optional>

namespace tetrace {

/// Writes pictures of one file format; loads what that needs.
class PictureWriter {
public:
    /// ending: .ppm, which needs nothing; .png or .exr, which load the images module.
    /// Throws Error{missing} if the module is needed and missing.
    explicit PictureWriter(const std::string& ending);

    /// Throws Error{invalid_input} naming the file and the reason.
    void write(const std::filesystem::path& path, const Pixmap& pixmap) const;

private:
    std::optional<ImageEncoder> images_; ///< of all forms but .ppm
};

} // namespace tetrace
