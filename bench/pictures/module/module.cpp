// The images module: all of tetrace that knows OpenImageIO. Loaded by bench/pictures/images.cpp.
#include "bench/pictures/images.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

OIIO::ImageSpec spec_of(unsigned width, unsigned height, const OIIO::TypeDesc& type, const char* colour_space)
{
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, type);
    spec.attribute("oiio:ColorSpace", colour_space);
    spec.attribute("Software", "tetrace");
    return spec;
}

void write(const std::string& path, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type, const void* pixels)
{
    const auto output = OIIO::ImageOutput::create(path);
    if (!output) {
        throw std::runtime_error(OIIO::geterror());
    }
    if (!output->open(path, spec) || !output->write_image(type, pixels) || !output->close()) {
        throw std::runtime_error(output->geterror());
    }
}

void write_png(const std::string& path, unsigned width, unsigned height, const float* linear_rgb)
{
    std::vector<unsigned char> bytes(std::size_t{width} * height * 3);
    std::transform(linear_rgb, linear_rgb + bytes.size(), bytes.begin(), tetrace::to_srgb);
    write(path, spec_of(width, height, OIIO::TypeDesc::UINT8, "sRGB"), OIIO::TypeDesc::UINT8, bytes.data());
}

void write_exr(const std::string& path, unsigned width, unsigned height, const float* linear_rgb)
{
    write(path, spec_of(width, height, OIIO::TypeDesc::HALF, "Linear"), OIIO::TypeDesc::FLOAT, linear_rgb);
}

void write_by_extension(const std::string& path, unsigned width, unsigned height, const float* linear_rgb)
{
    const std::string extension = std::filesystem::path(path).extension().string();
    if (width == 0 || height == 0) {
        throw std::runtime_error("the picture has no pixels");
    }
    if (extension == ".png") {
        write_png(path, width, height, linear_rgb);
    } else if (extension == ".exr") {
        write_exr(path, width, height, linear_rgb);
    } else {
        throw std::runtime_error("the name must end in .png or .exr");
    }
}

} // namespace

extern "C" int tetrace_write_image(const char* path, unsigned width, unsigned height, const float* linear_rgb,
                                   char* error, unsigned error_size)
{
    try {
        write_by_extension(path, width, height, linear_rgb);
        return 0;
    } catch (const std::exception& failure) { // nothing may be thrown through a C function
        std::snprintf(error, error_size, "%s", failure.what());
        return 1;
    }
}
