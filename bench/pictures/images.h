#pragma once

#include "bench/options/options.h"
#include "bench/pictures/hit_layers.h"
#include "bench/pictures/pixmap.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What a picture shows; differs for each picture of a run.
struct PictureKey {
    std::string scene;
    std::uint32_t view = 0;
    Picture picture = Picture::normals;
};

/// The file of a picture: `out` itself where it is the run's only one, else with "-scene-view-kind" in front of its
/// ending; "scene-view-kind" with the given ending in the folder `out`, or in the current one without `out`.
[[nodiscard]] std::filesystem::path picture_path(const std::optional<std::filesystem::path>& out, const PictureKey& key,
                                                 const std::string& ending, bool only_picture);

/// The ending of all pictures of a run: that of the file `out`; else .png, or .ppm where nothing can write PNG.
[[nodiscard]] std::string picture_ending(const std::optional<std::filesystem::path>& out, bool can_write_png);

/// Throws Error{usage} if `out` is neither a folder nor has an ending that is accepted for all of the pictures.
void check_picture_ending(const std::optional<std::filesystem::path>& out, const std::vector<Picture>& pictures);

/// The picture as a PPM file's bytes (P6, 8 bits of sRGB per channel), which need no library.
/// Source: https://netpbm.sourceforge.net/doc/ppm.html.
[[nodiscard]] std::string ppm_bytes(const Pixmap& pixmap);

} // namespace tetrace

// The one function of the images module, with C linkage. The module is a separate shared object: OpenImageIO depends on
// some 260 libraries, which must not be in the process that measures.
extern "C" {
/// Makes an image file of width * height pixels. form: `.png`, 8 bits of sRGB, or `.exr`, linear halves, each of three
/// floats of linear light per pixel; or hits_form, of a HitPixel. Calls take once, with receiver and the file's bytes.
/// Nothing is written to a disk: OpenImageIO reports no error where one is full. Returns 0, or another number with a
/// text in error (error_size bytes, always terminated).
int tetrace_encode_image(const char* form, unsigned width, unsigned height, const void* pixels,
                         void (*take)(void* receiver, const char* bytes, unsigned long size), void* receiver,
                         char* error, unsigned error_size);
}

namespace tetrace {

/// An .exr of six channels of 32 bits: t, normal.x, normal.y and normal.z as floats, steps and face as unsigned
/// integers.
inline constexpr const char* hits_form = "hits.exr";

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
    /// The bytes of an .exr of hits.
    [[nodiscard]] std::string bytes(const HitLayers& layers) const;

private:
    [[nodiscard]] std::string encoded(const std::string& form, std::uint32_t width, std::uint32_t height,
                                      const void* pixels) const;

    decltype(&tetrace_encode_image) encode_image_;
};

/// Writes pictures of one file format; loads what that needs.
class PictureWriter {
public:
    /// ending: .ppm, which needs nothing; .png or .exr, which load the images module.
    /// Throws Error{missing} if the module is needed and missing.
    explicit PictureWriter(const std::string& ending);

    /// Throws Error{invalid_input} naming the file and the reason.
    void write(const std::filesystem::path& path, const Pixmap& pixmap) const;
    /// The same for hits. Precondition: the ending is not .ppm.
    void write(const std::filesystem::path& path, const HitLayers& layers) const;

private:
    std::optional<ImageEncoder> images_; ///< of all forms but .ppm
};

} // namespace tetrace
