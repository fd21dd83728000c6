#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace tetrace {

/// How many items a kernel has, and how many of them are a work group; the last group may have fewer.
struct DefectLaunch {
    std::uint32_t items = 16, group_items = 16;
    std::uint32_t large_words = 0; ///< of a buffer that only the kernel sees (kernels/defects/far_stressors.h)

    [[nodiscard]] std::uint32_t groups() const { return (items + group_items - 1) / group_items; }
    [[nodiscard]] std::uint64_t large_bytes() const { return std::uint64_t{large_words} * sizeof(std::uint32_t); }
};

class Backend; // core/device/backend.h
struct Device;

/// What a stressor needs that not every device has: ballots of subgroups; a fence between groups; a large buffer, of a
/// fixed size or as large as the device admits.
enum class DefectNeed { none, ballots, fences, large_buffer, largest_buffer };

/// A defect of a driver's compiler, reduced to a small kernel (kernels/defects/defects.h, in every language), or a
/// stressor (kernels/defects/stressors.h). Each item returns a word; of some stressors, all groups together return
/// more.
struct Defect {
    std::string_view name;  ///< of its kernel
    std::string_view what;  ///< what the kernel does
    std::string_view known; ///< where the defect was met; of a stressor, public reports of its kind
    std::uint32_t (*expected)(std::uint32_t item); ///< null: see expected_output
    bool is_stressor = false;
    /// Whether the item may return this word on a device that flushes denormals. Null: of no arithmetic on denormals.
    bool (*is_flushed)(std::uint32_t item, std::uint32_t word) = nullptr;
    /// Of a kernel whose items share memory (kernels/defects/group_stressors.h): the whole output. Else null.
    std::vector<std::uint32_t> (*expected_output)(const DefectLaunch& launch) = nullptr;
    std::uint32_t shared_words = 0; ///< of all groups, in the output after those of the items
    DefectNeed need = DefectNeed::none;
    std::uint32_t large_words = 0; ///< of its large buffer; of the largest one, those of a case

    /// Those to be run, as launch_on() completes them: one group of 16 for a reduced kernel; for a stressor 1 to 10^6
    /// items, in groups of several sizes.
    [[nodiscard]] std::span<const DefectLaunch> launches() const;
    /// The usual one of a case without tetrace: one group.
    [[nodiscard]] DefectLaunch case_launch() const;
};

/// Every reduced kernel and stressor, in the order of kernels/defects/defect_list.inc.
[[nodiscard]] std::span<const Defect> all_defects();

/// A kernel and its launch.
struct ChosenDefect {
    const Defect* defect = nullptr;
    DefectLaunch launch;
};
/// As `dump --defect` names them: "zoo_of_exits" with its case_launch(), or "zoo_of_exits:4096:32", items and those of
/// a group; "words_at_the_end:4096:32:33554432" with the words of the largest buffer. Empty if there is no such kernel,
/// if its launch is larger than any of launches(), or the buffer too small for it.
[[nodiscard]] std::optional<ChosenDefect> chosen_defect(std::string_view text);

/// The launch on this device: with its large buffer, if the kernel has one. Throws Error{unsupported} if that is larger
/// than the device's largest buffer, or than half of the memory that the device may have. A buffer that is to be as
/// large as both admit has a multiple of 4 KiB, 16 GiB less 4 KiB at most: the kernel's words are numbered by 32 bits.
[[nodiscard]] DefectLaunch launch_on(const Device& device, const Defect& defect, DefectLaunch launch);

/// Null if there is none of that name.
[[nodiscard]] const Defect* find_defect(std::string_view name);

/// Whether the backend has a host that runs a case without tetrace (Backend::tile_case(), Backend::defect_case()).
[[nodiscard]] bool has_case_host(const Backend& backend);

/// The words that every kernel reads: 0, 1, ... 63, the number of items, and that of the words of a large buffer.
[[nodiscard]] std::vector<std::uint32_t> defect_words(const DefectLaunch& launch);

/// How many words the kernel of that name writes, which begin as zeros: its items', then those of all groups.
[[nodiscard]] std::size_t output_words(std::string_view name, const DefectLaunch& launch);

/// Those words.
[[nodiscard]] std::vector<std::uint32_t> expected_words(const Defect& defect, const DefectLaunch& launch);

/// Which words are neither the expected one nor a flushed one; all of them if the numbers of words differ.
[[nodiscard]] std::vector<std::uint32_t> wrong_items(const Defect& defect, const DefectLaunch& launch,
                                                     std::span<const std::uint32_t> words);

} // namespace tetrace
