#include "bench/options/identity.h"

#include "bench/options/commit.h"
#include "core/base/control_groups.h"
#include "core/base/printable.h"

#include <fmt/chrono.h>
#include <sched.h>
#include <sys/utsname.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace tetrace {

namespace {

/// The value on the first line that starts with `key`, without the key and surrounding quotes.
std::string value_in(const char* file, const std::string& key, char separator)
{
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind(key, 0) != 0) continue;
        std::string value = line.substr(line.find(separator) + 1);
        value.erase(0, value.find_first_not_of(" \t\""));
        value.erase(value.find_last_not_of(" \t\"") + 1);
        return printable_line(value);
    }
    return "unknown";
}

/// A number of /proc/cpuinfo; empty if there is none, as on ARM. The key ends in a tab there.
std::optional<unsigned> processor_number(const std::string& key)
{
    const std::string text = value_in("/proc/cpuinfo", key + "\t", ':');
    unsigned number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    return problem == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

} // namespace

BuildIdentity build_identity()
{
#if defined(__clang__)
    const char* const compiler = __VERSION__;
#else
    const char* const compiler = "GCC " __VERSION__;
#endif
    return {TETRACE_VERSION, TETRACE_COMMIT, compiler,
            TETRACE_FLAGS "; kernels exact: " TETRACE_FLAGS_EXACT "; kernels fast: " TETRACE_FLAGS_FAST,
            TETRACE_LIBRARIES};
}

namespace {

/// ", limited to 1.5 CPUs and 512 MB"; empty if there are no limits.
std::string limits_text(const ControlGroups& groups)
{
    std::vector<std::string> limits;
    if (const auto cpus = groups.cpus()) limits.push_back(fmt::format("{:.3g} CPUs", *cpus));
    if (const auto bytes = groups.memory_bytes()) limits.push_back(fmt::format("{} MB", *bytes / 1'000'000));
    return limits.empty() ? "" : fmt::format(", limited to {}", fmt::join(limits, " and "));
}

} // namespace

HostIdentity host_identity()
{
    const ControlGroups groups;
    utsname system{};
    uname(&system);
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    const bool known = sched_getaffinity(0, sizeof(allowed), &allowed) == 0;
    return {value_in("/proc/cpuinfo", "model name", ':'),
            processor_number("cpu family"),
            processor_number("model"),
            processor_number("stepping"),
            printable_line(fmt::format("{}, {} {}{}", value_in("/etc/os-release", "PRETTY_NAME=", '='), system.sysname,
                                       system.release, limits_text(groups))),
            std::min(known ? static_cast<unsigned>(CPU_COUNT(&allowed)) : 1u, groups.threads().value_or(~0u))};
}

std::string utc_now()
{
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

namespace {

constexpr std::string_view before_path = " \t\n'\"`([{<>=,:;|";
constexpr std::string_view after_path = " \t\n'\"`)]}<>,:;|&";

void replace_all(std::string& text, const std::string& what, const std::string& by)
{
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

/// Replaces the home folder by "~" where it is a whole path or its beginning, but not part of a longer name.
void shorten_home(std::string& text, const std::string& home)
{
    for (std::size_t at = text.find(home); at != std::string::npos; at = text.find(home, at + 1)) {
        const std::size_t end = at + home.size();
        if (end == text.size() || text[end] == '/' || after_path.find(text[end]) != std::string_view::npos)
            text.replace(at, home.size(), 1, '~');
    }
}

/// What remains of a path: its last part; nothing if that could be a person's folder, as in /home/name.
std::string last_part(std::string path)
{
    path.erase(path.find_last_not_of('/') + 1);
    const std::string name = std::filesystem::path(path).filename().string();
    const bool deep = std::ranges::count(path, '/') > 2;
    const bool has_ending = std::filesystem::path(name).has_extension();
    return deep || has_ending ? name : "(a folder)";
}

/// Whether a slash is that of "</name>", as JUnit has them, and not of a path in such brackets.
bool closes_element(const std::string& text, std::size_t slash)
{
    return slash > 0 && text[slash - 1] == '<' && text.find('/', slash + 1) > text.find('>', slash);
}

bool starts_path(const std::string& text, std::size_t at)
{
    if (closes_element(text, at)) return false;
    if (at > 0 && before_path.find(text[at - 1]) == std::string_view::npos) return false;
    const std::size_t slash = text[at] == '~' ? at + 1 : at;
    return slash + 1 < text.size() && text[slash] == '/' && text[slash + 1] != '/' &&
           after_path.find(text[slash + 1]) == std::string_view::npos;
}

/// One past the path's last character. A quoted path may contain blanks.
std::size_t path_end(const std::string& text, std::size_t at)
{
    const char before = at > 0 ? text[at - 1] : ' ';
    if (before == '\'' || before == '"') {
        const std::size_t quote = text.find(before, at);
        if (quote < text.find('\n', at)) return quote;
    }
    return std::min(text.find_first_of(after_path, at), text.size());
}

std::string without_folders(const std::string& text)
{
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        if (!starts_path(text, at)) {
            result += text[at++];
            continue;
        }
        const std::size_t end = path_end(text, at);
        result += last_part(text.substr(at, end - at));
        at = end;
    }
    return result;
}

std::vector<std::filesystem::path> named_paths(const Options& options)
{
    std::vector<std::filesystem::path> paths(options.scenes.begin(), options.scenes.end());
    paths.insert(paths.end(), options.files.begin(), options.files.end());
    paths.insert(paths.end(), options.expected.begin(), options.expected.end());
    for (const auto* path : {&options.out, &options.junit, &options.picture_folder, &options.array_folder,
                             &options.code_folder, &options.write_expected, &options.chart_folder,
                             &options.portability_csv, &options.ray_file, &options.hit_file})
        if (*path) paths.push_back(**path);
    if (options.own_cameras) paths.emplace_back(options.own_cameras->file);
    constexpr std::string_view out = "--benchmark_out=";
    for (const std::string& flag : options.benchmark_flags)
        if (flag.starts_with(out)) paths.emplace_back(flag.substr(out.size()));
    return paths;
}

void make_anonymous(nlohmann::json& value, const Options& options)
{
    if (value.is_string()) value = anonymous_text(value.get<std::string>(), options);
    if (value.is_structured())
        for (auto& part : value)
            make_anonymous(part, options);
}

} // namespace

std::string anonymous_text(const std::string& text, const Options& options)
{
    std::string result = text;
    for (std::filesystem::path path : named_paths(options)) {
        if (!path.has_filename()) path = path.parent_path(); // it ends in a slash
        if (path.has_parent_path() && path.has_filename()) replace_all(result, path.string(), path.filename().string());
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && std::string_view(home).size() > 1)
        shorten_home(result, home);
    return without_folders(result);
}

nlohmann::json anonymous_json(nlohmann::json result, const Options& options)
{
    make_anonymous(result, options);
    return result;
}

} // namespace tetrace
