#include "bench/report/png.h"

#include "bench/report/html/html.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>

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

/// A PNG file's bytes: colour type 2, 8 bits a channel, not interlaced.
/// rgb: 3 width height bytes of sRGB, row after row from the top. Throws Error{internal} if their number differs.
/// Source: Portable Network Graphics (PNG) Specification, W3C, third edition.
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

constexpr std::uintmax_t max_file = std::uintmax_t{64} << 20;
constexpr std::string_view signature("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);

/// Why a file is not a picture.
struct Problem {
    ErrorKind kind;
    std::string why;
};

Problem not_valid(const std::string& why)
{
    return {ErrorKind::invalid_input, why};
}

/// Four bytes, most significant first.
std::uint32_t word_at(const std::string& bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word = word << 8 | static_cast<unsigned char>(bytes[offset + i]);
    return word;
}

bool is_size(std::uint32_t width, std::uint32_t height)
{
    return width >= 1 && height >= 1 && width <= 65535 && height <= 65535;
}

Png converted(const std::string& ppm)
{
    std::istringstream head(ppm.substr(0, 64));
    std::string kind;
    std::uint32_t width = 0, height = 0, levels = 0;
    head >> kind >> width >> height >> levels;
    if (!head || kind != "P6" || levels != 255 || std::isspace(head.peek()) == 0)
        throw not_valid("it is neither PNG nor PPM; 'tetrace render --out PICTURE.png' writes one");
    if (!is_size(width, height)) throw not_valid(fmt::format("its header says {} x {} pixels", width, height));
    const std::string_view pixels = std::string_view(ppm).substr(static_cast<std::size_t>(head.tellg()) + 1);
    if (pixels.size() != std::size_t{3} * width * height)
        throw not_valid(fmt::format("its data does not match its header's {} x {} pixels", width, height));
    return {png_bytes(width, height, pixels), width, height};
}

std::string picture_bytes(const std::filesystem::path& path)
{
    std::error_code problem;
    if (!std::filesystem::exists(path, problem)) throw Problem{ErrorKind::missing, "the file does not exist"};
    if (!std::filesystem::is_regular_file(path, problem)) throw not_valid("it is not a file");
    if (std::filesystem::file_size(path, problem) > max_file) throw not_valid("it is larger than 64 MiB");
    auto bytes = file_bytes(path);
    if (!bytes) throw not_valid(std::strerror(errno));
    return *std::move(bytes);
}

/// Throws Problem.
Png picture_of(const std::filesystem::path& path)
{
    Png png{picture_bytes(path), 0, 0};
    if (png.bytes.size() < signature.size() + 8 || png.bytes.compare(0, signature.size(), signature) != 0)
        return converted(png.bytes);
    png.width = word_at(png.bytes, signature.size());
    png.height = word_at(png.bytes, signature.size() + 4);
    if (!is_size(png.width, png.height))
        throw not_valid(fmt::format("its header says {} x {} pixels", png.width, png.height));
    return png;
}

Html shown(const Png& png, const std::string& name)
{
    return figure("",
                  element("img", {{"src", "data:image/png;base64," + base64(png.bytes)},
                                  {"alt", name},
                                  {"width", std::to_string(png.width)},
                                  {"height", std::to_string(png.height)}}),
                  name);
}

} // namespace

std::string deflated(const std::string& plain)
{
    std::string packed(compressBound(static_cast<uLong>(plain.size())), '\0');
    uLongf size = packed.size();
    if (compress(reinterpret_cast<Bytef*>(packed.data()), &size, zlib_bytes(plain), static_cast<uLong>(plain.size())) !=
        Z_OK)
        throw Error(ErrorKind::internal, "deflated: zlib could not compress");
    packed.resize(size);
    return packed;
}

Png read_picture(const std::filesystem::path& path)
{
    try {
        return picture_of(path);
    } catch (const Problem& problem) {
        throw Error(problem.kind, fmt::format("reading the picture '{}': {}", path.string(), problem.why));
    }
}

Html picture_figure(const std::filesystem::path& path)
{
    return shown(read_picture(path), path.stem().string());
}

Html named_picture(const std::filesystem::path& folder, const std::string& name)
{
    try {
        return shown(picture_of(folder / name), std::filesystem::path(name).stem().string());
    } catch (const Problem& problem) {
        return note(fmt::format("The picture '{}', which the result names, is not shown: {}.", name, problem.why));
    }
}

} // namespace tetrace
