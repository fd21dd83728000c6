#include "bench/truth/oracle.h"

#include "backends/openmp/backend.h"
#include "bench/truth/judge.h"
#include "bench/truth/walk_path.h"
#include "core/mesh/locate.h"
#include "core/rays/camera_set.h"
#include "scenes/procedural.h"
#include "tests/support/unpack.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <new>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::uint32_t size = 128;

struct SpoiltImage {
    Scene scene = make_cubes(9);
    PackedScene packed = pack(scene, Layout::tet80, TetOrder::chains);
    TraceJob job;
    std::vector<Hit> hits = std::vector<Hit>(std::size_t{size} * size);

    explicit SpoiltImage(Float3 camera_shift = {})
    {
        Camera camera = make_cameras(CameraSet::smoke, scene.mesh).front();
        for (int axis = 0; axis < 3; ++axis)
            camera.origin[axis] += camera_shift[axis];
        job.view = make_view(camera, size, size);
        place();
        trace({Structure::cdt, Method::maria, Layout::tet80, MathMode::exact});
    }
    void place()
    {
        const Start start = find_start(scene, job.view.origin);
        job.view.origin = start.origin;
        job.start_tet = start.tet == NO_TET ? NO_TET : packed.packed_of_mesh[start.tet];
        job.width = job.height = size;
        job.max_steps = packed.tet_count + 1;
    }
    void trace(const KernelId& kernel, unsigned threads = 2)
    {
        const auto session = openmp_backend().open(0, kernel, {&scene.mesh, &packed}, {.threads = threads});
        (void)session->trace(job, hits);
    }
    [[nodiscard]] Verdicts judged() const { return Oracle(scene.mesh, 2).judge(0, job.view, size, size, hits); }
    [[nodiscard]] std::size_t hit_pixel() const { return std::size_t{size} / 2 * size + size / 2; }
};

} // namespace

TEST(Oracle, agrees_with_the_walk_on_cubes)
{
    const Verdicts verdicts = SpoiltImage().judged();
    EXPECT_EQ(verdicts.rays, std::uint64_t{size} * size);
    EXPECT_EQ(verdicts.agreed + verdicts.ties + verdicts.settled, verdicts.rays);
    EXPECT_TRUE(verdicts.clean());
}

namespace {

template <class Spoil>
Verdicts verdicts_after(const Spoil& spoil)
{
    SpoiltImage traced;
    EXPECT_LT(traced.hits[traced.hit_pixel()].face_id, traced.scene.mesh.triangles.size())
        << "the middle pixel must hit";
    spoil(traced.hits[traced.hit_pixel()]);
    return traced.judged();
}

} // namespace

TEST(Oracle, a_single_wrong_answer_is_found_and_located)
{
    const Verdicts verdicts = verdicts_after([](Hit& hit) { hit.face_id = (hit.face_id + 7) % 100; });
    EXPECT_EQ(verdicts.wrong, 1u);
    ASSERT_TRUE(verdicts.first_wrong);
    EXPECT_EQ(verdicts.first_wrong->x, size / 2);
    EXPECT_EQ(verdicts.first_wrong->y, size / 2);
}

TEST(Oracle, a_false_miss_a_lost_ray_and_an_unwritten_hit_are_found)
{
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit = {NO_HIT, NO_TET, 0, 0, 0, hit.steps}; }).wrong, 1u);
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit.face_id = LOST; }).lost, 1u);
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit.face_id = POISON; }).wrong, 1u);
}

TEST(Oracle, t_u_and_v_must_name_one_point)
{
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit.t *= 1.0001f; }).wrong, 1u);
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit.u += 0.001f; }).wrong, 1u);
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit.v -= 0.001f; }).wrong, 1u);
    EXPECT_EQ(verdicts_after([](Hit& hit) { hit.t = std::nanf(""); }).wrong, 1u);
}

TEST(Oracle, the_other_view_is_traced_anew)
{
    SpoiltImage first;
    const SpoiltImage second({0.25f, 0, 0});
    Oracle oracle(first.scene.mesh, 2);
    EXPECT_TRUE(oracle.judge(0, first.job.view, size, size, first.hits).clean());
    EXPECT_TRUE(oracle.judge(1, second.job.view, size, size, second.hits).clean());
    EXPECT_FALSE(oracle.judge(1, second.job.view, size, size, first.hits).clean());
}

TEST(Walk, cameras_on_vertices_edges_and_faces_see_what_the_exact_rays_meet)
{
    SpoiltImage traced;
    const TetMesh& mesh = traced.scene.tets;
    Oracle oracle(traced.scene.mesh, 2);
    for (std::uint32_t index = 0; index < mesh.tets.size(); index += 401) {
        const auto v = [&](std::size_t i) { return mesh.vertices[mesh.tets[index].vertices[i]]; };
        const Float3 on_edge{(v(0).x + v(1).x) / 2, (v(0).y + v(1).y) / 2, (v(0).z + v(1).z) / 2};
        const Float3 on_face{(on_edge.x + v(2).x) / 2, (on_edge.y + v(2).y) / 2, (on_edge.z + v(2).z) / 2};
        for (const Float3 camera : {v(0), on_edge, on_face}) {
            traced.job.view.origin = camera;
            traced.place();
            traced.trace({Structure::cdt, Method::maria, Layout::tet80, MathMode::exact});
            const Verdicts verdicts = oracle.judge(index, traced.job.view, size, size, traced.hits);
            EXPECT_TRUE(verdicts.clean())
                << "tet " << index << ": " << verdicts.wrong << " wrong, " << verdicts.lost << " lost";
        }
    }
}

TEST(Walk, a_ray_at_its_cap_of_steps_is_lost)
{
    SpoiltImage traced;
    traced.job.max_steps = 3;
    traced.trace({Structure::cdt, Method::maria, Layout::tet80, MathMode::exact});
    EXPECT_EQ(traced.hits[traced.hit_pixel()].face_id, LOST);
    EXPECT_EQ(traced.hits[traced.hit_pixel()].steps, 3u);
    EXPECT_GT(traced.judged().lost, 0u);
}

TEST(Walk, layouts_and_threads_do_not_change_a_bit)
{
    SpoiltImage traced;
    const auto reference = traced.hits;
    traced.packed = pack(traced.scene, Layout::tet96, TetOrder::chains);
    traced.trace({Structure::cdt, Method::maria, Layout::tet96, MathMode::exact});
    EXPECT_TRUE(traced.hits == reference);
    for (const unsigned threads : {1u, 3u}) {
        traced.trace({Structure::cdt, Method::maria, Layout::tet96, MathMode::exact}, threads);
        EXPECT_TRUE(traced.hits == reference) << threads << " threads";
    }
}

namespace {

#if defined(__SSE2__)
// A scene so small that every product is denormal: it shows whether the walk's thread flushes them, as Embree and TBB
// leave their threads.
TEST(Walk, a_thread_that_flushes_denormals_is_set_back)
{
    constexpr KernelId kernel{Structure::cdt, Method::maria, Layout::tet80, MathMode::exact};
    SpoiltImage tiny;
    const auto shrink = [](std::uint32_t& bits) {
        bits = std::bit_cast<std::uint32_t>(std::bit_cast<float>(bits) * 0x1p-66f);
    };
    for (std::size_t word = 0; word < 4 * tiny.packed.tets.size(); ++word)
        if (word % 20 < 12) shrink(reinterpret_cast<std::uint32_t*>(tiny.packed.tets.data())[word]);
    for (auto& line : tiny.packed.lines)
        shrink(line);
    for (int axis = 0; axis < 3; ++axis)
        tiny.job.view.origin[axis] *= 0x1p-66f;
    tiny.trace(kernel, 1);
    const auto reference = tiny.hits;
    EXPECT_LT(reference[tiny.hit_pixel()].face_id, tiny.scene.mesh.triangles.size());

    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040); // flush to zero, denormals are zero
    tiny.trace(kernel, 1);
    const unsigned after = _mm_getcsr();
    _mm_setcsr(before);
    EXPECT_EQ(after & 0x8040, 0x8040u) << "the thread gets its own environment back";
    for (std::size_t i = 0; i < reference.size(); ++i)
        ASSERT_EQ(tiny.hits[i].steps, reference[i].steps) << "ray " << i;
}
#endif

} // namespace

TEST(Walk, order_of_tets_changes_their_numbers_only)
{
    SpoiltImage traced;
    const auto reference = traced.hits;
    traced.packed = pack(traced.scene, Layout::tet80, TetOrder::input);
    traced.place();
    traced.trace({Structure::cdt, Method::maria, Layout::tet80, MathMode::exact});
    for (std::size_t i = 0; i < reference.size(); ++i) {
        ASSERT_EQ(traced.hits[i].face_id, reference[i].face_id);
        ASSERT_EQ(traced.hits[i].steps, reference[i].steps);
        ASSERT_EQ(traced.hits[i].t, reference[i].t);
    }
}

TEST(Walk, fast_math_answers_stay_right_on_cubes)
{
    SpoiltImage traced;
    const KernelId fast{Structure::cdt, Method::maria, Layout::tet80, MathMode::fast};
    if (const auto reason = openmp_backend().why_not(0, fast); !reason.empty()) GTEST_SKIP() << reason;
    traced.trace(fast);
    EXPECT_EQ(traced.judged().wrong, 0u);
}

TEST(WalkPath, ends_in_the_tet_of_the_hit_and_goes_from_neighbour_to_neighbour)
{
    const SpoiltImage traced;
    const Hit& hit = traced.hits[traced.hit_pixel()];
    const auto path = walk_path(traced.packed, {Structure::cdt, Method::maria, Layout::tet80, MathMode::exact},
                                traced.job, size / 2, size / 2);
    ASSERT_EQ(path.size(), hit.steps);
    EXPECT_EQ(path.back(), hit.tet);
    const TetMesh mesh = unpack(traced.packed);
    for (std::size_t i = 1; i < path.size(); ++i) {
        bool neighbours = false;
        for (const auto half_face : mesh.tets[path[i - 1]].neighbours)
            neighbours = neighbours || (half_face != NO_HALF_FACE && half_face_tet(half_face) == path[i]);
        EXPECT_TRUE(neighbours) << "step " << i;
    }
}

TEST(Judge, has_a_threads_exception_end_only_the_judging)
{
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const Judge judge(mesh, 2);
    const auto without_memory = [](Verdicts&, std::size_t i) {
        if (i >= 3000) throw std::bad_alloc();
    };
    EXPECT_THROW(static_cast<void>(judge.for_each(9000, without_memory)), std::bad_alloc);
    EXPECT_NO_THROW(static_cast<void>(judge.for_each(3000, without_memory)));
}
