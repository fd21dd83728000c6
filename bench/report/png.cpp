#include "bench/report/png.h"

#include "bench/report/html_table.h"
#include "core/error.h"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace tetrace {

namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{64} << 20;
constexpr std::string_view signature("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);

[[noreturn]] void reject(const std::filesystem::path& path, ErrorKind kind, const std::string& why)
{
    throw Error(kind, fmt::format("reading the picture '{}': {}", path.string(), why));
}

/// Four bytes, the highest first.
std::uint32_t word_at(const std::string& bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word = word << 8 | static_cast<unsigned char>(bytes[offset + i]);
    return word;
}

} // namespace

Png read_png(const std::filesystem::path& path)
{
    std::error_code problem;
    if (!std::filesystem::exists(path, problem)) reject(path, ErrorKind::missing, "there is no such file");
    if (!std::filesystem::is_regular_file(path, problem)) reject(path, ErrorKind::invalid_input, "it is no file");
    if (std::filesystem::file_size(path, problem) > largest_file)
        reject(path, ErrorKind::invalid_input, "it is larger than 64 MiB");
    std::ifstream file(path, std::ios::binary);
    if (!file) reject(path, ErrorKind::invalid_input, std::strerror(errno));
    Png png{{std::istreambuf_iterator<char>(file), {}}, 0, 0};
    if (png.bytes.size() < signature.size() + 8 || png.bytes.compare(0, signature.size(), signature) != 0)
        reject(path, ErrorKind::invalid_input, "it is no PNG; 'tetrace render --out PICTURE.png' writes one");
    png.width = word_at(png.bytes, signature.size());
    png.height = word_at(png.bytes, signature.size() + 4);
    if (png.width == 0 || png.height == 0 || png.width > 65535 || png.height > 65535)
        reject(path, ErrorKind::invalid_input, fmt::format("it says to be {} x {} pixels", png.width, png.height));
    return png;
}

Html picture_figure(const std::filesystem::path& path)
{
    const Png png = read_png(path);
    const std::string name = path.stem().string();
    return figure("",
                  element("img", {{"src", "data:image/png;base64," + base64(png.bytes)},
                                  {"alt", name},
                                  {"width", std::to_string(png.width)},
                                  {"height", std::to_string(png.height)}}),
                  name);
}

} // namespace tetrace
