// The images module: all of tetrace that knows OpenImageIO. Loaded by bench/pictures/images.cpp.
#include "bench/pictures/images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

OIIO::ImageSpec spec_of(unsigned width, unsigned height, int channels, const OIIO::TypeDesc& type)
{
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), channels, type);
    spec.attribute("Software", "tetrace");
    return spec;
}

OIIO::ImageSpec spec_of_colours(unsigned width, unsigned height, const OIIO::TypeDesc& type, const char* colour_space)
{
    OIIO::ImageSpec spec = spec_of(width, height, 3, type);
    spec.attribute("oiio:ColorSpace", colour_space);
    return spec;
}

/// Its channels are the members of tetrace::HitPixel.
OIIO::ImageSpec spec_of_hits(unsigned width, unsigned height)
{
    const OIIO::TypeDesc real = OIIO::TypeDesc::FLOAT, whole = OIIO::TypeDesc::UINT32;
    OIIO::ImageSpec spec = spec_of(width, height, 6, real);
    spec.channelnames = {"t", "steps", "normal.x", "normal.y", "normal.z", "face"};
    spec.channelformats = {real, whole, real, real, real, whole};
    return spec;
}

using Bytes = std::vector<unsigned char>;

/// ending: decides the format. type: of the channels of pixels; UNKNOWN: as the spec has them.
Bytes encoded(const std::string& ending, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type, const void* pixels)
{
    const std::string name = "picture" + ending;
    const auto output = OIIO::ImageOutput::create(name);
    if (!output) {
        throw std::runtime_error(OIIO::geterror());
    }
    OIIO::Filesystem::IOVecOutput memory;
    if (!output->set_ioproxy(&memory) || !output->open(name, spec) || !output->write_image(type, pixels) ||
        !output->close()) {
        throw std::runtime_error(output->geterror());
    }
    return memory.buffer();
}

Bytes encoded_png(unsigned width, unsigned height, const void* pixels)
{
    const auto* const linear_rgb = static_cast<const float*>(pixels);
    Bytes channels(std::size_t{width} * height * 3);
    std::transform(linear_rgb, linear_rgb + channels.size(), channels.begin(), tetrace::to_srgb);
    return encoded(".png", spec_of_colours(width, height, OIIO::TypeDesc::UINT8, "sRGB"), OIIO::TypeDesc::UINT8,
                   channels.data());
}

Bytes encoded_exr(unsigned width, unsigned height, const void* pixels)
{
    return encoded(".exr", spec_of_colours(width, height, OIIO::TypeDesc::HALF, "Linear"), OIIO::TypeDesc::FLOAT,
                   pixels);
}

Bytes encoded_hits(unsigned width, unsigned height, const void* pixels)
{
    return encoded(".exr", spec_of_hits(width, height), OIIO::TypeDesc::UNKNOWN, pixels);
}

Bytes encoded_by_form(const std::string& form, unsigned width, unsigned height, const void* pixels)
{
    if (width == 0 || height == 0) {
        throw std::runtime_error("the picture is empty");
    }
    if (form == ".png") {
        return encoded_png(width, height, pixels);
    }
    if (form == ".exr") {
        return encoded_exr(width, height, pixels);
    }
    if (form == tetrace::hits_form) {
        return encoded_hits(width, height, pixels);
    }
    throw std::runtime_error("the name must end in .png or .exr");
}

} // namespace

extern "C" int tetrace_encode_image(const char* form, unsigned width, unsigned height, const void* pixels,
                                    void (*take)(void* receiver, const char* bytes, unsigned long size), void* receiver,
                                    char* error, unsigned error_size)
{
    try {
        const Bytes bytes = encoded_by_form(form, width, height, pixels);
        take(receiver, reinterpret_cast<const char*>(bytes.data()), bytes.size());
        return 0;
    } catch (const std::exception& failure) { // nothing may be thrown through a C function
        std::snprintf(error, error_size, "%s", failure.what());
        return 1;
    }
}
