#include "bench/pictures/images.h"

#include "core/base/error.h"
#include "core/base/files.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>

namespace tetrace {

std::filesystem::path picture_path(const std::optional<std::filesystem::path>& out, const PictureKey& key,
                                   const std::string& ending, bool only_picture)
{
    const std::string name = fmt::format("{}-{}-{}", key.scene, key.view, name_of(key.picture));
    if (!out) return name + ending;
    if (std::filesystem::is_directory(*out)) return *out / (name + ending);
    if (only_picture) return *out;
    return out->parent_path() / fmt::format("{}-{}{}", out->stem().string(), name, ending);
}

std::string picture_ending(const std::optional<std::filesystem::path>& out, bool can_write_png)
{
    if (out && !std::filesystem::is_directory(*out)) return out->extension().string();
    return can_write_png ? ".png" : ".ppm";
}

void check_picture_ending(const std::optional<std::filesystem::path>& out, const std::vector<Picture>& pictures)
{
    if (!out || std::filesystem::is_directory(*out)) return;
    const std::string ending = out->extension().string();
    if (ending != ".png" && ending != ".exr" && ending != ".ppm")
        throw Error(ErrorKind::usage, fmt::format("--out '{}': accepted are a file that ends in .png, .exr or .ppm, or "
                                                  "a folder that is there",
                                                  out->string()));
    if (ending != ".exr" && writes_hits(pictures))
        throw Error(ErrorKind::usage,
                    fmt::format("--out '{}': --picture hits is written as .exr only; name a file that "
                                "ends in .exr, or a folder that is there",
                                out->string()));
}

std::string ppm_bytes(const Pixmap& pixmap)
{
    std::string bytes = fmt::format("P6\n{} {}\n255\n", pixmap.width, pixmap.height);
    for (const Colour& colour : pixmap.pixels)
        for (const float channel : {colour.r, colour.g, colour.b})
            bytes += static_cast<char>(to_srgb(channel));
    return bytes;
}

namespace {

std::filesystem::path module_beside_program()
{
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "tetrace_images.so";
}

[[noreturn]] void module_missing(const std::filesystem::path& module, const std::string& reason)
{
    throw Error(ErrorKind::missing,
                fmt::format("cannot write pictures: loading the images module {}: {}. It is built where OpenImageIO is "
                            "installed: install the package libopenimageio-dev, configure and build again; pictures "
                            "other than hits can end in .ppm, which needs no module",
                            module.string(), reason));
}

} // namespace

bool has_images_module()
{
    return std::filesystem::exists(module_beside_program());
}

ImageEncoder::ImageEncoder() : ImageEncoder(module_beside_program()) {}

// The module stays loaded to the end of the process: OpenImageIO keeps threads of its own.
ImageEncoder::ImageEncoder(const std::filesystem::path& module)
{
    if (!std::filesystem::exists(module)) {
        module_missing(module, "no such file");
    }
    void* const handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const function = handle != nullptr ? dlsym(handle, "tetrace_encode_image") : nullptr;
    if (function == nullptr) {
        module_missing(module, dlerror());
    }
    encode_image_ = reinterpret_cast<decltype(encode_image_)>(function);
}

std::string ImageEncoder::bytes(const std::string& ending, const Pixmap& pixmap) const
{
    return encoded(ending, pixmap.width, pixmap.height, pixmap.pixels.data());
}

std::string ImageEncoder::bytes(const HitLayers& layers) const
{
    return encoded(hits_form, layers.width, layers.height, layers.pixels.data());
}

std::string ImageEncoder::encoded(const std::string& form, std::uint32_t width, std::uint32_t height,
                                  const void* pixels) const
{
    std::string bytes;
    const auto take = [](void* receiver, const char* data, unsigned long size) {
        static_cast<std::string*>(receiver)->assign(data, size);
    };
    std::array<char, 512> reason{};
    if (encode_image_(form.c_str(), width, height, pixels, take, &bytes, reason.data(),
                      static_cast<unsigned>(reason.size())) != 0) {
        throw Error(ErrorKind::invalid_input, fmt::format("making a picture ({}): {}", form, reason.data()));
    }
    return bytes;
}

PictureWriter::PictureWriter(const std::string& ending)
{
    if (ending != ".ppm") images_.emplace();
}

void PictureWriter::write(const std::filesystem::path& path, const Pixmap& pixmap) const
{
    write_whole(path, images_ ? images_->bytes(path.extension().string(), pixmap) : ppm_bytes(pixmap));
}

void PictureWriter::write(const std::filesystem::path& path, const HitLayers& layers) const
{
    write_whole(path, images_.value().bytes(layers));
}

} // namespace tetrace
