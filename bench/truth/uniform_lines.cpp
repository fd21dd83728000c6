#include "bench/truth/uniform_lines.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

constexpr double groups_of_domain = 512;

double volume_of(const TetMesh& mesh, std::uint32_t tet)
{
    const auto at = [&](std::size_t corner) { return to_double(mesh.vertices[mesh.tets[tet].vertices.at(corner)]); };
    return std::abs(dot(at(1) - at(0), cross(at(2) - at(0), at(3) - at(0)))) / 6;
}

} // namespace

bool LineTest::is_testable() const
{
    return groups > 0 && lines >= 4 * groups;
}

double LineTest::reach() const
{
    return 6 * std::sqrt(2 / static_cast<double>(groups));
}

bool LineTest::passes() const
{
    return is_testable() && std::abs(chi_square - 1) < reach();
}

UniformLines::UniformLines(const Scene& scene, std::span<const std::uint32_t> mesh_of_packed)
    : group_of_(mesh_of_packed.size())
{
    const Double3 size = to_double(scene.domain.high()) - to_double(scene.domain.low());
    volume_ = size.x * size.y * size.z;
    surface_ = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    double last = 0;
    volumes_.push_back(0);
    for (std::size_t i = 0; i < mesh_of_packed.size(); ++i) {
        if (last * groups_of_domain >= volume_) {
            volumes_.push_back(0);
            last = 0;
        }
        last += volume_of(scene.tets, mesh_of_packed[i]);
        volumes_.back() = last;
        group_of_[i] = static_cast<std::uint32_t>(volumes_.size() - 1);
    }
    if (volumes_.size() > 1 && last * groups_of_domain < volume_) { // too small by itself
        const auto group = static_cast<std::uint32_t>(volumes_.size() - 1);
        std::ranges::replace(group_of_, group, group - 1);
        volumes_.pop_back();
        volumes_.back() += last;
    }
    sums_.resize(volumes_.size());
    squares_ = of_line_ = sums_;
}

void UniformLines::add(const CrossedTets& walk)
{
    ++lines_;
    crossed_.clear();
    std::uint32_t farthest = walk.places.empty() ? 0 : walk.places.front();
    for (std::size_t i = 0; i < walk.tets.size(); ++i) {
        const std::uint32_t next = std::max(farthest, walk.places[i + 1]), group = group_of_[walk.tets[i]];
        if (next == farthest) continue;
        if (of_line_[group] == 0) crossed_.push_back(group);
        of_line_[group] += length_of(next - farthest);
        farthest = next;
    }
    for (const std::uint32_t group : crossed_) {
        sums_[group] += of_line_[group];
        squares_[group] += of_line_[group] * of_line_[group];
        of_line_[group] = 0;
    }
}

LineTest UniformLines::test() const
{
    LineTest test{lines_, volumes_.size(), 0, 4 * volume_ / surface_, 0};
    if (lines_ == 0) return test;
    const auto count = static_cast<double>(lines_);
    for (std::size_t i = 0; i < volumes_.size(); ++i) {
        const double mean = sums_[i] / count, expected = 4 * volumes_[i] / surface_;
        const double variance = squares_[i] / count - mean * mean;
        test.mean_length += mean;
        if (variance > 0) test.chi_square += count * (mean - expected) * (mean - expected) / variance;
    }
    test.chi_square /= static_cast<double>(test.groups);
    return test;
}

} // namespace tetrace
