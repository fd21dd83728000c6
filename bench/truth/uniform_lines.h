#pragma once

#include "bench/truth/crossings.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tetrace {

/// What uniform lines show of their lengths in each cell of the domain, a tet or a group of tets (docs/spec/volume.md,
/// S10).
struct CellTest {
    std::size_t cells = 0;
    std::size_t testable = 0; ///< cells whose own mean is tested: its bound is below the expected length
    double off = 0;   ///< squares of what the cells' means are off, less their expectation, in standard deviations
    double worst = 0; ///< the largest of what a cell's mean is off, over its bound

    [[nodiscard]] bool passes() const;
};

/// What uniform lines show of their lengths in tets, by a law that knows no code: a line that meets a convex body of
/// surface S has 4 V / S of any volume V inside it, on average (Crofton).
struct LineTest {
    std::uint64_t lines = 0;
    std::uint64_t meetings = 0; ///< of the pairs of lines compared, those that have a tet in common
    double mean_length = 0;     ///< of a line in the domain; domain units
    double expected_length = 0; ///< 4 V / S of the domain
    double mean_off = 0;        ///< what the mean is off, in standard errors
    CellTest tets;              ///< each by itself
    CellTest groups;            ///< tets that follow each other in packed order, with a 512th of the domain or more

    /// Whether there are lines enough for the variance of `off` to be known.
    [[nodiscard]] bool is_testable() const;
    /// The domain, tets and groups.
    [[nodiscard]] bool passes() const;
};

/// The lengths of uniform lines in cells, and which lines meet where.
class CellLengths {
public:
    /// cell_of: of each tet, in packed order, from 0 without a gap.
    CellLengths(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed, std::vector<std::uint32_t> cell_of);

    void add(const CrossedTets& walk);
    [[nodiscard]] CellTest test() const;
    [[nodiscard]] std::uint64_t lines() const { return lines_; }
    /// Pairs of lines with a cell in common, of those that were compared.
    [[nodiscard]] std::uint64_t meetings() const { return meetings_; }

private:
    struct Cell {
        double expected = 0; ///< mean length of a line
        double longest = 0;  ///< no length is greater
        double sum = 0, squares = 0;
        /// One over the largest variance that a line's length can have.
        [[nodiscard]] double weight() const { return expected > 0 ? 1 / (longest * expected) : 0; }
    };
    struct Line {
        std::vector<std::pair<std::uint32_t, double>> lengths; ///< by cell
        double expected = 0;                                   ///< weighted product with the cells' expected lengths
    };
    [[nodiscard]] Line line_of(const CrossedTets& walk);

    static constexpr std::size_t compared = 16; ///< lines with which each is compared: those before it
    std::vector<std::uint32_t> cell_of_;
    std::vector<Cell> cells_;
    std::vector<double> of_line_; ///< of each cell; 0 between two lines
    std::array<Line, compared> recent_;
    double expected_square_ = 0; ///< weighted square of the cells' expected lengths
    double pair_squares_ = 0;
    std::uint64_t lines_ = 0, pairs_ = 0, meetings_ = 0;
};

/// Tests the lengths of uniform lines by tets and by groups of tets. All lines must be independent.
class UniformLines {
public:
    UniformLines(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed);

    /// The walk of a line that meets the domain, from outside it.
    void add(const CrossedTets& walk);
    [[nodiscard]] LineTest test() const;

private:
    double expected_length_;
    double sum_ = 0, squares_ = 0; ///< of the lines' lengths
    CellLengths tets_, groups_;
};

} // namespace tetrace
