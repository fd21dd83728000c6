#include "bench/pictures/ppm.h"

#include <fmt/format.h>

namespace tetrace {

std::string ppm_bytes(const Pixmap& pixmap)
{
    std::string bytes = fmt::format("P6\n{} {}\n255\n", pixmap.width, pixmap.height);
    for (const Colour& colour : pixmap.pixels)
        for (const float channel : {colour.r, colour.g, colour.b})
            bytes += static_cast<char>(to_srgb(channel));
    return bytes;
}

} // namespace tetrace
