#include "bench/measuring/view_recorder.h"

#include "bench/measuring/conformity.h"
#include "bench/measuring/ray_walks.h"
#include "bench/output/check_matrix.h"
#include "bench/output/difference_pictures.h"
#include "bench/rows/ray_store.h"
#include "bench/terminal/interrupts.h"
#include "core/rays/absorbed.h"
#include "core/rays/segments.h"
#include "tests/support/row_runs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wrapped_session.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Damage = std::function<void(std::span<Hit>)>;

/// A device that answers as openmp does, and then damages the answers.
class DamagedSession : public WrappedSession {
public:
    DamagedSession(std::unique_ptr<Session> inner, Damage damage)
        : WrappedSession(std::move(inner)), damage_(std::move(damage))
    {
    }

private:
    void change(std::span<Hit> hits) override { damage_(hits); }

    Damage damage_;
};

using WordDamage = std::function<void(std::span<std::uint32_t>)>;

/// The same of the words of a tally.
class DamagedTally : public WrappedSession {
public:
    DamagedTally(std::unique_ptr<Session> inner, WordDamage damage)
        : WrappedSession(std::move(inner)), damage_(std::move(damage))
    {
    }

private:
    void change_tally(std::span<std::uint32_t> words) override { damage_(words); }

    WordDamage damage_;
};

class Verify : public testing::Test {
protected:
    /// Verifies maria on tet80 through a damaged openmp that calls itself `backend`.
    RowRun verified(const std::string& backend, const Damage& damage, SelfTest self_test = {})
    {
        RowKey key{"cubes", "openmp", {}, RayKind::primary, TetOrder::chains};
        RowRun row = open_row(key, scene_, options_);
        EXPECT_EQ(row.self_test, SelfTest{}) << "openmp in exact mode";
        row.self_test = self_test;
        EXPECT_NE(row.session, nullptr) << reason_of(row);
        row.key.backend = backend;
        row.session = std::make_unique<DamagedSession>(std::move(row.session), damage);
        verify_rows({&row}, scene_, options_);
        return row;
    }

    /// A row of openmp's on rays that are given, whose answers are damaged, called `backend`.
    RowRun damaged_row(RayKind kind, Layout layout, const Damage& damage, const std::string& backend,
                       Task task = Task::rays)
    {
        RowKey key{"cubes", "openmp", {}, kind, TetOrder::chains};
        key.kernel.task = task;
        key.kernel.layout = layout;
        key.kernel.structure = structure_of(layout);
        if (key.kernel.structure == Structure::bvh) key.kernel.method = Method::single;
        RowRun row = open_row(key, scene_, options_);
        EXPECT_NE(row.session, nullptr) << reason_of(row);
        row.key.backend = backend;
        row.session = std::make_unique<DamagedSession>(std::move(row.session), damage);
        return row;
    }

    RowRun verified_given(RayKind kind, Layout layout, const Damage& damage, const std::string& backend = "other")
    {
        RowRun row = damaged_row(kind, layout, damage, backend);
        verify_rows({&row}, scene_, options_);
        return row;
    }

    static void damage_first_hit(std::span<Hit> hits, const std::function<void(Hit&)>& change)
    {
        for (Hit& hit : hits)
            if (hit.face_id < POISON) {
                change(hit);
                return;
            }
        FAIL() << "no ray hits";
    }

    Options options_ = parse_options({"check", "--size", "40", "--views", "0,2"});
    SceneWork scene_{loaded_cubes(6), options_};
};

} // namespace

TEST_F(Verify, right_answers_are_ok_and_counted)
{
    const RowRun row = verified("openmp", [](std::span<Hit>) {});
    ASSERT_NE(traced(row), nullptr) << reason_of(row);
    EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
    EXPECT_EQ(traced(row)->totals.rays, 2u * 40 * 40);
    EXPECT_EQ(traced(row)->verdicts.rays, 2u * 40 * 40);
    EXPECT_FALSE(traced(row)->compared);
    EXPECT_GT(traced(row)->totals.hits, 0u);
    EXPECT_GT(traced(row)->totals.misses, 0u);
}

TEST_F(Verify, an_interrupt_keeps_the_views_that_all_rows_have)
{
    for (const std::size_t completed : {std::size_t{1}, std::size_t{0}}) {
        SceneWork scene{loaded_cubes(6), options_};
        RowRun first = open_row({"cubes", "openmp", {}}, scene, options_),
               second = open_row({"cubes", "openmp", {}}, scene, options_);
        const auto interrupts = [&](const SeenImage& image) {
            if (image.view == completed && &image.row == &first) interrupt();
        };
        verify_rows({&first, &second}, scene, options_, interrupts);
        forget_interrupt();
        EXPECT_EQ(scene.views().size(), completed == 0 ? 2u : completed);
        for (const RowRun* row : {&first, &second}) {
            EXPECT_EQ(status_of(*row), completed == 0 ? Status::skipped : Status::ok) << reason_of(*row);
            const bool says_so = reason_of(*row).find("interrupted") != std::string::npos;
            EXPECT_EQ(says_so, completed == 0) << reason_of(*row);
            EXPECT_EQ(traced(*row) == nullptr ? 0 : traced(*row)->totals.rays, completed * 40 * 40);
        }
    }
}

TEST_F(Verify, another_backend_with_openmps_answers_is_ok)
{
    const RowRun row = verified("other", [](std::span<Hit>) {});
    EXPECT_EQ(status_of(row), Status::ok) << reason_of(row);
    EXPECT_TRUE(traced(row)->compared);
}

TEST_F(Verify, another_backend_with_one_other_step_count_is_wrong)
{
    const RowRun row = verified("other", [](std::span<Hit> hits) { hits[41].steps += 1; });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(traced(row)->different, 2u) << "one a view";
    ASSERT_TRUE(traced(row)->first_different.has_value());
    EXPECT_EQ(traced(row)->first_different->view, 0u);
    EXPECT_EQ(traced(row)->first_different->x, 1u);
    EXPECT_EQ(traced(row)->first_different->y, 1u);
}

TEST_F(Verify, a_method_with_a_wrong_face_is_flawed)
{
    const RowRun row = verified("openmp", [](std::span<Hit> hits) {
        damage_first_hit(hits, [](Hit& hit) { hit.face_id = hit.face_id == 0 ? 200 : 0; });
    });
    EXPECT_EQ(status_of(row), Status::flawed);
    EXPECT_GE(traced(row)->verdicts.wrong, 2u);
    EXPECT_TRUE(traced(row)->verdicts.first_wrong.has_value());
}

TEST_F(Verify, a_lost_ray_makes_a_row_flawed)
{
    const RowRun row = verified("openmp", [](std::span<Hit> hits) { hits[0].face_id = LOST; });
    EXPECT_EQ(status_of(row), Status::flawed);
    EXPECT_EQ(reason_of(row), "2 lost");
    EXPECT_EQ(traced(row)->verdicts.lost, 2u);
}

TEST_F(Verify, a_ray_lost_at_the_device_s_own_cap_is_explained)
{
    const auto limited = [&](std::uint32_t max_steps, std::uint32_t steps) {
        RowRun row = open_row({"cubes", "openmp", {}, RayKind::primary, TetOrder::chains}, scene_, options_);
        row.device.max_steps = max_steps;
        row.device.implementation = "a device";
        row.key.backend = "other";
        verify_rows({&row}, scene_, options_);
        EXPECT_EQ(traced(row)->different, 0u) << "openmp is compared under the same cap";
        EXPECT_EQ(traced(row)->verdicts.lost > 0, steps > 0);
        return reason_of(row);
    };
    EXPECT_EQ(limited(100'000, 0), "") << "more steps than there are tets";
    const std::string reason = limited(3, 3);
    EXPECT_NE(reason.find("after 3 steps, where loops of a device may end early"), std::string::npos) << reason;
}

TEST_F(Verify, of_math_mode_fast_flaws_are_counted_and_fail_nothing)
{
    const auto lose = [](std::span<Hit> hits) { hits[0].face_id = LOST; };
    RowRun row = verified("openmp", lose);
    EXPECT_TRUE(fails(row, true));
    row.key.kernel.math = MathMode::fast;
    EXPECT_EQ(status_of(row), Status::flawed);
    EXPECT_FALSE(fails(row, false));
    EXPECT_EQ(reason_of(row), "2 lost; math mode fast is held to no proof");
    row.key.kernel = {
        .structure = Structure::bvh, .method = Method::single, .layout = Layout::embree, .math = MathMode::fast};
    EXPECT_EQ(reason_of(row), "2 lost") << "Embree is without modes";
}

TEST_F(Verify, a_wrong_parameter_makes_a_row_flawed)
{
    const RowRun row =
        verified("openmp", [](std::span<Hit> hits) { damage_first_hit(hits, [](Hit& hit) { hit.t *= 1.01f; }); });
    EXPECT_EQ(status_of(row), Status::flawed);
    EXPECT_GE(traced(row)->verdicts.wrong, 2u);
}

TEST_F(Verify, a_ray_that_was_never_written_is_wrong_and_named)
{
    const RowRun row = verified("other", [](std::span<Hit> hits) { hits[5].face_id = POISON; });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(conformity_text(row), "wrong");
    EXPECT_EQ(reason_of(row), "1 of 1600 rays were never written, the first at view 0, pixel (5, 0)");
    EXPECT_EQ(row.session, nullptr);
    std::vector<RowRun> rows(1);
    rows[0].outcome = row.outcome;
    EXPECT_EQ(exit_code(records_of(rows), true), 1);
}

TEST_F(Verify, a_kernel_that_never_ran_is_wrong)
{
    const RowRun row =
        verified("other", [](std::span<Hit> hits) { std::memset(hits.data(), 0xFD, hits.size_bytes()); });
    EXPECT_EQ(status_of(row), Status::wrong) << reason_of(row);
}

TEST_F(Verify, a_device_that_answers_with_an_earlier_launchs_hits_is_wrong)
{
    std::vector<Hit> first;
    const RowRun row = verified("other", [&](std::span<Hit> hits) {
        if (first.empty()) first.assign(hits.begin(), hits.end());
        std::copy(first.begin(), first.end(), hits.begin());
    });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(traced(row)->first_different->view, 2u);
}

TEST_F(Verify, a_device_that_changes_its_answer_is_wrong)
{
    int calls = 0;
    const RowRun row = verified("other", [&](std::span<Hit> hits) { hits[3].steps += ++calls > 2 ? 1u : 0u; });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(reason_of(row), "the answers of view 0 changed when it was traced again");
}

TEST_F(Verify, a_device_that_writes_elsewhere_is_wrong)
{
    RowRun row = verified(
        "openmp", [](std::span<Hit>) { throw Error(ErrorKind::wrong_result, "the kernel wrote before its hits"); });
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(conformity_of(row), Conformity::wrong);
}

TEST_F(Verify, a_device_that_divides_inexactly_may_be_within_its_promise_and_no_further)
{
    SelfTest inexact;
    inexact.division_ulps = 1;
    const auto off_by = [&](int ulps, const SelfTest& test) {
        return verified(
            "other",
            [&](std::span<Hit> hits) {
                damage_first_hit(hits, [&](Hit& hit) {
                    for (int i = 0; i < ulps; ++i)
                        hit.t = std::nextafter(hit.t, 100.0f);
                });
            },
            test);
    };
    EXPECT_EQ(conformity_text(off_by(0, inexact)), "bit-exact");
    EXPECT_EQ(conformity_text(off_by(2, inexact)), "within 2 ulp");
    EXPECT_EQ(status_of(off_by(2, inexact)), Status::ok);
    EXPECT_EQ(conformity_text(off_by(4, inexact)), "wrong: 2 rays");
    EXPECT_EQ(conformity_text(off_by(1, {})), "wrong: 2 rays") << "this device's division is correctly rounded";
}

TEST_F(Verify, a_device_that_contracts_may_not_claim_to_be_exact)
{
    SelfTest contracting;
    contracting.contracts = true;
    const RowRun row = verified(
        "other", [](std::span<Hit>) {}, contracting);
    EXPECT_EQ(traced(row)->different, 0u);
    EXPECT_EQ(conformity_of(row), Conformity::not_exact);
    EXPECT_EQ(conformity_text(row), "not exact: contracts");
}

TEST_F(Verify, images_are_shown_with_openmps_hits_next_to_them)
{
    RowRun row = open_row({"cubes", "openmp", {}}, scene_, options_);
    row.key.backend = "other";
    std::size_t seen = 0;
    verify_rows({&row}, scene_, options_, [&](const SeenImage& image) {
        ++seen;
        EXPECT_EQ(compare_hits(image.hits, image.reference, {}).inexact, 0u);
        const Pixmap picture = draw_differences(image.hits, image.reference, {}, scene_, image.view);
        std::vector<Hit> changed(image.hits.begin(), image.hits.end());
        changed[7].steps += 1;
        const Pixmap marked = draw_differences(changed, image.reference, {}, scene_, image.view);
        std::size_t different = 0;
        for (std::size_t i = 0; i < marked.pixels.size(); ++i)
            different += marked.pixels[i] == picture.pixels[i] ? 0u : 1u;
        EXPECT_EQ(different, 1u);
        EXPECT_FALSE(marked.pixels[7] == picture.pixels[7]);
    });
    EXPECT_EQ(seen, 2u);
}

TEST_F(Verify, what_a_device_throws_ends_as_the_rows_outcome)
{
    const RowRun unsupported =
        verified("openmp", [](std::span<Hit>) { throw Error(ErrorKind::unsupported, "buffer of 3 GB"); });
    EXPECT_EQ(status_of(unsupported), Status::unsupported);
    EXPECT_EQ(reason_of(unsupported), "buffer of 3 GB");
    const RowRun failed = verified("openmp", [](std::span<Hit>) { throw std::runtime_error("driver gone"); });
    EXPECT_EQ(status_of(failed), Status::error);
    EXPECT_THROW(
        static_cast<void>(verified("openmp", [](std::span<Hit>) { throw Error(ErrorKind::interrupted, "^C"); })),
        Error);
}

TEST_F(Verify, given_rays_are_judged_and_compared_where_they_are_given)
{
    for (const RayKind kind : {RayKind::shadow, RayKind::ao, RayKind::diffuse, RayKind::random})
        for (const Layout layout : {Layout::tet80, Layout::bvh2}) {
            const RowRun row = verified_given(kind, layout, [](std::span<Hit>) {});
            ASSERT_NE(traced(row), nullptr) << row_name(row.key) << ": " << reason_of(row);
            EXPECT_EQ(status_of(row), Status::ok) << row_name(row.key) << ": " << reason_of(row);
            EXPECT_TRUE(traced(row)->compared);
            EXPECT_GT(traced(row)->totals.rays, 100u) << row_name(row.key);
            EXPECT_EQ(traced(row)->verdicts.rays, traced(row)->totals.rays);
        }
}

TEST_F(Verify, a_given_ray_that_differs_is_named_by_the_pixel_it_was_made_for)
{
    const RowRun row =
        verified_given(RayKind::diffuse, Layout::tet80, [](std::span<Hit> hits) { hits[17].steps += 1; });
    EXPECT_EQ(status_of(row), Status::wrong);
    ASSERT_TRUE(traced(row)->first_different.has_value());
    const std::uint32_t pixel = scene_.given_rays().set(scene_, RayKind::diffuse, RayOrder::tiles, 0).rays[17].pixel;
    EXPECT_EQ(traced(row)->first_different->x, pixel % 40);
    EXPECT_EQ(traced(row)->first_different->y, pixel / 40);
}

TEST_F(Verify, paths_of_tets_are_reported_only_of_primary_rays_through_tets)
{
    const auto one_step_more = [](std::span<Hit> hits) { hits[17].steps += 1; };
    for (const Layout layout : {Layout::tet80, Layout::cwbvh}) {
        RowRun given = verified_given(RayKind::diffuse, layout, one_step_more);
        note_walks(given);
        const std::string text = differences_text(given);
        EXPECT_NE(text.find("rays differ from openmp's"), std::string::npos) << text;
        EXPECT_EQ(text.find("tets of"), std::string::npos) << text;
    }
    RowRun primary = verified("other", [](std::span<Hit> hits) {
        for (Hit& hit : hits)
            if (hit.face_id < POISON) hit.steps += 1;
    });
    note_walks(primary);
    EXPECT_NE(differences_text(primary).find("tets of openmp"), std::string::npos);
}

TEST_F(Verify, segments_are_compared_bit_by_bit_and_judged_by_the_walk)
{
    const auto verified_segments = [&](RayKind kind, const Damage& damage, const std::string& backend) {
        RowRun row = damaged_row(kind, Layout::tet80, damage, backend, Task::segments);
        verify_rows({&row}, scene_, options_);
        return row;
    };
    for (const RayKind kind : {RayKind::primary, RayKind::diffuse, RayKind::random}) {
        const RowRun right = verified_segments(
            kind, [](std::span<Hit>) {}, "other");
        ASSERT_NE(traced(right), nullptr) << reason_of(right);
        EXPECT_EQ(status_of(right), Status::ok) << reason_of(right);
        EXPECT_EQ(conformity_of(right), Conformity::bit_exact);
        EXPECT_TRUE(right.ray_hash.has_value());
        EXPECT_GT(traced(right)->totals.length_units, 0u);
        EXPECT_GT(traced(right)->totals.hit_steps, traced(right)->totals.hits);
    }
    const auto one_length = [](std::span<Hit> hits) {
        Segments answer = segments_of(hits[3]);
        ++answer.length;
        hits[3] = as_hit(answer);
    };
    const RowRun wrong = verified_segments(RayKind::random, one_length, "other");
    EXPECT_EQ(traced(wrong)->different, 2u) << "one a view: a unit of 2^-28 is a difference";
    EXPECT_EQ(status_of(wrong), Status::wrong);
    EXPECT_NE(differences_text(wrong).find("crossings, tet"), std::string::npos) << differences_text(wrong);
    const RowRun flawed = verified_segments(RayKind::random, one_length, "openmp");
    EXPECT_EQ(traced(flawed)->verdicts.wrong, 2u);
    EXPECT_EQ(status_of(flawed), Status::flawed);
    const RowRun lost = verified_segments(
        RayKind::random, [](std::span<Hit> hits) { hits[3].face_id = LOST; }, "openmp");
    EXPECT_EQ(traced(lost)->verdicts.lost, 2u);
}

TEST_F(Verify, absorbed_light_is_compared_bit_by_bit_and_judged_by_the_walk)
{
    const auto verified_light = [&](const Damage& damage, const std::string& backend) {
        RowRun row = damaged_row(RayKind::random, Layout::tet80, damage, backend, Task::absorb);
        verify_rows({&row}, scene_, options_);
        return row;
    };
    const auto one_unit = [](std::span<Hit> hits) {
        Absorbed answer = absorbed_of(hits[3]);
        ++answer.light;
        hits[3] = as_hit(answer);
    };
    for (const char* const backend : {"openmp", "other"}) {
        const RowRun right = verified_light([](std::span<Hit>) {}, backend);
        EXPECT_EQ(status_of(right), Status::ok) << reason_of(right);
        EXPECT_GT(traced(right)->totals.light_units, 0u);
    }
    EXPECT_EQ(traced(verified_light(one_unit, "openmp"))->verdicts.wrong, 2u);
    const RowRun wrong = verified_light(one_unit, "other");
    EXPECT_EQ(status_of(wrong), Status::wrong);
    EXPECT_NE(differences_text(wrong).find(" passes"), std::string::npos) << differences_text(wrong);
}

TEST_F(Verify, sums_of_a_tally_are_judged_tet_by_tet)
{
    const auto verified_tally = [&](const WordDamage& damage, const std::string& backend) {
        RowRun row = open_row({"cubes", "openmp", {.task = Task::tally}, RayKind::random}, scene_, options_);
        row.key.backend = backend;
        row.session = std::make_unique<DamagedTally>(std::move(row.session), damage);
        verify_rows({&row}, scene_, options_);
        return row;
    };
    for (const char* const backend : {"openmp", "other"}) {
        const RowRun right = verified_tally([](std::span<std::uint32_t>) {}, backend);
        EXPECT_EQ(status_of(right), Status::ok) << reason_of(right);
        const RowRun carry = verified_tally([](std::span<std::uint32_t> words) { --words[1]; }, backend);
        EXPECT_EQ(status_of(carry), Status::wrong);
        EXPECT_NE(reason_of(carry).find("add up to"), std::string::npos) << reason_of(carry);
        const RowRun moved = verified_tally([](std::span<std::uint32_t> words) { ++words[0], --words[4]; }, backend);
        EXPECT_EQ(status_of(moved), Status::wrong);
        EXPECT_NE(reason_of(moved).find("the sums of 2 of"), std::string::npos) << reason_of(moved);
    }
}

TEST_F(Verify, a_given_ray_with_a_wrong_face_is_flawed)
{
    for (const RayKind kind : {RayKind::shadow, RayKind::diffuse}) {
        const RowRun row = verified_given(
            kind, Layout::tet80,
            [](std::span<Hit> hits) {
                damage_first_hit(hits, [](Hit& hit) { hit = {NO_HIT, hit.tet, 0, 0, 0, hit.steps}; });
            },
            "openmp");
        EXPECT_EQ(status_of(row), Status::flawed) << name_of(kind);
        EXPECT_GE(traced(row)->verdicts.wrong, 1u) << name_of(kind);
    }
}

TEST_F(Verify, visits_are_counted_only_on_openmps_bvhs)
{
    const RowRun counted = verified_given(
        RayKind::diffuse, Layout::cwbvh, [](std::span<Hit>) {}, "openmp");
    EXPECT_EQ(traced(counted)->visits.rays, traced(counted)->totals.rays);
    EXPECT_GE(traced(counted)->visits.nodes, traced(counted)->visits.rays) << "each ray enters the root";
    EXPECT_GE(traced(counted)->visits.triangles, traced(counted)->totals.hits);
    const RowRun of_tets = verified_given(
        RayKind::diffuse, Layout::tet80, [](std::span<Hit>) {}, "openmp");
    EXPECT_EQ(traced(of_tets)->visits.rays, 0u);
}

TEST_F(Verify, a_counting_build_that_answers_otherwise_is_an_error)
{
    const RowRun row = verified_given(
        RayKind::diffuse, Layout::bvh2,
        [](std::span<Hit> hits) { damage_first_hit(hits, [](Hit& hit) { hit.u += 0.25f; }); }, "openmp");
    EXPECT_EQ(status_of(row), Status::error) << reason_of(row);
    EXPECT_NE(reason_of(row).find("visits"), std::string::npos) << reason_of(row);
}

TEST_F(Verify, pictures_of_given_rays_show_them_at_their_pixels)
{
    const TemporaryFolder folder;
    DifferencePictures pictures(folder.path());
    RowRun row = damaged_row(
        RayKind::diffuse, Layout::tet80, [](std::span<Hit> hits) { hits[3].steps += 1; }, "other");
    verify_rows({&row}, scene_, options_, [&](const SeenImage& image) { pictures.see(image); });
    ASSERT_EQ(pictures.files().size(), 2u) << "one a view";
    EXPECT_GT(std::filesystem::file_size(pictures.files().front()), 100u);
}
