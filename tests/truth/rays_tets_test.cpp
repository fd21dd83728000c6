// Rays through optimised tets: the triangles that they hit are those of the tets that the optimiser began with. Where
// a ray hits another one, exact arithmetic has to find a witness for each answer that is not the exact ray's.
#include "backends/openmp/backend.h"
#include "bench/truth/oracle.h"
#include "bench/truth/settle.h"
#include "core/base/exact.h"
#include "core/device/given_quads.h"
#include "core/mesh/locate.h"
#include "scenes/load.h"
#include "scenes/optimise/optimise.h"
#include "scenes/procedural.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_rays.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::uint32_t image_size = 96;
constexpr std::size_t given_rays = 16'384;

/// A scene in TetGen's tets, and in those for rays.
struct Both {
    Scene plain, optimised;
};

Both both_of(const std::string& name)
{
    if (name != "cubes")
        return {load_scene({name, default_build(TetsKind::cdt)}, {}).scene,
                load_scene({name, default_build(TetsKind::rays)}, {}).scene};
    Both both{make_cubes(9), make_cubes(9)};
    both.optimised.tets = optimise(both.plain.tets, {3, 0}, {}).mesh;
    return both;
}

/// A scene, packed for a method; its walks on openmp.
class TracedImage {
public:
    TracedImage(const Scene& scene, Method method) : scene_(scene), method_(method), packed_(pack(scene, layout, order))
    {
    }

    [[nodiscard]] std::vector<Hit> image(const Camera& camera) const
    {
        TraceJob job;
        job.view = make_view(camera, image_size, image_size);
        const Start start = find_start(scene_, job.view.origin);
        job.view.origin = start.origin;
        start_in(job, packed_, scene_, start.tet);
        job.width = job.height = image_size;
        job.max_steps = packed_.tet_count + 1;
        return traced(*open(Task::trace), job);
    }
    [[nodiscard]] std::vector<Hit> given(const RaySet& set) const
    {
        const auto session = open(Task::rays);
        session->set_rays(given_quads(set, packed_));
        return traced(*session, given_job(set.rays.size(), packed_.tet_count + 1, false));
    }

private:
    static constexpr Layout layout = Layout::tet80;
    static constexpr TetOrder order = TetOrder::chains;

    [[nodiscard]] std::unique_ptr<Session> open(Task task) const
    {
        const KernelId kernel{.method = method_, .layout = layout, .task = task};
        return openmp_backend().open(0, kernel, {&scene_.mesh, &packed_}, {.threads = 2});
    }

    const Scene& scene_;
    Method method_;
    PackedScene packed_;
};

/// The rays of an image as exact arithmetic takes them, by pixel.
std::vector<ExactRay> exact_rays(const Scene& scene, const Camera& camera)
{
    View view = make_view(camera, image_size, image_size);
    const Start start = find_start(scene, view.origin);
    view.origin = start.origin;
    std::vector<ExactRay> rays(std::size_t{image_size} * image_size);
    for (const GivenRay& ray :
         make_rays(RayKind::primary, {scene, 0, view, image_size, image_size, start.tet, {}, {}}).rays)
        rays[ray.pixel] = {ray.origin, ray.direction};
    return rays;
}

/// Lines from outside the domain: chords, and at edges of a scene's tets; of `project` also at vertices, along edges
/// and in faces, on which `maria` may err in any tets (docs/spec/methods.md, M10).
RaySet whole_lines(const Scene& scene, Method method)
{
    RaySet set{RayKind::random, RayOrder::tiles, false, 0, TILE_WIDTH, {}};
    const HardRays rays(scene);
    for (std::uint64_t number = 0; set.rays.size() < given_rays; ++number) {
        const HardKind kind = HardRays::kind_of(number);
        const bool is_wanted = method == Method::project ? kind < HardKind::from_vertex
                                                         : kind == HardKind::chord || kind == HardKind::at_edge;
        if (is_wanted) set.rays.push_back(rays.ray(number));
    }
    return set;
}

/// Rays that two builds of a scene answer with different triangles, and those of them for which an answer is neither
/// the exact ray's nor has a witness. A lost ray is wrong.
struct SceneDifferences {
    std::uint64_t ties = 0, wrong = 0;
    std::string first; ///< of the wrong ones
};

class TetsComparison {
public:
    explicit TetsComparison(const TriangleMesh& mesh) : search_(mesh), settler_(mesh, search_) {}

    void add(SceneDifferences& found, const ExactRay& ray, const Hit& plain, const Hit& optimised) const
    {
        if (plain.face_id == optimised.face_id && plain.face_id != LOST) return;
        for (const Hit& hit : {plain, optimised}) {
            const bool is_lost = hit.face_id == LOST;
            const Settlement verdict =
                is_lost ? Settlement{} : settler_.settle(ray, {}, hit.face_id, tie_bound(ray.origin));
            if (verdict.kind != Settlement::Kind::wrong) continue;
            ++found.wrong;
            if (found.first.empty())
                found.first = fmt::format("triangles {} and {}: {}", plain.face_id, optimised.face_id,
                                          is_lost ? "lost" : verdict.reason);
            return;
        }
        ++found.ties;
    }

private:
    ExactSearch search_;
    Settler settler_;
};

/// Of whole lines.
SceneDifferences differences_of_lines(const Both& scenes, Method method)
{
    const RaySet set = whole_lines(scenes.plain, method);
    const TetsComparison comparison(scenes.plain.mesh);
    const auto before = TracedImage(scenes.plain, method).given(set),
               after = TracedImage(scenes.optimised, method).given(set);
    SceneDifferences found;
    for (std::size_t i = 0; i < set.rays.size(); ++i)
        comparison.add(found, {set.rays[i].origin, set.rays[i].direction}, before[i], after[i]);
    return found;
}

std::uint64_t steps_of(const std::vector<Hit>& hits)
{
    std::uint64_t steps = 0;
    for (const Hit& hit : hits)
        steps += hit.steps;
    return steps;
}

class RaysTetsOf : public testing::TestWithParam<std::string> {};

} // namespace

TEST_P(RaysTetsOf, give_the_same_hits_in_fewer_steps)
{
    const std::string name = GetParam();
    if (const std::string reason = why_not_available(name); !reason.empty()) GTEST_SKIP() << reason;
    const Both scenes = both_of(name);
    ASSERT_TRUE(scenes.plain.mesh == scenes.optimised.mesh);
    ASSERT_EQ(scenes.plain.domain.lines, scenes.optimised.domain.lines);
    ASSERT_FALSE(scenes.plain.tets == scenes.optimised.tets) << scenes.optimised.build.optimised.reason;
    const TetsComparison comparison(scenes.plain.mesh);
    Oracle oracle(scenes.plain.mesh, 2);
    for (const Method method : {Method::maria, Method::project}) {
        SCOPED_TRACE(name_of(method));
        const TracedImage plain(scenes.plain, method), optimised(scenes.optimised, method);
        std::uint64_t steps_before = 0, steps_after = 0;
        SceneDifferences found;
        for (const Camera& camera : make_cameras(CameraSet::smoke, scenes.plain.mesh)) {
            const auto before = plain.image(camera), after = optimised.image(camera);
            const auto rays = exact_rays(scenes.plain, camera);
            for (std::size_t i = 0; i < rays.size(); ++i)
                comparison.add(found, rays[i], before[i], after[i]);
            EXPECT_TRUE(
                oracle.judge(0, make_view(camera, image_size, image_size), image_size, image_size, after).clean());
            steps_before += steps_of(before);
            steps_after += steps_of(after);
        }
        EXPECT_EQ(found.wrong, 0u) << found.first;
        EXPECT_LT(steps_after, steps_before);
        const SceneDifferences lines = differences_of_lines(scenes, method);
        EXPECT_EQ(lines.wrong, 0u) << lines.first;
        if (method == Method::maria) {
            EXPECT_GT(lines.ties, 0u) << "no witness was looked for";
        }
        fmt::print("{}, {}: ties that go the other way: {} of {} primary rays, {} of {} lines\n", name, name_of(method),
                   found.ties, 4 * image_size * image_size, lines.ties, given_rays);
    }
}

INSTANTIATE_TEST_SUITE_P(each, RaysTetsOf, testing::Values("cubes", "banana", "bunny", "armadillo", "city@8000"),
                         [](const auto& test) { return test.param.substr(0, test.param.find('@')); });

TEST(RaysTets, that_name_two_triangles_for_each_other_are_found)
{
    Both scenes = both_of("cubes");
    EXPECT_EQ(differences_of_lines(scenes, Method::maria).wrong, 0u);
    for (Tet& tet : scenes.optimised.tets.tets)
        for (std::uint32_t& face : tet.faces)
            if (face == 3 || face == 4) face = 7 - face;
    EXPECT_GT(differences_of_lines(scenes, Method::maria).wrong, 5u);
}
