#pragma once

#include "kernels/layouts/layout.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tetrace {

/// Where a launch's jobs write their results in its output: each job between GUARD_WORDS of its own before and after
/// them, one job after the other. All sizes are in words.
class OutputParts {
public:
    /// Each part begins at a multiple of it: 4096 bytes, which suits every API as the offset of a buffer's part.
    static constexpr std::size_t alignment = 1024;

    OutputParts() = default;
    /// rays: of each job.
    OutputParts(std::span<const std::size_t> rays, std::size_t words_per_ray)
    {
        for (const std::size_t count : rays) {
            const std::size_t begin = (words() + alignment - 1) / alignment * alignment;
            parts_.push_back({begin, 2 * std::size_t{GUARD_WORDS} + words_per_ray * count});
        }
    }

    /// Number of jobs.
    [[nodiscard]] std::size_t count() const { return parts_.size(); }
    /// The whole output.
    [[nodiscard]] std::size_t words() const { return parts_.empty() ? 0 : parts_.back().begin + parts_.back().size; }
    /// First guard word of a job: what its kernel is given as the output.
    [[nodiscard]] std::size_t begin(std::size_t job) const { return parts_[job].begin; }
    /// Of a job, with its guard words.
    [[nodiscard]] std::size_t size(std::size_t job) const { return parts_[job].size; }
    /// A job's results in the whole output.
    template <class Word>
    [[nodiscard]] std::span<Word> results(std::span<Word> output, std::size_t job) const
    {
        return output.subspan(begin(job) + GUARD_WORDS, size(job) - 2 * std::size_t{GUARD_WORDS});
    }

    friend bool operator==(const OutputParts&, const OutputParts&) = default;

private:
    struct Part {
        std::size_t begin, size;
        friend bool operator==(const Part&, const Part&) = default;
    };
    std::vector<Part> parts_;
};

} // namespace tetrace
