#include "bench/options/apply_option.h"

#include "core/device/backend.h"

#include <regex>

namespace tetrace {

namespace {

std::vector<std::string> backend_names()
{
    std::vector<std::string> names;
    for (const Backend* backend : all_backends())
        names.push_back(backend->name());
    return names;
}

} // namespace

ApplyOption append_backend(const std::string& option, std::vector<std::string> Options::*list)
{
    return [=](Options& options, const std::string& text) {
        const auto names = backend_names();
        if (std::ranges::find(names, text) == names.end()) reject_value(option, text, join_alternatives(names));
        (options.*list).push_back(text);
    };
}

void set_filter(Options& options, const std::string& text)
{
    try {
        const std::regex check(text);
    } catch (const std::regex_error& problem) {
        throw Error(ErrorKind::usage,
                    "--filter: '" + text + "' is not a regular expression (ECMAScript): " + problem.what());
    }
    options.filter = text;
}

ApplyOption set(bool Options::*flag)
{
    return [=](Options& options, const std::string&) { options.*flag = true; };
}

ApplyOption set_count(const std::string& option, unsigned Options::*count, unsigned low, unsigned high)
{
    return [=](Options& options, const std::string& text) {
        options.*count = static_cast<unsigned>(parse_count(option, text, low, high));
    };
}

ApplyOption append_count(const std::string& option, std::vector<unsigned> Options::*list, unsigned low, unsigned high)
{
    return [=](Options& options, const std::string& text) {
        (options.*list).push_back(static_cast<unsigned>(parse_count(option, text, low, high)));
    };
}

ApplyOption set_path(const std::string& option, std::optional<std::filesystem::path> Options::*path)
{
    return [=](Options& options, const std::string& text) {
        if (text.empty()) throw Error(ErrorKind::usage, option + ": the file name is empty");
        options.*path = text;
    };
}

void set_tile(Options& options, const std::string& text)
{
    if (text != "8x4" && text != "8x8") reject_value("--tile", text, "8x4 or 8x8");
    options.tile_height = text == "8x4" ? 4 : 8;
}

void set_packet_lanes(Options& options, const std::string& text)
{
    std::vector<std::string> accepted;
    for (const unsigned lanes : packet_widths) {
        accepted.push_back(std::to_string(lanes));
        if (text == accepted.back()) options.packet_lanes = lanes;
    }
    if (std::ranges::find(accepted, text) == accepted.end())
        reject_value("--packet-lanes", text, join_alternatives(accepted));
}

} // namespace tetrace
