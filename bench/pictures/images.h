#pragma once

#include "bench/pictures/pixmap.h"

#include <filesystem>
#include <string>

// The one function of the images module, with C linkage. The module is a separate shared object: OpenImageIO depends on
// some 260 libraries, which must not be in the process that measures.
extern "C" {
/// Makes an image file of width * height * 3 floats of linear light: ending `.png`, 8 bits of sRGB, or `.exr`, linear
/// halves. Calls take once, with receiver and the file's bytes. Nothing is written to a disk: OpenImageIO reports no
/// error where one is full. Returns 0, or another number with a text in error (error_size bytes, always terminated).
int tetrace_encode_image(const char* ending, unsigned width, unsigned height, const float* linear_rgb,
                         void (*take)(void* receiver, const char* bytes, unsigned long size), void* receiver,
                         char* error, unsigned error_size);
}

namespace tetrace {

/// Whether the images module is in the folder of the running program. It may still fail to load.
[[nodiscard]] bool has_images_module();

/// Makes picture files by the images module, which it loads when it is made.
class ImageEncoder {
public:
    /// Loads the module from the folder of the running program.
    /// Throws Error{missing} naming the package to install where it is missing.
    ImageEncoder();
    explicit ImageEncoder(const std::filesystem::path& module);

    /// The bytes of a file with this ending, .png or .exr. Throws Error{invalid_input} naming the reason.
    [[nodiscard]] std::string bytes(const std::string& ending, const Pixmap& pixmap) const;

private:
    decltype(&tetrace_encode_image) encode_image_;
};

} // namespace tetrace
