#include "core/device/defects.h"

#include "core/device/stressors.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <system_error>

namespace tetrace {

namespace {

constexpr std::uint32_t word_count = 64;

std::uint32_t own_number(std::uint32_t item)
{
    return item;
}

std::uint32_t after_70000_steps(std::uint32_t value)
{
    for (int i = 0; i < 70000; ++i)
        value = value * 1664525u + 1013904223u;
    return value;
}

/// The same walk in one loop. Word i is i.
std::uint32_t counted_steps(std::uint32_t item)
{
    const std::uint32_t end = 24 + 3 * item;
    std::uint32_t at = item;
    for (std::uint32_t step = 0; step < end; ++step)
        at = (at + 11 + (at % 7 == 0 ? 1 : 0)) % word_count;
    return end * word_count + at;
}

} // namespace

std::span<const Defect> all_defects()
{
    static const std::vector<Defect> defects = [] {
        std::vector<Defect> all = {
            {"value_after_divergent_loop",
             "a value that is loaded in a loop which items leave at different times, and used after it",
             "lavapipe of Mesa 22.3", own_number},
            {"loop_of_70000_iterations", "a loop of more than 65,535 iterations", "lavapipe of Mesa 22.3",
             after_70000_steps},
            {"steps_of_nested_loops", "steps counted in nested loops, the inner of which ends at a tie",
             "lavapipe of Mesa 22.3", counted_steps},
        };
        const auto stressing = all_stressors();
        all.insert(all.end(), stressing.begin(), stressing.end());
        return all;
    }();
    return defects;
}

/// Of a launch: what Vulkan guarantees.
constexpr std::uint32_t max_groups = 65'535;

std::optional<ChosenDefect> chosen_defect(std::string_view text)
{
    const auto colon = text.find(':');
    const auto defects = all_defects();
    const auto defect = std::ranges::find(defects, text.substr(0, colon), &Defect::name);
    if (defect == defects.end()) return std::nullopt;
    if (colon == std::string_view::npos) return ChosenDefect{&*defect, defect->case_launch()};
    DefectLaunch launch;
    const char* const end = text.data() + text.size();
    const auto items = std::from_chars(text.data() + colon + 1, end, launch.items);
    if (items.ec != std::errc() || items.ptr == end || *items.ptr != ':') return std::nullopt;
    const auto group = std::from_chars(items.ptr + 1, end, launch.group_items);
    const DefectLaunch& largest = defect->launches().back();
    const bool is_within = launch.items >= 1 && launch.items <= largest.items && launch.group_items >= 1 &&
                           launch.group_items <= largest.group_items && launch.groups() <= max_groups;
    if (group.ec != std::errc() || group.ptr != end || !is_within) return std::nullopt;
    return ChosenDefect{&*defect, launch};
}

std::vector<std::uint32_t> defect_words()
{
    std::vector<std::uint32_t> counting(word_count);
    std::iota(counting.begin(), counting.end(), 0u);
    return counting;
}

std::span<const DefectLaunch> Defect::launches() const
{
    // Every device has groups of 128 items. The last group of a million has fewer.
    static constexpr DefectLaunch reduced[] = {{16, 16}};
    static constexpr DefectLaunch stressing[] = {{1, 1}, {64, 64}, {4096, 32}, {4096, 128}, {1'000'000, 128}};
    if (is_stressor) return stressing;
    return reduced;
}

DefectLaunch Defect::case_launch() const
{
    return is_stressor ? DefectLaunch{64, 64} : DefectLaunch{};
}

std::vector<std::uint32_t> expected_words(const Defect& defect, std::uint32_t items)
{
    std::vector<std::uint32_t> words;
    for (std::uint32_t item = 0; item < items; ++item)
        words.push_back(defect.expected(item));
    return words;
}

std::vector<std::uint32_t> wrong_items(const Defect& defect, std::uint32_t items, std::span<const std::uint32_t> found)
{
    const auto is_right = [&](std::uint32_t item) {
        return found[item] == defect.expected(item) ||
               (defect.is_flushed != nullptr && defect.is_flushed(item, found[item]));
    };
    std::vector<std::uint32_t> wrong;
    for (std::uint32_t item = 0; item < items; ++item)
        if (found.size() != items || !is_right(item)) wrong.push_back(item);
    return wrong;
}

} // namespace tetrace
