#pragma once

#include "bench/options/option_table.h"
#include "bench/options/option_values.h"

#include <algorithm>

namespace tetrace {

// What options do with their values. Each throws Error{usage} where it does not accept one, and lists what it accepts.

/// Appends the value with that name.
template <class T>
[[nodiscard]] ApplyOption append(std::string option, std::vector<T> Options::*list,
                                 std::vector<T> accepted = values_of<T>())
{
    return {
        [=](Options& options, const std::string& text) { (options.*list).push_back(choose(option, text, accepted)); },
        all_names(accepted)};
}

/// The value with that name.
template <class T, class Member>
[[nodiscard]] ApplyOption set_choice(std::string option, Member Options::*member)
{
    return {[=](Options& options, const std::string& text) { options.*member = choose<T>(option, text); },
            all_names<T>()};
}

/// The same; "all" means every value.
template <class T>
[[nodiscard]] ApplyOption append_or_all(std::string option, std::vector<T> Options::*list, std::vector<T> accepted)
{
    std::vector<std::string> names = all_names(accepted);
    names.insert(names.begin(), "all");
    return {[=](Options& options, const std::string& text) {
                if (std::ranges::find(names, text) == names.end()) reject_name(option, text, names);
                for (const T& value : accepted)
                    if (text == "all" || text == name_of(value)) (options.*list).push_back(value);
            },
            names};
}

/// Appends the name of a backend.
[[nodiscard]] ApplyOption append_backend(const std::string& option, std::vector<std::string> Options::*list);

[[nodiscard]] ApplyOption set(bool Options::*flag);
/// A whole number in [low, high].
[[nodiscard]] ApplyOption set_count(const std::string& option, unsigned Options::*count, unsigned low, unsigned high);
[[nodiscard]] ApplyOption append_count(const std::string& option, std::vector<unsigned> Options::*list, unsigned low,
                                       unsigned high);
/// A time of parse_seconds(), and a size of parse_bytes().
[[nodiscard]] ApplyOption set_seconds(const std::string& option, double Options::*seconds);
[[nodiscard]] ApplyOption set_bytes(const std::string& option, std::uint64_t Options::*bytes);
/// Any text.
[[nodiscard]] ApplyOption append_text(std::vector<std::string> Options::*list);
/// A file's name, not empty.
[[nodiscard]] ApplyOption set_path(const std::string& option, std::optional<std::filesystem::path> Options::*path);
/// Names of files, not empty.
[[nodiscard]] ApplyOption append_path(const std::string& option, std::vector<std::filesystem::path> Options::*list);
/// 'all' is every scene that is available (all_scenes()).
[[nodiscard]] ApplyOption append_scenes();

/// A set of tetrace's by its name, or the user's own from a file.
[[nodiscard]] ApplyOption set_cameras();
/// Of --out; "-" means none for a result.
[[nodiscard]] ApplyOption set_out();

} // namespace tetrace
