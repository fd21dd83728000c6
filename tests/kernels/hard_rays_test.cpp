// project on rays that are built to break a walk (tests/support/hard_rays.h), each judged by Embree and, where that
// disagrees, by exact arithmetic. TETRACE_HARD_RAYS is how many rays a scene gets: 100,000,000 are some minutes a
// scene.
#include "backends/embree/accelerator.h"
#include "bench/truth/given_oracle.h"
#include "bench/truth/hit_point.h"
#include "core/base/exact.h"
#include "core/base/random_words.h"
#include "core/device/given_quads.h"
#include "scenes/load.h"
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
    std::uint64_t nearby = 0;                       ///< called wrong, and right for a ray nearby
    std::array<std::uint64_t, hard_kinds> flawed{}; ///< by kind, without those
    std::string first;                              ///< of the flawed rays
};

/// Whether Embree has that answer (NO_HIT: none) for one of many rays nearby, moved by the bound or less at the start
/// and two units farther on, and so between. The oracle looks for what explains an answer across one edge; of slivers
/// and of triangles seen from their edges there may be several on the way.
bool is_that_of_a_ray_nearby(const Scene& scene, const embree::Accelerator& accelerator, const GivenRay& ray,
                             const Hit& hit)
{
    constexpr std::uint32_t rays_nearby = 20'000, stream = 101;
    const double bound = tie_bound(ray.origin);
    const bool is_hit = hit.face_id < scene.mesh.triangles.size();
    if (!is_hit && hit.face_id != NO_HIT) return false;
    if (is_hit && !names_one_point(scene.mesh, {ray.origin, ray.direction}, hit, bound)) return false;
    for (std::uint32_t i = 0; i < rays_nearby; ++i) {
        const Double3 shift = random_direction({stream, i, 0, 0}) * (bound * (i % 4 + 1) / 4);
        const Double3 far_shift = random_direction({stream, i, 1, 0}) * (bound * (i / 4 % 5) / 4);
        const Double3 bend = (far_shift - shift) * (length(to_double(ray.direction)) / 2);
        RTCRayHit query = embree::query_of(to_float(to_double(ray.origin) + shift),
                                           to_float(to_double(ray.direction) + bend), 0, ray.end);
        accelerator.intersect(query, embree::Coherence::incoherent);
        const bool meets = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        if (hit.face_id == (meets ? query.hit.primID : NO_HIT)) return true;
    }
    return false;
}

/// Traces that many rays with trace(set, quads), and judges each.
template <class Trace>
Judged judged(const Scene& scene, const PackedScene& packed, std::uint64_t count, const Trace& trace)
{
    GivenOracle oracle(scene.mesh, 0);
    const embree::Accelerator accelerator(scene.mesh, true, 0);
    Judged all;
    for (std::uint64_t first = 0; first < count; first += rays_at_once) {
        const std::size_t size = std::min(rays_at_once, count - first) / TILE_WIDTH * TILE_WIDTH;
        const RaySet set = hard_ray_set(scene, first, size);
        const std::vector<Hit> hits = trace(set, given_quads(set, packed));
        const Verdicts verdicts = oracle.judge(set, hits, Origins::own);
        all.verdicts.add(verdicts);
        for (const std::uint32_t ray : verdicts.flawed) {
            if (is_that_of_a_ray_nearby(scene, accelerator, set.rays[ray], hits[ray])) {
                ++all.nearby;
                continue;
            }
            ++all.flawed[(first + ray) % hard_kinds];
            if (all.first.empty()) all.first = fmt::format("ray {}", first + ray);
        }
    }
    return all;
}

/// On openmp, from tets and from records: their hits are the same bits.
Judged judged_on_openmp(const Scene& scene, std::uint64_t count)
{
    const KernelId kernel{.method = Method::project, .task = Task::rays};
    const KernelId of_records{.method = Method::project, .layout = Layout::half32, .task = Task::rays};
    const PackedScene packed = pack(scene, kernel.layout, TetOrder::hilbert);
    const PackedScene records = pack(scene, of_records.layout, TetOrder::hilbert);
    const auto session = openmp_backend().open(0, kernel, {&scene.mesh, &packed}, {});
    const auto other = openmp_backend().open(0, of_records, {&scene.mesh, &records}, {});
    return judged(scene, packed, count, [&](const RaySet& set, const std::vector<Quad>& quads) {
        const TraceJob job = given_job(set.rays.size(), packed.tet_count + 1, false);
        session->set_rays(quads);
        other->set_rays(given_quads(set, records));
        std::vector<Hit> hits = traced(*session, job);
        EXPECT_EQ(different_rays(traced(*other, job), hits, 0), 0u);
        return hits;
    });
}

void expect_none_wrong_or_lost(const Scene& scene, const char* name)
{
    const auto [verdicts, nearby, flawed, first] = judged_on_openmp(scene, rays_wanted(40'000));
    const std::string counts =
        fmt::format("{}: {} rays: {} agree, {} ties, {} settled for us, {} right for a ray nearby, {} lost, {} wrong; "
                    "flawed by kind {}",
                    name, verdicts.rays, verdicts.agreed, verdicts.ties, verdicts.settled, nearby, verdicts.lost,
                    verdicts.wrong - nearby, fmt::join(flawed, " "));
    fmt::print("{}\n", counts);
    EXPECT_EQ(verdicts.lost, 0u) << counts << "; " << first;
    EXPECT_EQ(verdicts.wrong, nearby) << counts << "; " << first;
    EXPECT_LT(nearby, verdicts.rays / 100);
    EXPECT_GT(verdicts.agreed, verdicts.rays / 2);
}

class HardRaysOf : public testing::TestWithParam<std::string> {};

} // namespace

TEST(HardRays, of_hard_meshes_are_neither_wrong_nor_lost)
{
    for (const auto& [name, scene] : make_hard_scenes())
        expect_none_wrong_or_lost(scene, name);
}

TEST_P(HardRaysOf, a_scanned_mesh_are_neither_wrong_nor_lost)
{
    const std::string name = GetParam();
    if (const std::string reason = why_not_available(name); !reason.empty()) GTEST_SKIP() << reason;
    expect_none_wrong_or_lost(load_scene({name, {}}, {}).scene, name.c_str());
}

INSTANTIATE_TEST_SUITE_P(each, HardRaysOf, testing::Values("bunny", "armadillo"),
                         [](const auto& test) { return test.param; });

TEST(HardRays, find_a_walk_without_the_rule_for_ties)
{
    const Scene scene = std::move(make_hard_scenes().front().scene);
    const PackedScene packed = pack(scene, Layout::tet96, TetOrder::hilbert);
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
    EXPECT_GT(all.verdicts.lost + all.verdicts.wrong - all.nearby, 20u);
}
