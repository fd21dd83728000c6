#pragma once

#include "bench/pictures/pixmap.h"

#include <filesystem>

// The one function of the images module, with C linkage. The module is a shared object of its own: OpenImageIO brings
// some 260 libraries, which must not be in the process that measures.
extern "C" {
/// Writes width * height * 3 floats of linear light to a file: `.png` as 8 bits of sRGB, `.exr` as linear halves.
/// Returns 0, or another number with a text in error (error_size bytes, always terminated).
int tetrace_write_image(const char* path, unsigned width, unsigned height, const float* linear_rgb, char* error,
                        unsigned error_size);
}

namespace tetrace {

/// Whether the images module is in the folder of the running program. It may still fail to load.
[[nodiscard]] bool has_images_module();

/// Writes pictures through the images module, which it loads when it is made.
class ImageWriter {
public:
    /// Loads the module from the folder of the running program.
    /// Throws Error{missing} naming the package to install where it is missing.
    ImageWriter();
    explicit ImageWriter(const std::filesystem::path& module);

    /// Writes a PNG or an EXR file, as the extension says. Throws Error{invalid_input} naming the file and the reason.
    void write(const std::filesystem::path& path, const Pixmap& pixmap) const;

private:
    decltype(&tetrace_write_image) write_image_;
};

} // namespace tetrace
