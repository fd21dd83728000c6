#include "bench/truth/uniform_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tetrace {

namespace {

constexpr double groups_of_domain = 512;
constexpr double max_off = 6;
constexpr double false_alarm = 1e-9; // of all cells together, by the bound
constexpr std::uint64_t min_lines = 256, min_meetings = 256;

Double3 corner_of(const TetMesh& mesh, std::uint32_t tet, std::size_t corner)
{
    return to_double(mesh.vertices[mesh.tets[tet].vertices.at(corner)]);
}

double volume_of(const TetMesh& mesh, std::uint32_t tet)
{
    const auto edge = [&](std::size_t i) { return corner_of(mesh, tet, i) - corner_of(mesh, tet, 0); };
    return std::abs(dot(edge(1), cross(edge(2), edge(3)))) / 6;
}

struct Bounds { // of points in the domain, which is within 1 of the origin along each axis
    Double3 low{1, 1, 1}, high{-1, -1, -1};

    void add(Double3 point)
    {
        low = {std::min(low.x, point.x), std::min(low.y, point.y), std::min(low.z, point.z)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y), std::max(high.z, point.z)};
    }
};

double volume_of(const Domain& domain)
{
    const Double3 size = to_double(domain.high()) - to_double(domain.low());
    return size.x * size.y * size.z;
}

double surface_of(const Domain& domain)
{
    const Double3 size = to_double(domain.high()) - to_double(domain.low());
    return 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

std::vector<std::uint32_t> each_tet(std::size_t tets)
{
    std::vector<std::uint32_t> cell_of(tets);
    std::iota(cell_of.begin(), cell_of.end(), 0u);
    return cell_of;
}

std::vector<std::uint32_t> groups_of_tets(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed)
{
    const double enough = volume_of(scene.domain) / groups_of_domain;
    std::vector<std::uint32_t> cell_of;
    std::uint32_t group = 0;
    double volume = 0;
    for (const std::uint32_t tet : mesh_of_packed) {
        if (volume >= enough) {
            ++group;
            volume = 0;
        }
        volume += volume_of(scene.tets, tet);
        cell_of.push_back(group);
    }
    if (group > 0 && volume < enough) std::ranges::replace(cell_of, group, group - 1); // too small by itself
    return cell_of;
}

} // namespace

bool CellTest::passes() const
{
    return std::abs(off) < max_off && worst < 1;
}

bool LineTest::is_testable() const
{
    return lines >= min_lines && meetings >= min_meetings;
}

bool LineTest::passes() const
{
    return is_testable() && std::abs(mean_off) < max_off && tets.passes() && groups.passes();
}

CellLengths::CellLengths(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed,
                         std::vector<std::uint32_t> cell_of)
    : cell_of_(std::move(cell_of)), cells_(cell_of_.empty() ? 0 : std::size_t{std::ranges::max(cell_of_)} + 1),
      of_line_(cells_.size())
{
    std::vector<Bounds> bounds(cells_.size());
    const double surface = surface_of(scene.domain);
    for (std::size_t i = 0; i < cell_of_.size(); ++i) {
        cells_[cell_of_[i]].expected += 4 * volume_of(scene.tets, mesh_of_packed[i]) / surface;
        for (std::size_t corner = 0; corner < 4; ++corner)
            bounds[cell_of_[i]].add(corner_of(scene.tets, mesh_of_packed[i], corner));
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        cells_[i].longest = tetrace::length(bounds[i].high - bounds[i].low);
        expected_square_ += cells_[i].weight() * cells_[i].expected * cells_[i].expected;
    }
}

CellLengths::Line CellLengths::line_of(const CrossedTets& walk)
{
    Line line;
    std::uint32_t farthest = walk.places.empty() ? 0 : walk.places.front();
    for (std::size_t i = 0; i < walk.tets.size(); ++i) {
        const std::uint32_t next = std::max(farthest, walk.places[i + 1]), cell = cell_of_[walk.tets[i]];
        if (next == farthest) continue;
        if (of_line_[cell] == 0) line.lengths.emplace_back(cell, 0);
        of_line_[cell] += length_of(next - farthest);
        farthest = next;
    }
    for (auto& [cell, length] : line.lengths) {
        length = of_line_[cell];
        line.expected += cells_[cell].weight() * cells_[cell].expected * length;
    }
    return line;
}

void CellLengths::add(const CrossedTets& walk)
{
    Line line = line_of(walk);
    for (std::size_t i = 0; i < std::min<std::size_t>(lines_, compared); ++i) {
        double common = 0;
        for (const auto& [cell, length] : recent_[i].lengths)
            common += cells_[cell].weight() * length * of_line_[cell];
        const double product = common - line.expected - recent_[i].expected + expected_square_;
        pair_squares_ += product * product;
        meetings_ += common > 0 ? 1 : 0;
        ++pairs_;
    }
    for (const auto& [cell, length] : line.lengths) {
        cells_[cell].sum += length;
        cells_[cell].squares += length * length;
        of_line_[cell] = 0;
    }
    recent_[lines_ % compared] = std::move(line);
    ++lines_;
}

CellTest CellLengths::test() const
{
    CellTest test{cells_.size()};
    if (lines_ < 2) return test;
    const auto lines = static_cast<double>(lines_);
    const double chance = std::log(4 * static_cast<double>(test.cells) / false_alarm);
    double squares = 0;
    for (const Cell& cell : cells_) {
        const double mean = cell.sum / lines, difference = std::abs(mean - cell.expected);
        const double variance = std::max(cell.squares - lines * mean * mean, 0.0) / (lines - 1);
        const double bound = std::sqrt(2 * variance * chance / lines) + 7 * cell.longest * chance / (3 * (lines - 1));
        test.worst = std::max(test.worst, difference / bound);
        test.testable += bound < cell.expected ? 1 : 0;
        const double own = cell.squares - cell.expected * (2 * cell.sum - lines * cell.expected);
        squares += cell.weight() * (lines * difference * lines * difference - own);
    }
    const double deviation = std::sqrt(2 * lines * (lines - 1) * pair_squares_ / static_cast<double>(pairs_));
    if (deviation > 0) test.off = squares / deviation;
    return test;
}

UniformLines::UniformLines(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed)
    : expected_length_(4 * volume_of(scene.domain) / surface_of(scene.domain)),
      tets_(scene, mesh_of_packed, each_tet(mesh_of_packed.size())),
      groups_(scene, mesh_of_packed, groups_of_tets(scene, mesh_of_packed))
{
}

void UniformLines::add(const CrossedTets& walk)
{
    const double length = walk.places.empty() ? 0 : length_of(std::ranges::max(walk.places) - walk.places.front());
    sum_ += length;
    squares_ += length * length;
    tets_.add(walk);
    groups_.add(walk);
}

LineTest UniformLines::test() const
{
    LineTest test{.lines = tets_.lines(),
                  .meetings = tets_.meetings(),
                  .expected_length = expected_length_,
                  .tets = tets_.test(),
                  .groups = groups_.test()};
    if (test.lines < 2) return test;
    const auto lines = static_cast<double>(test.lines);
    test.mean_length = sum_ / lines;
    const double variance = std::max(squares_ - lines * test.mean_length * test.mean_length, 0.0) / (lines - 1);
    if (variance > 0) test.mean_off = (test.mean_length - expected_length_) / std::sqrt(variance / lines);
    return test;
}

} // namespace tetrace
