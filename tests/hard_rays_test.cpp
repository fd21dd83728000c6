// project on rays that are built to break a walk (tests/hard_rays.h), each judged by Embree and, where that disagrees,
// by exact arithmetic. TETRACE_HARD_RAYS is how many rays a scene gets: 100,000,000 are some minutes a scene.
#include "bench/given_oracle.h"
#include "core/ray_offset.h"
#include "scenes/load.h"
#include "tests/device_rays.h"
#include "tests/hard_rays.h"
#include "tests/hard_scenes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>

namespace {

#define KERNEL_STRUCTURE_HEADER "kernels/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/tet80.h"
#define KERNEL_METHOD_HEADER "kernels/project.h"
#define SIDE_AT_TIE(p, q, p_is_before, product) false // "not positive", in whichever direction the edge is asked for
namespace mutant {
#include "kernels/kernel_cpp.h"
}

using namespace tetrace;

constexpr std::uint64_t rays_at_once = 1 << 16;

std::uint64_t rays_wanted(std::uint64_t otherwise)
{
    const char* const text = std::getenv("TETRACE_HARD_RAYS");
    return text == nullptr ? otherwise : std::max<std::uint64_t>(std::strtoull(text, nullptr, 10), TILE_WIDTH);
}

struct Judged {
    Verdicts verdicts;
    std::array<std::uint64_t, test::hard_kinds> flawed{}; ///< by kind, without those along a triangle
    std::uint64_t along = 0;                              ///< flawed ones along a triangle
    std::string first;                                    ///< of the flawed rays
};

/// Whether a ray passes a triangle so flatly that float32 may place the crossing anywhere along it, where the oracle
/// asks for one edge: it is seen thinner than four times the bound, so that its corners, each moved by less than the
/// bound, may turn an edge past others; or the start is within the bound of its plane, and farther from it along the
/// ray.
bool runs_along(const GivenRay& ray, const std::array<Float3, 3>& triangle)
{
    const double bound = tie_bound(ray.origin);
    const Double3 along = normalized(to_double(ray.direction)), start = to_double(ray.origin);
    const auto at = [&](std::size_t i) { return cross(to_double(triangle[i % 3]) - start, along); };
    double longest = 0, nearest = HUGE_VAL;
    for (std::size_t i = 0; i < 3; i++) {
        const Double3 edge = at(i + 1) - at(i);
        const double square = dot(edge, edge);
        const double s = square > 0 ? std::clamp(-dot(at(i), edge) / square, 0.0, 1.0) : 0.0;
        longest = std::max(longest, length(edge));
        nearest = std::min(nearest, length(at(i) + edge * s));
    }
    if (nearest > bound) return false;
    if (length(cross(at(1) - at(0), at(2) - at(0))) <= 4 * bound * longest) return true;
    const Double3 corner = to_double(triangle[0]);
    const Double3 normal = normalized(cross(to_double(triangle[1]) - corner, to_double(triangle[2]) - corner));
    const double height = std::abs(dot(normal, corner - start));
    return ray.link != NO_LINK && height <= bound && height > bound * std::abs(dot(normal, along));
}

bool runs_along_any(const GivenRay& ray, const TriangleMesh& mesh)
{
    return std::ranges::any_of(mesh.triangles, [&](const auto& v) {
        return runs_along(ray, {mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]});
    });
}

/// Traces that many rays with trace(set, rows), and judges each.
template <class Trace>
Judged judged(const Scene& scene, const PackedScene& packed, std::uint64_t count, const Trace& trace)
{
    GivenOracle oracle(scene.mesh, 0);
    Judged all;
    for (std::uint64_t first = 0; first < count; first += rays_at_once) {
        const std::size_t size = std::min(rays_at_once, count - first) / TILE_WIDTH * TILE_WIDTH;
        const RaySet set = test::hard_ray_set(scene, first, size);
        const std::vector<Hit> hits = trace(set, given_rows(set, packed));
        const Verdicts verdicts = oracle.judge(set, hits, Origins::own);
        all.verdicts.add(verdicts);
        for (const std::uint32_t ray : verdicts.flawed) {
            if (hits[ray].face_id != LOST && runs_along_any(set.rays[ray], scene.mesh)) {
                all.along++;
                continue;
            }
            all.flawed[(first + ray) % test::hard_kinds]++;
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
    return judged(scene, packed, count, [&](const RaySet& set, const std::vector<Row>& rows) {
        const TraceJob job = given_job(set.rays.size(), packed.tet_count + 1, false);
        session->set_rays(rows);
        other->set_rays(given_rows(set, records));
        std::vector<Hit> hits = traced(*session, job);
        EXPECT_EQ(different_rays(traced(*other, job), hits, 0), 0u);
        return hits;
    });
}

void expect_none_wrong_or_lost(const Scene& scene, const char* name)
{
    const auto [verdicts, flawed, along, first] = judged_on_openmp(scene, rays_wanted(40'000));
    const std::string counts = fmt::format(
        "{}: {} rays: {} agree, {} ties, {} settled for us, {} lost, {} along a triangle, {} wrong by kind{}", name,
        verdicts.rays, verdicts.agreed, verdicts.ties, verdicts.settled, verdicts.lost, along,
        verdicts.wrong + verdicts.lost - along, fmt::format(" {}", fmt::join(flawed, " ")));
    fmt::print("{}\n", counts);
    EXPECT_EQ(verdicts.lost, 0u) << counts << "; " << first;
    EXPECT_EQ(verdicts.wrong, along) << counts << "; " << first;
    EXPECT_LT(along, verdicts.rays / 100);
    EXPECT_GT(verdicts.agreed, verdicts.rays / 2);
}

class HardRaysOf : public testing::TestWithParam<std::string> {};

} // namespace

TEST(HardRays, of_hard_meshes_are_neither_wrong_nor_lost)
{
    for (const auto& [name, scene] : test::make_hard_scenes())
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
    const Scene scene = std::move(test::make_hard_scenes().front().scene);
    const PackedScene packed = pack(scene, Layout::tet80, TetOrder::hilbert);
    const mutant::SceneView view = mutant::view_of(packed);
    mutant::TraceParams params{};
    params.max_steps = packed.tet_count + 1;
    const Judged all = judged(scene, packed, 9'000, [&](const RaySet& set, const std::vector<Row>& rows) {
        std::vector<Hit> hits;
        for (std::size_t i = 0; i < set.rays.size(); i++)
            hits.push_back(std::bit_cast<Hit>(mutant::trace_given(view, params, rows[i], rows[set.rays.size() + i])));
        return hits;
    });
    EXPECT_GT(all.verdicts.lost + all.verdicts.wrong, 100u);
}
