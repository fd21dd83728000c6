#include "scenes/builder/steiner_rounding.h"

#include "core/base/exact.h"

#include <algorithm>
#include <limits>

namespace tetrace {
namespace {

constexpr std::uint64_t max_tests = 20'000'000; // a second or two; a mesh that needs more cannot be mended
constexpr float step_size = 0x1p-24f;           // the spacing of floats in [1/2, 1)

bool is_bad(const TetMesh& mesh, const Tet& tet)
{
    const auto& [a, b, c, d] = tet.vertices;
    return orientation(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]) >= 0;
}

// Per vertex the tets that have it, as ranges of one array.
class Stars {
public:
    explicit Stars(const TetMesh& mesh) : ranges_(mesh.vertices.size() + 1, 0), tets_(4 * mesh.tets.size())
    {
        for (const Tet& tet : mesh.tets)
            for (const std::uint32_t vertex : tet.vertices)
                ranges_[vertex + 1]++;
        for (std::size_t i = 1; i < ranges_.size(); ++i)
            ranges_[i] += ranges_[i - 1];
        auto next = ranges_;
        for (std::uint32_t i = 0; i < mesh.tets.size(); ++i)
            for (const std::uint32_t vertex : mesh.tets[i].vertices)
                tets_[next[vertex]++] = i;
    }
    // Counts up to `limit`, and takes what it spent from the budget.
    [[nodiscard]] std::size_t count_bad(const TetMesh& mesh, std::uint32_t vertex, std::size_t limit)
    {
        std::size_t bad = 0;
        for (auto i = ranges_[vertex]; i < ranges_[vertex + 1] && bad < limit; ++i) {
            bad += is_bad(mesh, mesh.tets[tets_[i]]) ? 1 : 0;
            budget_ -= budget_ > 0 ? 1 : 0;
        }
        return bad;
    }
    [[nodiscard]] bool exhausted() const { return budget_ == 0; }

private:
    std::vector<std::size_t> ranges_;
    std::vector<std::uint32_t> tets_;
    std::uint64_t budget_ = max_tests;
};

// The 26 directions of a step, those along one axis first.
std::vector<std::array<int, 3>> directions()
{
    std::vector<std::array<int, 3>> result;
    for (int i = 0; i < 27; ++i)
        if (i != 13) result.push_back({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
    const auto axes = [](const std::array<int, 3>& d) { return d[0] * d[0] + d[1] * d[1] + d[2] * d[2]; };
    std::stable_sort(result.begin(), result.end(), [&](const auto& a, const auto& b) { return axes(a) < axes(b); });
    return result;
}

bool allowed(const Freedom& freedom, const std::array<int, 3>& direction)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0 && !freedom.axes[axis]) return false;
    return true;
}

bool move_vertex(TetMesh& mesh, Stars& stars, std::uint32_t vertex, const Freedom& freedom)
{
    static const auto all_directions = directions();
    const Float3 home = mesh.vertices[vertex];
    const std::size_t bad = stars.count_bad(mesh, vertex, std::numeric_limits<std::size_t>::max());
    for (std::uint32_t steps = 1; steps <= freedom.steps && !stars.exhausted(); steps *= 2) {
        for (const auto& direction : all_directions) {
            if (!allowed(freedom, direction)) continue;
            for (int axis = 0; axis < 3; ++axis)
                mesh.vertices[vertex][axis] =
                    snap_to_grid(home[axis] + static_cast<float>(direction[static_cast<std::size_t>(axis)]) *
                                                  static_cast<float>(steps) * step_size);
            if (stars.count_bad(mesh, vertex, bad) < bad) return true;
        }
    }
    mesh.vertices[vertex] = home;
    return false;
}

std::vector<std::uint32_t> bad_tets(const TetMesh& mesh)
{
    std::vector<std::uint32_t> bad;
    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i)
        if (is_bad(mesh, mesh.tets[i])) bad.push_back(i);
    return bad;
}

} // namespace

std::array<std::uint64_t, 3> mend_tets(TetMesh& mesh, const std::vector<Freedom>& freedom)
{
    constexpr int max_passes = 8;
    auto bad = bad_tets(mesh);
    const std::uint64_t before = bad.size();
    std::uint64_t moved = 0;
    if (bad.empty()) return {0, 0, 0};
    Stars stars(mesh);
    for (int pass = 0; pass < max_passes && !bad.empty(); ++pass) {
        const std::uint64_t moved_before = moved;
        for (const std::uint32_t tet : bad)
            for (const std::uint32_t vertex : mesh.tets[tet].vertices)
                if (freedom[vertex].steps > 0 && is_bad(mesh, mesh.tets[tet]) &&
                    move_vertex(mesh, stars, vertex, freedom[vertex]))
                    ++moved;
        bad = bad_tets(mesh);
        if (moved == moved_before) break;
    }
    return {before, bad.size(), moved};
}

} // namespace tetrace
