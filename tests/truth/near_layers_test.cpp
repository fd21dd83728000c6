// Two layers of triangles within some units in the last place of each other: each BVH must return the nearer one, as
// exact arithmetic says. TETRACE_CAMPAIGN is how many pairs of each kind are made; with it, the counts are printed, and
// those of Embree beside them.
#include "backends/embree/backend.h"
#include "backends/openmp/backend.h"
#include "bench/truth/oracle.h"
#include "core/base/vec.h"
#include "core/device/given_quads.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fmt/format.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

enum class Layers { parallel, tilted, crossing, folded };
constexpr std::array<const char*, 4> kinds{"parallel", "tilted", "crossing", "folded"};
constexpr int cells = 4;
constexpr std::uint32_t rays_per_pair = 512;

/// Two layers of cells x cells squares, each cut into two triangles, and the frame that they were made in.
struct Pair {
    TriangleMesh mesh;
    Double3 corner{}, along{}, across{}, normal{};
};

Double3 direction_of(Random& random)
{
    for (;;) {
        const Double3 a = to_double(random.point(-1, 1));
        const double size = dot(a, a);
        if (size > 0.01 && size < 1) return a * (1 / std::sqrt(size));
    }
}

/// ulps: the largest distance of the layers, in units in the last place of 1/2, along the normal's largest component.
Pair make_pair(Layers kind, int ulps, std::uint64_t seed)
{
    Random random(seed);
    Pair pair;
    const bool level = random.below(4) == 0;
    pair.normal = level ? Double3{0, 0, 1} : direction_of(random);
    const Double3 other = level ? Double3{1, 0, 0} : direction_of(random);
    const Double3 side = cross(pair.normal, other);
    pair.along = side * (1.2 / std::sqrt(dot(side, side)));
    pair.across = cross(pair.normal, pair.along);
    pair.corner = (pair.along + pair.across) * -0.5;
    const Double3 size{std::abs(pair.normal.x), std::abs(pair.normal.y), std::abs(pair.normal.z)};
    const bool is_x = size.x >= std::max(size.y, size.z), is_y = !is_x && size.y >= size.z;
    const auto heights = [&] {
        std::array<double, (cells + 1) * (cells + 1)> result{};
        for (double& height : result)
            height = kind == Layers::folded ? random.between(-0.1f, 0.1f) : 0;
        return result;
    }();
    const bool swapped = random.below(2) == 0;
    for (int layer = 0; layer < 2; ++layer) {
        const auto first = static_cast<std::uint32_t>(pair.mesh.vertices.size());
        for (int i = 0; i <= cells; ++i)
            for (int j = 0; j <= cells; ++j) {
                const double height = heights[static_cast<std::size_t>(i * (cells + 1) + j)];
                const Double3 at = pair.corner + pair.along * (double{1} / cells * i) +
                                   pair.across * (double{1} / cells * j) + pair.normal * height;
                const int apart = kind == Layers::tilted ? 1 + (ulps - 1) * i / cells
                                  : kind == Layers::crossing
                                      ? (i < 2 ? -1 : 1) * std::max(1, ulps * std::abs(i - 2) / 2)
                                      : ulps;
                const float moved = (layer == 0) == swapped ? static_cast<float>(apart) * 0x1p-24f : 0;
                const Float3 rounded{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
                pair.mesh.vertices.push_back(
                    snap_to_grid(Float3{rounded.x + (is_x ? moved : 0), rounded.y + (is_y ? moved : 0),
                                        rounded.z + (is_x || is_y ? 0 : moved)}));
            }
        const bool other_diagonal = random.below(2) == 0;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j) {
                const auto a = first + static_cast<std::uint32_t>(i * (cells + 1) + j), b = a + 1;
                const std::uint32_t c = a + cells + 1, d = c + 1;
                pair.mesh.triangles.push_back(other_diagonal ? std::array{a, b, c} : std::array{a, b, d});
                pair.mesh.triangles.push_back(other_diagonal ? std::array{b, d, c} : std::array{a, d, c});
            }
    }
    return pair;
}

/// From either side, at any angle down to a third of a degree; at any point, at edges and at vertices.
RaySet rays_at(const Pair& pair, std::uint64_t seed)
{
    Random random(seed);
    RaySet set{RayKind::random, RayOrder::tiles, false, 0, TILE_WIDTH, {}};
    while (set.rays.size() < rays_per_pair) {
        const auto number = static_cast<std::uint32_t>(set.rays.size());
        const auto& triangle =
            pair.mesh.triangles[random.below(static_cast<std::uint32_t>(pair.mesh.triangles.size()))];
        double u = random.unit(), v = random.unit();
        if (number % 4 == 1) v = 1 - u;  // at an edge
        if (number % 16 == 2) u = v = 0; // at a vertex
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Double3 a = to_double(pair.mesh.vertices[triangle[0]]), b = to_double(pair.mesh.vertices[triangle[1]]),
                      c = to_double(pair.mesh.vertices[triangle[2]]);
        const Double3 at = a + (b - a) * u + (c - a) * v;
        const double turn = 6.2831853 * random.unit(), sine = std::exp2(-7.5 * random.unit());
        const double cosine = std::sqrt(1 - sine * sine), unit = 1 / 1.2;
        const Double3 way = pair.along * (std::cos(turn) * cosine * unit) +
                            pair.across * (std::sin(turn) * cosine * unit) +
                            pair.normal * (random.below(2) == 0 ? sine : -sine);
        const auto flushed = [](double x) { return std::abs(x) < 0x1p-20 ? 0.0f : static_cast<float>(x); };
        const Float3 direction{flushed(way.x), flushed(way.y), flushed(way.z)};
        const Double3 from = at - to_double(direction) * double{random.between(2.0f, 3.0f)};
        const Float3 origin =
            snap_to_grid(Float3{static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)});
        set.rays.push_back({origin, direction, NO_END, NO_HALF_FACE, FREE_FACE, number});
    }
    return set;
}

std::vector<Hit> answers_of(Session& session, const RaySet& set, const TriangleMesh& mesh)
{
    session.set_rays(given_quads_offset(set, mesh));
    std::vector<Hit> answers(set.rays.size());
    (void)session.trace(given_job(set.rays.size(), 1, false), answers);
    return answers;
}

class Campaign {
public:
    void judge(Layers kind, int ulps, std::uint64_t seed)
    {
        const Pair pair = make_pair(kind, ulps, seed);
        const RaySet set = rays_at(pair, seed + 1);
        GivenOracle oracle(pair.mesh, 2);
        const Bvh bvh = build_bvh(pair.mesh).bvh;
        for (const KernelId& kernel : all_kernels()) {
            if (kernel.structure != Structure::bvh || kernel.task != Task::trace) continue;
            KernelId asked = kernel;
            asked.task = Task::rays;
            const bool ours = is_portable(kernel);
            if (!ours && std::getenv("TETRACE_CAMPAIGN") == nullptr) continue;
            if (ours ? kernel.math != MathMode::exact : !is_embree(kernel.layout)) continue;
            Backend& backend = ours ? openmp_backend() : embree_backend();
            if (!backend.why_not(0, asked).empty()) continue;
            std::vector<Hit> answers;
            if (ours) {
                const PackedScene packed = pack_bvh(pair.mesh, bvh, kernel.layout);
                answers = answers_of(*backend.open(0, asked, {&pair.mesh, &packed}, {.threads = 2}), set, pair.mesh);
            } else {
                answers = answers_of(*backend.open(0, asked, {&pair.mesh, nullptr}, {.threads = 2}), set, pair.mesh);
            }
            const Verdicts verdicts =
                oracle.judge(set, answers, Origins::own, ours ? HitFormula::kernels : HitFormula::other);
            const std::string name =
                fmt::format("{} {} {}", name_of(kernel.method), name_of(kernel.layout), name_of(kernel.schedule));
            wrong_[name][static_cast<std::size_t>(kind)] += verdicts.wrong;
            if (ours && verdicts.wrong != 0 && kind != Layers::folded)
                ADD_FAILURE() << name << ", " << kinds[static_cast<std::size_t>(kind)] << ", " << ulps << " ulps, seed "
                              << seed << ": " << verdicts.wrong << " wrong";
        }
    }
    void print() const
    {
        for (const auto& [name, wrong] : wrong_)
            fmt::print("{:32} {:8} {:8} {:8} {:8}\n", name, wrong[0], wrong[1], wrong[2], wrong[3]);
    }

private:
    std::map<std::string, std::array<std::uint64_t, kinds.size()>> wrong_;
};

} // namespace

TEST(NearLayers, are_told_apart_by_every_bvh)
{
    const char* const text = std::getenv("TETRACE_CAMPAIGN");
    const std::uint64_t pairs = text == nullptr ? 2 : std::strtoull(text, nullptr, 10);
    Campaign campaign;
    for (const Layers kind : {Layers::parallel, Layers::tilted, Layers::crossing, Layers::folded})
        for (int ulps = 1; ulps <= 64; ulps *= 2)
            for (std::uint64_t seed = 0; seed < pairs; ++seed)
                campaign.judge(kind, ulps,
                               1000 * seed + static_cast<std::uint64_t>(ulps) +
                                   64 * 1000 * static_cast<std::uint64_t>(kind));
    campaign.print();
}
