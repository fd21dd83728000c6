#include "core/device/defects.h"

#include "core/base/control_groups.h"
#include "core/base/error.h"
#include "core/device/backend.h"
#include "core/device/stressors.h"
#include "kernels/layouts/defect_words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <numeric>
#include <string>
#include <system_error>

namespace tetrace {

namespace {

constexpr std::uint32_t word_count = DEFECT_WORD_COUNT;

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

/// x and y of a corner, and how far along it is.
using Corner = std::array<std::int64_t, 3>;

/// Word i is i.
std::uint32_t scattered_index(std::uint32_t index)
{
    return index % word_count ^ (index * 2654435761u);
}

Corner corner_of(std::uint32_t index)
{
    const std::uint32_t word = scattered_index(index);
    return {word % 1024 - 500ll, word / 1024 % 1024 - 499ll, word / 1024 / 1024};
}

/// By integers, which the floats of the kernel hold.
std::uint32_t steps_by_corners(std::uint32_t item)
{
    const auto area = [](const Corner& a, const Corner& b) { return a[0] * b[1] - a[1] * b[0]; };
    std::array<Corner, 3> corners = {corner_of(4 * item), corner_of(4 * item + 1), corner_of(4 * item + 2)};
    const auto is_before_end = [&](const Corner& corner) { return corner[2] <= 2048 + 128 * std::int64_t{item}; };
    std::uint32_t rotation = 0, exit = item * 4, steps = 1;
    while (exit % 4 != 3 && steps < 40 + item && std::ranges::any_of(corners, is_before_end)) {
        ++steps;
        const std::uint32_t record = exit / 4;
        const Corner apex = corner_of(record);
        const std::int64_t first = area(corners[2], apex);
        const std::int64_t second = area(corners[first > 0 ? 1 : 0], apex);
        rotation = (rotation + exit % 4) % 3;
        if (first == 0 || second == 0) break;
        const std::uint32_t replaced = first > 0 ? (second > 0 ? 2 : 0) : (second > 0 ? 1 : 2);
        corners[replaced] = apex;
        const std::uint32_t word = scattered_index(3 * record + (replaced + 3 - rotation) % 3);
        exit = (word % 37 == 0 ? word | 3 : word - word % 4 + word / 32 % 3) % (1u << 28);
    }
    return steps * 64 + item;
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
            {"steps_beside_selected_structs",
             "steps counted in a struct, others of whose members are structs that each step selects",
             "OpenCL of NVIDIA 580.159", steps_by_corners},
        };
        const auto stressing = all_stressors();
        all.insert(all.end(), stressing.begin(), stressing.end());
        const auto grouped = group_stressors();
        all.insert(all.end(), grouped.begin(), grouped.end());
        return all;
    }();
    return defects;
}

/// Of a launch: what Vulkan guarantees.
constexpr std::uint32_t max_groups = 65'535;
/// Of a large buffer: the first words, and those before and after a boundary.
constexpr std::uint32_t min_large_words = 3 * FAR_ROOM;
constexpr std::uint64_t large_unit_bytes = 4096;
constexpr std::uint64_t max_large_bytes = (std::uint64_t{1} << 34) - large_unit_bytes;

std::optional<ChosenDefect> chosen_defect(std::string_view text)
{
    const auto colon = text.find(':');
    const Defect* const defect = find_defect(text.substr(0, colon));
    if (defect == nullptr) return std::nullopt;
    if (colon == std::string_view::npos) return ChosenDefect{defect, defect->case_launch()};
    DefectLaunch launch;
    const char* const end = text.data() + text.size();
    const auto items = std::from_chars(text.data() + colon + 1, end, launch.items);
    if (items.ec != std::errc() || items.ptr == end || *items.ptr != ':') return std::nullopt;
    auto last = std::from_chars(items.ptr + 1, end, launch.group_items);
    launch.large_words = defect->large_words;
    if (last.ec == std::errc() && last.ptr != end && *last.ptr == ':' && defect->need == DefectNeed::largest_buffer)
        last = std::from_chars(last.ptr + 1, end, launch.large_words);
    const DefectLaunch& largest = defect->launches().back();
    const bool is_within = launch.items >= 1 && launch.items <= largest.items && launch.group_items >= 1 &&
                           launch.group_items <= largest.group_items && launch.groups() <= max_groups &&
                           (defect->large_words == 0 || launch.large_words >= min_large_words);
    if (last.ec != std::errc() || last.ptr != end || !is_within) return std::nullopt;
    return ChosenDefect{defect, launch};
}

DefectLaunch launch_on(const Device& device, const Defect& defect, DefectLaunch launch)
{
    if (defect.large_words == 0) return launch;
    launch.large_words = defect.large_words;
    const bool takes_largest = defect.need == DefectNeed::largest_buffer;
    if (takes_largest) launch.large_words = min_large_words;
    std::uint64_t admitted = max_large_bytes;
    const auto limit = [&](const std::string& what, std::uint64_t bytes) {
        if (bytes < launch.large_bytes())
            throw Error(ErrorKind::unsupported, what + " " + std::to_string(bytes >> 20) +
                                                    " MiB, and the kernel needs " +
                                                    std::to_string(launch.large_bytes() >> 20) + " MiB");
        admitted = std::min(admitted, bytes);
    };
    if (device.max_buffer_bytes != 0) limit("it admits buffers of", device.max_buffer_bytes);
    if (device.kind == DeviceKind::gpu)
        limit("half of its memory is", device.memory_bytes / 2);
    else
        limit("half of the free memory is", available_memory_bytes() / 2);
    if (takes_largest)
        launch.large_words =
            static_cast<std::uint32_t>(admitted / large_unit_bytes * (large_unit_bytes / sizeof(std::uint32_t)));
    return launch;
}

const Defect* find_defect(std::string_view name)
{
    const auto defects = all_defects();
    const auto defect = std::ranges::find(defects, name, &Defect::name);
    return defect == defects.end() ? nullptr : &*defect;
}

bool has_case_host(const Backend& backend)
{
    return backend.defect_case(all_defects().front().name, {}).has_value();
}

std::vector<std::uint32_t> defect_words(const DefectLaunch& launch)
{
    std::vector<std::uint32_t> counting(word_count);
    std::iota(counting.begin(), counting.end(), 0u);
    counting.push_back(launch.items);
    counting.push_back(launch.large_words);
    return counting;
}

std::size_t output_words(std::string_view name, const DefectLaunch& launch)
{
    const Defect* const defect = find_defect(name);
    return std::size_t{launch.items} + (defect == nullptr ? 0 : defect->shared_words);
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
    return is_stressor ? DefectLaunch{64, 64, large_words} : DefectLaunch{};
}

std::vector<std::uint32_t> expected_words(const Defect& defect, const DefectLaunch& launch)
{
    if (defect.expected_output != nullptr) return defect.expected_output(launch);
    std::vector<std::uint32_t> words;
    for (std::uint32_t item = 0; item < launch.items; ++item)
        words.push_back(defect.expected(item));
    return words;
}

std::vector<std::uint32_t> wrong_items(const Defect& defect, const DefectLaunch& launch,
                                       std::span<const std::uint32_t> found)
{
    const auto expected = expected_words(defect, launch);
    const auto is_right = [&](std::uint32_t place) {
        return found[place] == expected[place] ||
               (defect.is_flushed != nullptr && defect.is_flushed(place, found[place]));
    };
    std::vector<std::uint32_t> wrong;
    for (std::uint32_t place = 0; place < expected.size(); ++place)
        if (found.size() != expected.size() || !is_right(place)) wrong.push_back(place);
    return wrong;
}

} // namespace tetrace
