#include "bench/pictures/images.h"

#include "core/base/error.h"

#include <array>
#include <dlfcn.h>
#include <fmt/format.h>

namespace tetrace {

namespace {

std::filesystem::path module_beside_program()
{
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "tetrace_images.so";
}

[[noreturn]] void module_missing(const std::filesystem::path& module, const std::string& reason)
{
    throw Error(
        ErrorKind::missing,
        fmt::format(
            "cannot write pictures: loading the images module {}: {}. It is built where OpenImageIO is "
            "installed: install the package libopenimageio-dev, configure and build again; pictures that end in .ppm "
            "need no module",
            module.string(), reason));
}

} // namespace

bool has_images_module()
{
    return std::filesystem::exists(module_beside_program());
}

ImageWriter::ImageWriter() : ImageWriter(module_beside_program()) {}

// The module stays loaded to the end of the process: OpenImageIO keeps threads of its own.
ImageWriter::ImageWriter(const std::filesystem::path& module)
{
    if (!std::filesystem::exists(module)) {
        module_missing(module, "no such file");
    }
    void* const handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const function = handle != nullptr ? dlsym(handle, "tetrace_write_image") : nullptr;
    if (function == nullptr) {
        module_missing(module, dlerror());
    }
    write_image_ = reinterpret_cast<decltype(write_image_)>(function);
}

void ImageWriter::write(const std::filesystem::path& path, const Pixmap& pixmap) const
{
    std::array<char, 512> reason{};
    if (write_image_(path.c_str(), pixmap.width, pixmap.height, reinterpret_cast<const float*>(pixmap.pixels.data()),
                     reason.data(), static_cast<unsigned>(reason.size())) != 0) {
        throw Error(ErrorKind::invalid_input, fmt::format("writing the picture {}: {}", path.string(), reason.data()));
    }
}

} // namespace tetrace
