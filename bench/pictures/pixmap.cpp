#include "bench/pictures/pixmap.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

// IEC 61966-2-1.
float decode_srgb(std::uint32_t byte)
{
    const double encoded = static_cast<double>(byte) / 255.0;
    return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

} // namespace

Colour from_srgb(std::uint32_t bytes)
{
    return {decode_srgb(bytes >> 16 & 0xFFu), decode_srgb(bytes >> 8 & 0xFFu), decode_srgb(bytes & 0xFFu)};
}

std::uint8_t to_srgb(float linear)
{
    const double light = linear > 0.0f ? std::min(static_cast<double>(linear), 1.0) : 0.0;
    const double encoded = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

Colour lost_colour()
{
    return {1.0f, 0.0f, 1.0f};
}

} // namespace tetrace
