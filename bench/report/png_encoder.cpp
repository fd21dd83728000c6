#include "bench/report/png_encoder.h"

#include "core/base/error.h"

#include <zlib.h>

namespace tetrace {

namespace {

std::string word_bytes(std::uint32_t word)
{
    std::string bytes;
    for (const int shift : {24, 16, 8, 0})
        bytes += static_cast<char>(word >> shift & 0xFF);
    return bytes;
}

const Bytef* zlib_bytes(const std::string& bytes)
{
    return reinterpret_cast<const Bytef*>(bytes.data());
}

/// Length, type, data, and the checksum of type and data.
std::string chunk(const std::string& type, const std::string& data)
{
    const std::string content = type + data;
    const uLong sum = crc32(0, zlib_bytes(content), static_cast<uInt>(content.size()));
    return word_bytes(static_cast<std::uint32_t>(data.size())) + content + word_bytes(static_cast<std::uint32_t>(sum));
}

std::string deflated(const std::string& plain)
{
    std::string packed(compressBound(static_cast<uLong>(plain.size())), '\0');
    uLongf size = packed.size();
    if (compress(reinterpret_cast<Bytef*>(packed.data()), &size, zlib_bytes(plain), static_cast<uLong>(plain.size())) !=
        Z_OK)
        throw Error(ErrorKind::internal, "png_bytes: zlib could not compress the pixels");
    packed.resize(size);
    return packed;
}

} // namespace

std::string png_bytes(std::uint32_t width, std::uint32_t height, std::string_view rgb)
{
    const std::size_t row = std::size_t{3} * width;
    if (rgb.size() != row * height) throw Error(ErrorKind::internal, "png_bytes: not the pixels of that size");
    std::string lines;
    lines.reserve(rgb.size() + height);
    for (std::size_t y = 0; y < height; ++y)
        lines.append(1, '\0').append(rgb.substr(y * row, row)); // 0: unfiltered pixels
    const std::string head = word_bytes(width) + word_bytes(height) + std::string("\x08\x02\0\0\0", 5);
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + chunk("IDAT", deflated(lines)) + chunk("IEND", {});
}

} // namespace tetrace
