// project on rays that are built to break a walk (tests/support/hard_rays.h), each judged by exact arithmetic.
// TETRACE_HARD_RAYS is how many rays per scene gets.
#include "bench/truth/oracle.h"
#include "core/device/given_quads.h"
#include "scenes/load.h"
#include "scenes/optimise/optimise.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/project_without_ties.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <memory>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::uint64_t rays_at_once = 1 << 16;

std::uint64_t rays_wanted(std::uint64_t otherwise)
{
    const char* const text = std::getenv("TETRACE_HARD_RAYS");
    return text == nullptr ? otherwise : std::max<std::uint64_t>(std::strtoull(text, nullptr, 10), TILE_WIDTH);
}

struct Judged {
    Verdicts verdicts;
    std::array<std::uint64_t, hard_kinds> flawed{}; ///< by kind
    std::string first;                              ///< of the flawed rays
};

/// Traces that many rays with trace(set, quads), and judges each.
template <class Trace>
Judged judged(const Scene& scene, const PackedScene& packed, std::uint64_t count, const Trace& trace)
{
    GivenOracle oracle(scene.mesh, 0);
    Judged all;
    for (std::uint64_t first = 0; first < count; first += rays_at_once) {
        const std::size_t size = std::min(rays_at_once, count - first) / TILE_WIDTH * TILE_WIDTH;
        const RaySet set = hard_ray_set(scene, first, size);
        const std::vector<Hit> hits = trace(set, given_quads(set, packed));
        const Verdicts verdicts = oracle.judge(set, hits, Origins::own);
        all.verdicts.add(verdicts);
        for (const std::uint32_t ray : verdicts.flawed) {
            ++all.flawed[(first + ray) % hard_kinds];
            if (all.first.empty()) all.first = fmt::format("ray {}: {}", first + ray, verdicts.first_wrong->reason);
        }
    }
    return all;
}

/// On openmp, from tets and from records: their hits are the same bits.
Judged judged_on_openmp(const Scene& scene, std::uint64_t count)
{
    const KernelId kernel{.method = Method::project, .task = Task::rays};
    const PackedScene packed = pack(scene, kernel.layout, TetOrder::chains);
    const auto session = openmp_backend().open(0, kernel, {&scene.mesh, &packed}, {});
    std::map<Layout, PackedScene> records;
    std::map<Layout, std::unique_ptr<Session>> of_records;
    for (const Layout layout : {Layout::half32, Layout::tet64}) {
        records[layout] = pack(scene, layout, TetOrder::chains);
        const KernelId same{.method = Method::project, .layout = layout, .task = Task::rays};
        of_records[layout] = openmp_backend().open(0, same, {&scene.mesh, &records[layout]}, {});
    }
    return judged(scene, packed, count, [&](const RaySet& set, const std::vector<Quad>& quads) {
        const TraceJob job = given_job(set.rays.size(), packed.tet_count + 1, false);
        session->set_rays(quads);
        std::vector<Hit> hits = traced(*session, job);
        for (const auto& [layout, other] : of_records) {
            other->set_rays(given_quads(set, records[layout]));
            EXPECT_EQ(different_rays(traced(*other, job), hits, 0), 0u) << name_of(layout);
        }
        return hits;
    });
}

void expect_none_wrong_or_lost(const Scene& scene, const char* name)
{
    const auto [verdicts, flawed, first] = judged_on_openmp(scene, rays_wanted(40'000));
    const std::string counts = fmt::format(
        "{}: {} rays: {} agree, {} settled, {} ties, {} lost, {} wrong; flawed by kind {}", name, verdicts.rays,
        verdicts.agreed, verdicts.settled, verdicts.ties, verdicts.lost, verdicts.wrong, fmt::join(flawed, " "));
    fmt::print("{}\n", counts);
    EXPECT_EQ(verdicts.lost, 0u) << counts << "; " << first;
    EXPECT_EQ(verdicts.wrong, 0u) << counts << "; " << first;
    EXPECT_GT(verdicts.agreed + verdicts.settled, verdicts.rays / 2);
}

class HardRaysOf : public testing::TestWithParam<std::string> {};

} // namespace

TEST(HardRays, of_hard_meshes_are_neither_wrong_nor_lost)
{
    for (const auto& [name, scene] : make_hard_scenes())
        expect_none_wrong_or_lost(scene, name);
}

TEST(HardRays, of_hard_meshes_made_for_rays_are_neither_wrong_nor_lost)
{
    int changed = 0;
    for (auto& [name, scene] : make_hard_scenes()) {
        const OptimisedTets made = optimise(scene.tets, {}, {});
        if (made.report.cost_after == made.report.cost_before) continue;
        scene.tets = made.mesh;
        expect_none_wrong_or_lost(scene, fmt::format("{}, for rays", name).c_str());
        ++changed;
    }
    EXPECT_EQ(changed, 3) << "all but the stretched one, whose tets are too low to change";
}

TEST_P(HardRaysOf, a_scanned_mesh_are_neither_wrong_nor_lost)
{
    const std::string of = GetParam(), name = of.substr(0, of.find('_'));
    if (const std::string reason = why_not_available(name); !reason.empty()) GTEST_SKIP() << reason;
    const TetsKind tets = of == name ? TetsKind::cdt : TetsKind::rays;
    const Scene scene = load_scene({name, default_build(tets)}, {}).scene;
    EXPECT_EQ(scene.build.optimised.tets, tets);
    expect_none_wrong_or_lost(scene, of.c_str());
}

INSTANTIATE_TEST_SUITE_P(each, HardRaysOf, testing::Values("bunny", "armadillo", "bunny_rays", "armadillo_rays"),
                         [](const auto& test) { return test.param; });

TEST(HardRays, find_a_walk_without_the_rule_for_ties)
{
    const Scene scene = std::move(make_hard_scenes().front().scene);
    const PackedScene packed = pack(scene, Layout::tet96, TetOrder::chains);
    const without_ties::SceneView view = without_ties::view_of(packed);
    without_ties::TraceParams params{};
    params.max_steps = packed.tet_count + 1;
    const Judged all = judged(scene, packed, 1'800, [&](const RaySet& set, const std::vector<Quad>& quads) {
        std::vector<Hit> hits;
        for (std::size_t i = 0; i < set.rays.size(); ++i)
            hits.push_back(
                std::bit_cast<Hit>(without_ties::trace_given(view, params, quads[i], quads[set.rays.size() + i])));
        return hits;
    });
    EXPECT_GT(all.verdicts.lost + all.verdicts.wrong, 20u);
}
