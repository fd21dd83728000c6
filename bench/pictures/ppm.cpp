#include "bench/pictures/ppm.h"

#include "core/base/error.h"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace tetrace {

std::string ppm_bytes(const Pixmap& pixmap)
{
    std::string bytes = fmt::format("P6\n{} {}\n255\n", pixmap.width, pixmap.height);
    for (const Colour& colour : pixmap.pixels)
        for (const float channel : {colour.r, colour.g, colour.b})
            bytes += static_cast<char>(to_srgb(channel));
    return bytes;
}

void write_ppm(const std::filesystem::path& path, const Pixmap& pixmap)
{
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << ppm_bytes(pixmap);
    file.close();
    if (!file)
        throw Error(ErrorKind::invalid_input, fmt::format("writing the picture {}: {}; name another file with --out",
                                                          path.string(), std::strerror(errno)));
}

} // namespace tetrace
