#include "bench/truth/oracle.h"

#include "backends/embree/bvh_builder.h"
#include "core/base/exact.h"
#include "core/device/given_quads.h"
#include "core/pack/pack_bvh.h"
#include "core/rays/ray_order.h"
#include "tests/support/given_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr RayKind all_kinds[] = {RayKind::primary, RayKind::shadow, RayKind::ao, RayKind::diffuse, RayKind::random};

const GivenScene& inside_camera()
{
    static const GivenScene made(64, true);
    return made;
}

void expect_clean(const GivenScene& given, RayKind kind, Method method)
{
    GivenOracle oracle(given.scene.mesh, 2);
    const RaySet set = make_rays(kind, given.source());
    const Verdicts verdicts = oracle.judge(set, given.answers(set, method), Origins::own);
    EXPECT_EQ(verdicts.rays, set.rays.size());
    EXPECT_EQ(verdicts.agreed + verdicts.ties + verdicts.settled, verdicts.rays);
    EXPECT_GT(verdicts.agreed, verdicts.rays * 99 / 100) << name_of(kind);
    EXPECT_TRUE(verdicts.clean()) << name_of(kind) << ": " << verdicts.wrong << " wrong, " << verdicts.lost << " lost";
}

} // namespace

TEST(GivenOracle, agrees_with_walks_on_every_kind_from_outside_and_inside)
{
    const GivenScene from_outside(96);
    for (const Method method : {Method::maria, Method::project})
        for (const RayKind kind : all_kinds) {
            expect_clean(from_outside, kind, method);
            expect_clean(inside_camera(), kind, method);
        }
}

namespace {

std::vector<Hit> bvh_answers(const TriangleMesh& mesh, const PackedScene& bvh, const RaySet& set)
{
    const KernelId kernel{
        .structure = Structure::bvh, .method = Method::single, .layout = bvh.layout, .task = Task::rays};
    const auto session = openmp_backend().open(0, kernel, {&mesh, &bvh}, {.threads = 2});
    session->set_rays(given_quads_offset(set, mesh));
    std::vector<Hit> answers(set.rays.size());
    (void)session->trace(given_job(set.rays.size(), 1, set.any_hit), answers);
    return answers;
}

} // namespace

TEST(GivenOracle, agrees_with_bvhs_but_where_their_offset_explains_it)
{
    const TriangleMesh& mesh = inside_camera().scene.mesh;
    const Bvh bvh = build_bvh(mesh).bvh;
    GivenOracle oracle(mesh, 2);
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const PackedScene packed = pack_bvh(mesh, bvh, layout);
        for (const RayKind kind : all_kinds) {
            const RaySet set = make_rays(kind, inside_camera().source());
            const Verdicts verdicts = oracle.judge(set, bvh_answers(mesh, packed, set), Origins::offset);
            EXPECT_TRUE(verdicts.clean()) << name_of(layout) << ", " << name_of(kind);
            EXPECT_LE(verdicts.offset, verdicts.rays / 100);
            EXPECT_EQ(verdicts.agreed + verdicts.ties + verdicts.settled + verdicts.offset, verdicts.rays);
        }
    }
}

TEST(GivenOracle, answers_for_offset_origins_are_wrong_where_origins_are_the_set_s_own)
{
    const TriangleMesh& mesh = inside_camera().scene.mesh;
    const PackedScene packed = pack_bvh(mesh, build_bvh(mesh).bvh, Layout::bvh2);
    const RaySet set = make_rays(RayKind::diffuse, inside_camera().source());
    EXPECT_GT(GivenOracle(mesh, 2).judge(set, bvh_answers(mesh, packed, set), Origins::own).wrong, 0u);
}

namespace {

struct Answered {
    RaySet set;
    std::vector<Hit> hits;
    std::size_t hit = 0, miss = 0; ///< a ray of each
};

// Seen from inside the ball every diffuse ray hits; of ao rays some do not.
Answered answered(RayKind kind)
{
    Answered all;
    all.set = make_rays(kind, inside_camera().source());
    all.hits = inside_camera().answers(all.set);
    const auto is_hit = [](const Hit& hit) { return hit.face_id != NO_HIT; };
    all.hit = static_cast<std::size_t>(std::find_if(all.hits.begin(), all.hits.end(), is_hit) - all.hits.begin());
    all.miss = static_cast<std::size_t>(std::find_if_not(all.hits.begin(), all.hits.end(), is_hit) - all.hits.begin());
    return all;
}

template <class Spoil>
Verdicts verdicts_after(RayKind kind, const Spoil& spoil)
{
    Answered all = answered(kind);
    EXPECT_LT(all.hit, all.hits.size());
    spoil(all);
    return GivenOracle(inside_camera().scene.mesh, 2).judge(all.set, all.hits, Origins::own);
}

} // namespace

TEST(GivenOracle, a_single_wrong_nearest_triangle_is_found_and_located)
{
    std::uint32_t pixel = 0;
    const Verdicts verdicts = verdicts_after(RayKind::diffuse, [&](Answered& all) {
        all.hits[all.hit].face_id = (all.hits[all.hit].face_id + 7) % 100;
        pixel = all.set.rays[all.hit].pixel;
    });
    EXPECT_EQ(verdicts.wrong, 1u);
    ASSERT_TRUE(verdicts.first_wrong);
    EXPECT_EQ(verdicts.first_wrong->y * 64 + verdicts.first_wrong->x, pixel);
    EXPECT_EQ(verdicts.flawed, std::vector<std::uint32_t>{pixel});
}

TEST(GivenOracle, a_false_miss_a_lost_ray_and_an_unwritten_hit_are_found)
{
    for (const RayKind kind : {RayKind::diffuse, RayKind::ao}) {
        const auto with = [&](std::uint32_t face) {
            return verdicts_after(kind, [&](Answered& all) { all.hits[all.hit] = {face, NO_TET, 0, 0, 0, 0}; });
        };
        EXPECT_EQ(with(NO_HIT).wrong, 1u) << name_of(kind);
        EXPECT_EQ(with(LOST).lost, 1u);
        EXPECT_EQ(with(POISON).wrong, 1u);
    }
}

TEST(GivenOracle, t_u_and_v_must_name_one_point_of_the_ray)
{
    const auto with = [&](auto&& change) {
        return verdicts_after(RayKind::diffuse, [&](Answered& all) { change(all.hits[all.hit]); }).wrong;
    };
    EXPECT_EQ(with([](Hit& hit) { hit.t *= 1.0001F; }), 1u);
    EXPECT_EQ(with([](Hit& hit) { hit.u += 0.001F; }), 1u);
    EXPECT_EQ(with([](Hit& hit) { hit.t = std::nanf(""); }), 1u);
    EXPECT_EQ(with([](Hit&) {}), 0u);
}

TEST(GivenOracle, a_ray_does_not_hit_where_it_starts)
{
    const Verdicts verdicts = verdicts_after(RayKind::ao, [](Answered& all) {
        all.hits[all.hit] = {all.set.rays[all.hit].triangle, 0, 0, 0.25F, 0.25F, 1};
    });
    EXPECT_EQ(verdicts.wrong, 1u);
}

TEST(GivenOracle, orders_of_rays_are_judged_alike)
{
    GivenOracle oracle(inside_camera().scene.mesh, 2);
    Verdicts last;
    for (const RayOrder order : {RayOrder::tiles, RayOrder::morton, RayOrder::shuffled}) {
        RaySet set = make_rays(RayKind::diffuse, inside_camera().source());
        const auto in_tiles = inside_camera().answers(set);
        arrange(set, order);
        const Verdicts verdicts = oracle.judge(set, inside_camera().answers(set), Origins::own);
        EXPECT_TRUE(verdicts.clean());
        EXPECT_TRUE(last.rays == 0 || verdicts.agreed == last.agreed);
        last = verdicts;
        EXPECT_EQ(oracle.judge(set, in_tiles, Origins::own).clean(), order == RayOrder::tiles)
            << "another set is traced anew";
    }
}

TEST(GivenOracle, an_empty_set_is_clean)
{
    EXPECT_EQ(GivenOracle(inside_camera().scene.mesh, 2).judge({}, {}, Origins::own).rays, 0u);
}

namespace {

// Three parallel triangles that a ray from the first one meets straight on: at 0, at `gap` above it and at 1/2.
TriangleMesh sheets(float gap)
{
    TriangleMesh mesh;
    for (const float z : {0.0F, gap, 0.5F}) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}
constexpr std::uint32_t start_sheet = 0, near_sheet = 1, far_sheet = 2;

RaySet straight_up(float end, bool any_hit)
{
    RaySet set;
    set.kind = any_hit ? RayKind::ao : RayKind::diffuse;
    set.any_hit = any_hit;
    set.width = 1;
    set.rays = {{{0.25F, 0.25F, 0}, {0, 0, 1}, end, NO_HALF_FACE, start_sheet, 0}};
    return set;
}

Verdicts judged(float gap, std::uint32_t face, float t, Origins origins, float end = NO_END, bool any_hit = false)
{
    const TriangleMesh mesh = sheets(gap);
    const Hit hit = face == NO_HIT ? Hit{NO_HIT, NO_TET, 0, 0, 0, 0} : Hit{face, NO_TET, t, 0.25F, 0.25F, 0};
    return GivenOracle(mesh, 1).judge(straight_up(end, any_hit), std::vector{hit}, origins);
}

} // namespace

// The offset from z = 0 is 2^-16, the bound here 2^-19.6.
TEST(GivenOracle, what_only_the_offset_explains_is_neither_right_nor_wrong)
{
    constexpr float gap = 0x1p-18F;
    EXPECT_EQ(judged(gap, near_sheet, gap, Origins::own).agreed, 1u);
    EXPECT_EQ(judged(gap, far_sheet, 0.5F, Origins::own).wrong, 1u);
    EXPECT_EQ(judged(gap, far_sheet, 0.5F - 0x1p-16F, Origins::own).wrong, 1u) << "t counts from the offset origin";
    EXPECT_EQ(judged(gap, far_sheet, 0.5F - 0x1p-16F, Origins::offset).offset, 1u);
    EXPECT_TRUE(judged(gap, far_sheet, 0.5F - 0x1p-16F, Origins::offset).clean());
    EXPECT_EQ(judged(gap, NO_HIT, 0, Origins::offset).wrong, 1u) << "the far sheet is there for both";
    EXPECT_EQ(judged(gap, NO_HIT, 0, Origins::offset, 0.25F, true).offset, 1u);
    EXPECT_EQ(judged(gap, NO_HIT, 0, Origins::own, 0.25F, true).wrong, 1u);
    EXPECT_EQ(judged(0x1p-12F, far_sheet, 0.5F - 0x1p-16F, Origins::offset).wrong, 1u) << "further than the offset";
}

TEST(GivenOracle, any_hit_will_do_where_that_is_asked)
{
    EXPECT_EQ(judged(0.25F, near_sheet, 0.25F, Origins::own, 1, true).agreed, 1u);
    EXPECT_EQ(judged(0.25F, far_sheet, 0.5F, Origins::own, 1, true).agreed, 1u);
    EXPECT_EQ(judged(0.25F, far_sheet, 0.5F, Origins::own, 1, false).wrong, 1u);
    EXPECT_EQ(judged(0.25F, far_sheet, 0.5F, Origins::own, 0.375F, true).wrong, 1u) << "past its end";
    EXPECT_EQ(judged(0.25F, NO_HIT, 0, Origins::own, 0.125F, true).agreed, 1u);
    EXPECT_EQ(judged(0.25F, NO_HIT, 0, Origins::own, 1, true).wrong, 1u);
}

TEST(GivenOracle, an_answer_that_names_no_triangle_will_do_where_any_hit_does)
{
    EXPECT_EQ(judged(0.25F, SOME_HIT, 0, Origins::own, 1, true).agreed, 1u);
    EXPECT_EQ(judged(0.25F, SOME_HIT, 0, Origins::own, 1, false).wrong, 1u) << "the nearest is asked for";
    EXPECT_EQ(judged(0.25F, SOME_HIT, 0, Origins::own, 0.125F, true).wrong, 1u);
    EXPECT_EQ(judged(0.25F, SOME_HIT, 0, Origins::own, 0.25F - 0x1p-20F, true).ties, 1u);
    EXPECT_EQ(judged(0.25F, SOME_HIT, 0, Origins::own, 0.25F - 0x1p-17F, true).wrong, 1u);
    EXPECT_EQ(judged(0.25F, SOME_HIT, 0, Origins::offset, 0.25F - 0x1p-17F, true).offset, 1u)
        << "the end is offset by 2^-16 too";
}

TEST(GivenOracle, a_hit_outside_a_triangle_s_edge_is_a_tie_within_the_bound)
{
    const TriangleMesh mesh = sheets(0.25F);
    const auto beside = [&](float x) {
        RaySet set = straight_up(1, true);
        set.rays.front().origin.x = x;
        set.rays.front().triangle = FREE_FACE;
        set.rays.front().origin.z = 0.125F;
        return GivenOracle(mesh, 1).judge(set, std::vector{Hit{SOME_HIT, NO_TET, 0, 0, 0, 0}}, Origins::own);
    };
    EXPECT_EQ(beside(0x1p-21F).settled, 1u);
    EXPECT_EQ(beside(-0x1p-21F).ties, 1u);
    EXPECT_EQ(beside(-0x1p-18F).wrong, 1u);
}

TEST(GivenOracle, a_triangle_within_the_bound_of_the_start_is_a_tie)
{
    EXPECT_EQ(judged(0x1p-21F, far_sheet, 0.5F, Origins::own).ties, 1u);
    EXPECT_EQ(judged(0x1p-21F, near_sheet, 0x1p-21F, Origins::own).settled, 1u);
    EXPECT_EQ(judged(0x1p-19F, far_sheet, 0.5F, Origins::own).wrong, 1u);
}

TEST(GivenOracle, a_triangle_within_the_error_of_t_of_the_end_is_a_tie)
{
    // The bound is 2^-19.6 here, and the error of t 2^-21.5.
    EXPECT_EQ(judged(0.25F, NO_HIT, 0, Origins::own, 0.25F + 0x1p-20F, true).ties, 1u);
    EXPECT_EQ(judged(0.25F, NO_HIT, 0, Origins::own, 0.25F + 0x1p-17F, true).wrong, 1u);
    const float end = 0.25F - 0x1p-22F;
    EXPECT_EQ(judged(0.25F, near_sheet, end, Origins::own, end, true).ties, 1u) << "its t is rounded";
    const float too_short = 0.25F - 0x1p-17F;
    EXPECT_EQ(judged(0.25F, near_sheet, too_short, Origins::own, too_short, true).wrong, 1u);
}
