#include "bench/results/json_file.h"

#include "core/base/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace tetrace {

namespace {

// The largest result so far has 2.3 MB and 65,000 values. What a value takes in memory its text does not show: 60 MB of
// "[]," took 1.3 GB.
constexpr std::size_t max_file = std::size_t{64} << 20;
constexpr std::size_t max_values = 6'000'000;
constexpr int deepest = 64; // results have 12 levels; the library writes a value by a call a level

struct JsonFile {
    const std::filesystem::path& path;
    std::string_view what;

    [[noreturn]] void reject(ErrorKind kind, const std::string& why) const
    {
        throw Error(kind, fmt::format("reading the {} '{}': {}", what, path.string(), why));
    }
};

/// In pieces, not by its size: a pipe has none.
std::string bytes_of(const JsonFile& file)
{
    std::error_code ignored;
    if (!std::filesystem::exists(file.path, ignored)) file.reject(ErrorKind::missing, "the file does not exist");
    if (std::filesystem::is_directory(file.path, ignored)) file.reject(ErrorKind::invalid_input, "it is a folder");
    std::ifstream stream(file.path, std::ios::binary);
    if (!stream) file.reject(ErrorKind::invalid_input, std::strerror(errno));
    std::string bytes;
    std::vector<char> piece(1 << 16);
    while (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())), stream.gcount() > 0) {
        bytes.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
        if (bytes.size() > max_file)
            file.reject(ErrorKind::invalid_input, fmt::format("it is larger than 64 MiB, which no {} is", file.what));
    }
    if (stream.bad()) file.reject(ErrorKind::invalid_input, std::strerror(errno));
    return bytes;
}

/// The library's message from its place on; what it says before is its own bookkeeping.
std::string parse_message(const std::string& what)
{
    const std::size_t place = what.find("] ");
    return place == std::string::npos ? what : what.substr(place + 2);
}

} // namespace

nlohmann::json read_json(const std::filesystem::path& path, std::string_view what,
                         std::initializer_list<std::string_view> dropped)
{
    using Event = nlohmann::json::parse_event_t;
    const JsonFile file{path, what};
    const std::string bytes = bytes_of(file);
    if (bytes.empty()) file.reject(ErrorKind::invalid_input, "it is empty");
    try {
        std::size_t values = 0;
        return nlohmann::json::parse(bytes, [&](int depth, Event event, const nlohmann::json& parsed) {
            const bool is_value = event == Event::object_start || event == Event::array_start || event == Event::value;
            if (is_value && ++values > max_values)
                file.reject(ErrorKind::invalid_input,
                            fmt::format("it has more than 6,000,000 values, which no {} has", what));
            if (depth > deepest) file.reject(ErrorKind::invalid_input, "its values are nested deeper than 64 levels");
            const bool is_key = depth == 1 && event == Event::key;
            return !is_key || std::ranges::find(dropped, parsed.get<std::string_view>()) == dropped.end();
        });
    } catch (const nlohmann::json::exception& problem) {
        file.reject(ErrorKind::invalid_input,
                    fmt::format("it is not JSON, or was cut off: {}", parse_message(problem.what())));
    }
}

} // namespace tetrace
