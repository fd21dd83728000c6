// Two layers of triangles within some units in the last place of each other: each BVH must return the nearer one, as
// exact arithmetic says. TETRACE_CAMPAIGN is how many pairs of each kind are made; with it, the counts are printed
// next to those of walks, Embree and drivers.
#include "backends/embree/backend.h"
#include "backends/openmp/backend.h"
#include "backends/vulkan/backend.h"
#include "bench/truth/oracle.h"
#include "core/base/vec.h"
#include "core/device/given_quads.h"
#include "core/pack/packed_scene.h"
#include "scenes/load.h"
#include "tests/support/builder_meshes.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

enum class Layers { parallel, tilted, crossing, folded };
constexpr std::array<const char*, 4> layer_kinds{"parallel", "tilted", "crossing", "folded"};
constexpr int layer_cells = 4;
constexpr std::uint32_t rays_per_pair = 512;

/// Two layers of layer_cells x layer_cells squares, each cut into two triangles, and the frame that they were made in.
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
        std::array<double, (layer_cells + 1) * (layer_cells + 1)> result{};
        for (double& height : result)
            height = kind == Layers::folded ? random.between(-0.1f, 0.1f) : 0;
        return result;
    }();
    const bool swapped = random.below(2) == 0;
    for (int layer = 0; layer < 2; ++layer) {
        const auto first = static_cast<std::uint32_t>(pair.mesh.vertices.size());
        for (int i = 0; i <= layer_cells; ++i)
            for (int j = 0; j <= layer_cells; ++j) {
                const double height = heights[static_cast<std::size_t>(i * (layer_cells + 1) + j)];
                const Double3 at = pair.corner + pair.along * (double{1} / layer_cells * i) +
                                   pair.across * (double{1} / layer_cells * j) + pair.normal * height;
                const int apart = kind == Layers::tilted ? 1 + (ulps - 1) * i / layer_cells
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
        for (int i = 0; i < layer_cells; ++i)
            for (int j = 0; j < layer_cells; ++j) {
                const auto a = first + static_cast<std::uint32_t>(i * (layer_cells + 1) + j), b = a + 1;
                const std::uint32_t c = a + layer_cells + 1, d = c + 1;
                pair.mesh.triangles.push_back(other_diagonal ? std::array{a, b, c} : std::array{a, b, d});
                pair.mesh.triangles.push_back(other_diagonal ? std::array{b, d, c} : std::array{a, d, c});
            }
    }
    return pair;
}

/// From either side, at any angle down to a third of a degree; at any point, at edges and at vertices.
RaySet rays_at(const Pair& pair, const TriangleMesh& mesh, std::uint64_t seed)
{
    Random random(seed);
    RaySet set{RayKind::random, RayOrder::tiles, false, 0, TILE_WIDTH, {}};
    while (set.rays.size() < rays_per_pair) {
        const auto number = static_cast<std::uint32_t>(set.rays.size());
        const auto& triangle = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        double u = random.unit(), v = random.unit();
        if (number % 4 == 1) v = 1 - u;  // at an edge
        if (number % 16 == 2) u = v = 0; // at a vertex
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Double3 a = to_double(mesh.vertices[triangle[0]]), b = to_double(mesh.vertices[triangle[1]]),
                      c = to_double(mesh.vertices[triangle[2]]);
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

/// The pair's mesh as a scene, cut where its layers cross; without tets if TetGen fails.
LoadedScene scene_of(const TriangleMesh& mesh, const TemporaryFolder& folder)
{
    write_file(folder / "layers.off", to_off(mesh));
    BuildOptions build = default_build(TetsKind::rays);
    build.effort = 0;
    build.repair = build.mesh_will_do = true;
    return load_scene({folder / "layers.off", build}, {});
}

/// Who answers for a kernel; null if nobody is asked.
Backend* backend_of(const KernelId& kernel)
{
    if (is_portable(kernel)) return claims_robustness(kernel) ? &openmp_backend() : nullptr;
    return is_embree(kernel.layout) ? &embree_backend() : &vulkan_backend();
}

class LayerCampaign {
public:
    /// all: other structures too, and what the repair makes of the layers.
    explicit LayerCampaign(bool all) : all_(all) {}

    void judge(Layers kind, int ulps, std::uint64_t seed)
    {
        const Pair pair = make_pair(kind, ulps, seed);
        judge(pair.mesh, nullptr, rays_at(pair, pair.mesh, seed + 1), kind, as_made_);
        if (kind != Layers::folded) {
            for (const auto& [name, wrong] : as_made_)
                EXPECT_TRUE(!name.starts_with("ours") || wrong[static_cast<std::size_t>(kind)] == 0)
                    << name << ", " << layer_kinds[static_cast<std::size_t>(kind)] << ", " << ulps << " ulps, seed "
                    << seed;
        }
        if (!all_) return;
        const LoadedScene loaded = scene_of(pair.mesh, folder_);
        if (loaded.no_tets) ++without_tets_[static_cast<std::size_t>(kind)];
        judge(loaded.scene.mesh, loaded.no_tets ? nullptr : &loaded.scene, rays_at(pair, loaded.scene.mesh, seed + 1),
              kind, as_scene_);
        for (const auto& [name, wrong] : as_scene_)
            EXPECT_TRUE(!name.starts_with("ours project") || wrong[static_cast<std::size_t>(kind)] == 0) << name;
    }
    void print() const
    {
        for (const auto& [title, table] : {std::pair{"as made", &as_made_}, {"as a scene", &as_scene_}}) {
            fmt::print("{:32} {:>9} {:>9} {:>9} {:>9}\n", title, layer_kinds[0], layer_kinds[1], layer_kinds[2],
                       layer_kinds[3]);
            for (const auto& [name, wrong] : *table)
                fmt::print("{:32} {:9} {:9} {:9} {:9}\n", name, wrong[0], wrong[1], wrong[2], wrong[3]);
        }
        fmt::print("{:32} {:9} {:9} {:9} {:9}\n", "scenes without tets", without_tets_[0], without_tets_[1],
                   without_tets_[2], without_tets_[3]);
    }

private:
    using Counts = std::array<std::uint64_t, layer_kinds.size()>;
    using Table = std::map<std::string, Counts>;
    /// Most kernels answer alike, so each answer is judged once.
    struct Judged {
        std::vector<Hit> answers;
        HitFormula formula;
        std::uint64_t wrong;
    };

    /// Adds each kernel's wrong and lost rays to a table. scene: for walks; null: there are none.
    void judge(const TriangleMesh& mesh, const Scene* scene, const RaySet& set, Layers kind, Table& table) const
    {
        GivenOracle oracle(mesh, 2);
        const Bvh bvh = build_bvh(mesh).bvh;
        std::vector<Judged> judged;
        for (KernelId kernel : all_kernels()) {
            const bool is_walk = kernel.structure == Structure::cdt, ours = is_portable(kernel);
            Backend* const backend = backend_of(kernel);
            if (backend == nullptr || (is_walk ? scene == nullptr : !ours && !all_)) continue;
            kernel.task = Task::rays;
            if (!backend->why_not(0, kernel).empty()) continue;
            PackedScene packed;
            if (ours)
                packed = is_walk ? pack(*scene, kernel.layout, TetOrder::chains) : pack_bvh(mesh, bvh, kernel.layout);
            const auto session = backend->open(0, kernel, {&mesh, ours ? &packed : nullptr}, {.threads = 2});
            session->set_rays(is_walk ? given_quads(set, packed) : given_quads_offset(set, mesh));
            std::vector<Hit> answers(set.rays.size());
            (void)session->trace(given_job(set.rays.size(), packed.tet_count + 1, false), answers);
            const HitFormula formula = ours ? HitFormula::kernels : HitFormula::other;
            auto found = std::ranges::find_if(judged, [&](const Judged& other) {
                return other.formula == formula &&
                       std::memcmp(other.answers.data(), answers.data(), answers.size() * sizeof(Hit)) == 0;
            });
            if (found == judged.end()) {
                const Verdicts verdicts = oracle.judge(set, answers, Origins::own, formula);
                judged.push_back({std::move(answers), formula, verdicts.wrong + verdicts.lost});
                found = judged.end() - 1;
            }
            table[fmt::format("{} {} {} {}", ours ? "ours" : "other", name_of(kernel.method), name_of(kernel.layout),
                              name_of(kernel.schedule))][static_cast<std::size_t>(kind)] += found->wrong;
        }
    }

    bool all_;
    TemporaryFolder folder_;
    ScopedVariable cache_{"XDG_CACHE_HOME", folder_ / "cache"};
    Table as_made_, as_scene_;
    Counts without_tets_{};
};

} // namespace

TEST(NearLayers, are_told_apart_by_every_bvh)
{
    const char* const text = std::getenv("TETRACE_CAMPAIGN");
    const std::uint64_t pairs = text == nullptr ? 2 : std::strtoull(text, nullptr, 10);
    LayerCampaign campaign(text != nullptr);
    for (const Layers kind : {Layers::parallel, Layers::tilted, Layers::crossing, Layers::folded}) {
        if (kind == Layers::folded && text == nullptr) continue; // nothing is claimed of BVHs there
        for (int ulps = 1; ulps <= 64; ulps *= 2)
            for (std::uint64_t seed = 0; seed < pairs; ++seed)
                campaign.judge(kind, ulps,
                               1000 * seed + static_cast<std::uint64_t>(ulps) +
                                   64 * 1000 * static_cast<std::uint64_t>(kind));
    }
    if (text != nullptr) campaign.print();
}
