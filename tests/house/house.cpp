#include "tests/house/house.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace tetrace::test {

namespace {

namespace fs = std::filesystem;

bool is_source(const fs::path& file)
{
    static const std::set<std::string> endings = {".h",     ".cpp",   ".cu",   ".cl",  ".comp", ".rgen",
                                                  ".rmiss", ".rchit", ".glsl", ".inc", ".in"};
    return endings.contains(file.extension().string());
}

void read_includes(const fs::path& root, const std::string& file, std::vector<Include>& includes)
{
    static const std::regex include("^\\s*#\\s*include \"([^\"]+)\"");
    std::ifstream stream(root / file);
    std::smatch match;
    for (std::string line; std::getline(stream, line);)
        if (std::regex_search(line, match, include)) includes.push_back({file, match[1]});
}

} // namespace

Sources read_sources(const fs::path& root)
{
    Sources sources;
    for (const char* floor : {"kernels", "core", "scenes", "backends", "embed", "bench", "tests"}) {
        if (!fs::exists(root / floor)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / floor)) {
            if (!entry.is_regular_file()) continue;
            const fs::path file = fs::relative(entry.path(), root);
            ++sources.files[file.parent_path().string()];
            if (is_source(file)) read_includes(root, file.string(), sources.includes);
        }
    }
    return sources;
}

House::House(const fs::path& table)
{
    std::ifstream stream(table);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        std::string room, arrow;
        if (!(words >> room >> arrow)) continue;
        std::vector<std::string>& to = arrows_[room];
        for (std::string other; words >> other;)
            to.push_back(other);
    }
}

bool House::covers(const std::string& arrow, const std::string& room)
{
    if (!arrow.ends_with("/*")) return arrow == room;
    return room.starts_with(arrow.substr(0, arrow.size() - 1));
}

const std::string* House::line_of(const std::string& room) const
{
    auto line = arrows_.find(room);
    if (line == arrows_.end()) line = arrows_.find(fs::path(room).parent_path() / "*");
    return line == arrows_.end() ? nullptr : &line->first;
}

bool House::allows(const std::string& from, const std::string& to) const
{
    return std::ranges::any_of(arrows_.at(*line_of(from)), [&](const std::string& arrow) { return covers(arrow, to); });
}

std::string House::listed_folder(const std::string& file) const
{
    for (fs::path folder = fs::path(file).parent_path(); !folder.empty(); folder = folder.parent_path())
        if (line_of(folder.string()) != nullptr) return folder.string();
    return {};
}

std::vector<std::string> House::forbidden(const std::vector<Include>& includes) const
{
    std::vector<std::string> problems;
    for (const Include& include : includes) {
        const std::string from = listed_folder(include.from), to = listed_folder(include.to);
        if (include.from.starts_with("tests/")) continue; // a test may include everything
        if (!from.empty() && (from == to || allows(from, to))) continue;
        problems.push_back(include.from + " includes " + include.to + ": " + from + " -> " + to +
                           " is not an allowed include (tests/house/arrows.txt)");
    }
    return problems;
}

std::vector<std::string> House::unused(const std::vector<Include>& includes) const
{
    std::set<std::pair<std::string, std::string>> needed;
    for (const Include& include : includes)
        if (const std::string* line = line_of(listed_folder(include.from)))
            needed.insert({*line, listed_folder(include.to)});
    std::vector<std::string> arrows;
    for (const auto& [from, list] : arrows_)
        for (const std::string& arrow : list)
            if (std::ranges::none_of(
                    needed, [&](const auto& pair) { return pair.first == from && covers(arrow, pair.second); }))
                arrows.push_back(from + " -> " + arrow);
    return arrows;
}

std::string House::circle() const
{
    for (const auto& [start, ignored] : arrows_) {
        std::set<std::string> seen;
        std::vector<std::string> open = {start};
        while (!open.empty()) {
            const std::string room = open.back();
            open.pop_back();
            for (const auto& [next, unused] : arrows_) {
                if (next == room || !allows(room, next)) continue;
                if (next == start) return start;
                if (seen.insert(next).second) open.push_back(next);
            }
        }
    }
    return {};
}

} // namespace tetrace::test
