#pragma once

#include "bench/truth/crossings.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tetrace {

/// What uniform lines show of their lengths in tets, by a law that knows no code: a line that meets a convex body of
/// surface S has 4 V / S of any volume V inside it, on average (Crofton).
struct LineTest {
    std::uint64_t lines = 0;
    std::size_t groups = 0;
    double mean_length = 0;     ///< of a line in the domain; domain units
    double expected_length = 0; ///< 4 V / S of the domain
    double chi_square = 0;      ///< per group: squares of what the mean length in a group is off, over its variance

    /// Whether there are lines enough for the law to be tested.
    [[nodiscard]] bool is_testable() const;
    /// How far chi_square may be from 1: six standard deviations.
    [[nodiscard]] double reach() const;
    [[nodiscard]] bool passes() const;
};

/// Sums the lengths of uniform lines in groups of tets that follow each other in packed order. A group has at least a
/// 512th of the domain, so that hundreds of lines cross it, and its mean is nearly normal.
class UniformLines {
public:
    UniformLines(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed);

    /// The walk of a line that meets the domain, from outside it.
    void add(const CrossedTets& walk);
    [[nodiscard]] LineTest test() const;

private:
    double volume_ = 0, surface_ = 0;     ///< of the domain
    std::vector<std::uint32_t> group_of_; ///< of each tet, in packed order
    std::vector<double> volumes_;         ///< of each group
    std::vector<double> sums_, squares_;  ///< of each group, over all lines
    std::vector<double> of_line_;         ///< of each group; 0 between two lines
    std::vector<std::uint32_t> crossed_;  ///< groups of one line
    std::uint64_t lines_ = 0;
};

} // namespace tetrace
