#include "bench/rivals/judged_claim.h"
#include "bench/rivals/rival_run.h"
#include "tests/support/fake_backend.h"
#include "tests/support/row_runs.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr OldRun old_run = {"a machine", "some views on a machine"};

/// "half32 is faster than our BVHs on bunny".
RivalClaim rival_claim(Walk walk = Walk::half32, Rival rival = Rival::our_single, double boundary = 1)
{
    return {"a-claim", "a walk is faster", "README.md", "1.50 bunny", &old_run,           walk,
            rival,     DeviceKind::cpu,    {},          {"bunny"},    {RayKind::primary}, boundary};
}

KernelId kernel(Method method, Layout layout, Schedule schedule = Schedule::tiles)
{
    return {structure_of(layout), method, layout, MathMode::exact, schedule};
}

/// A row on the host, or on an emulated device of another backend, that takes so long for 1,000 rays.
RowRecord row_of(const KernelId& kernel, double seconds, const std::string& backend = "openmp",
                 const std::string& scene = "bunny")
{
    RowRecord row;
    row.key = {scene, backend, kernel};
    row.device.name = "a device";
    row.device.usable = true;
    row.device.kind = backend == "openmp" || backend == "embree" ? DeviceKind::cpu : DeviceKind::emulated;
    Traced result;
    result.totals.rays = 1000;
    result.totals.hits = 250;
    row.outcome = result;
    row.samples_s = {0.99 * seconds, seconds, 1.01 * seconds, seconds, 0.99 * seconds, 1.01 * seconds};
    return row;
}

const KernelId half32 = kernel(Method::project, Layout::half32), tet64 = kernel(Method::project, Layout::tet64),
               packets = kernel(Method::project, Layout::half32, Schedule::packets),
               bvh2 = kernel(Method::single, Layout::bvh2), cwbvh = kernel(Method::single, Layout::cwbvh),
               native_bvh2 = kernel(Method::single, Layout::bvh2, Schedule::native);

RowRecord embree(Method method, double seconds, Layout layout = Layout::embree)
{
    RowRecord row = row_of(kernel(method, layout), seconds, "embree");
    row.key.kernel.math = MathMode::fast; // of the list's
    return row;
}

JudgedClaim judged(const RivalClaim& claim, const std::vector<RowRecord>& rows, LeftOut left_out = {})
{
    static RivalClaim kept; // a judged claim points to it
    kept = claim;
    static std::vector<RivalContest> contests;
    contests = rival_contests(rows, {});
    return judge(kept, contests, left_out);
}

ClaimVerdict rival_verdict(const RivalClaim& claim, const std::vector<RowRecord>& rows)
{
    return judged(claim, rows).verdict;
}

std::string evidence_of(const RivalClaim& claim, const std::vector<RowRecord>& rows)
{
    return to_claim(judged(claim, rows)).evidence;
}

constexpr auto holds = ClaimVerdict::holds, fails_to_hold = ClaimVerdict::does_not_hold,
               untested = ClaimVerdict::not_testable;

} // namespace

TEST(Rivals, a_claim_holds_if_the_ratio_to_the_fastest_rival_is_above_its_boundary)
{
    const auto rows = list(row_of(half32, 1), row_of(bvh2, 2), row_of(cwbvh, 3));
    EXPECT_EQ(rival_verdict(rival_claim(), rows), holds);
    EXPECT_EQ(rival_verdict(rival_claim(Walk::half32, Rival::our_single, 1.9), rows), holds);
    EXPECT_EQ(rival_verdict(rival_claim(Walk::half32, Rival::our_single, 2.1), rows), fails_to_hold)
        << "3 times as fast as cwbvh, but bvh2 is faster";
    EXPECT_EQ(rival_verdict(rival_claim(Walk::half32, Rival::our_single, 2), rows), untested) << "2 is in the interval";
}

TEST(Rivals, the_rival_has_its_form_for_processors)
{
    EXPECT_EQ(rival_verdict(rival_claim(), list(row_of(half32, 1), row_of(bvh2, 2), row_of(native_bvh2, 0.5))),
              fails_to_hold);
}

TEST(Rivals, the_fastest_bvh_of_a_processor_is_any_entry_point_of_embree)
{
    const auto any = rival_claim(Walk::packets, Rival::any);
    EXPECT_EQ(rival_verdict(any, list(row_of(packets, 1), row_of(bvh2, 9), embree(Method::single, 5),
                                      embree(Method::packet16, 2))),
              holds);
    EXPECT_EQ(rival_verdict(any, list(row_of(packets, 1), row_of(bvh2, 9), embree(Method::single, 0.5),
                                      embree(Method::packet16, 2))),
              fails_to_hold);
    EXPECT_EQ(rival_verdict(any, list(row_of(packets, 1), row_of(bvh2, 9), embree(Method::packet16, 2),
                                      embree(Method::stream, 0.5, Layout::embree_robust))),
              fails_to_hold);
}

TEST(Rivals, without_embree_nothing_is_faster_than_the_fastest_bvh_of_a_processor)
{
    const auto any = rival_claim(Walk::packets, Rival::any);
    const auto rows = list(row_of(packets, 1), row_of(bvh2, 9));
    EXPECT_EQ(rival_verdict(any, rows), untested);
    EXPECT_NE(evidence_of(any, rows).find("Embree"), std::string::npos);
    EXPECT_EQ(rival_verdict(any, list(row_of(packets, 1), row_of(bvh2, 0.5))), fails_to_hold)
        << "a slower walk is refuted all the same";
}

TEST(Rivals, a_rival_that_was_skipped_could_be_the_fastest)
{
    auto rows = list(row_of(half32, 1), row_of(bvh2, 2), row_of(cwbvh, 3));
    rows[2].samples_s.clear();
    rows[2].outcome = Skipped{Status::skipped, "no time"};
    EXPECT_EQ(rival_verdict(rival_claim(), rows), untested);
    EXPECT_NE(evidence_of(rival_claim(), rows).find("no time"), std::string::npos);
    rows[2].outcome = Skipped{Status::unsupported, "no AVX2"};
    EXPECT_EQ(rival_verdict(rival_claim(), rows), holds) << "a device without the rival does not have a faster one";
}

TEST(Rivals, a_noisy_row_decides_nothing)
{
    auto rows = list(row_of(half32, 1), row_of(bvh2, 2));
    rows[1].disturbance = "others";
    EXPECT_EQ(rival_verdict(rival_claim(), rows), untested);
    EXPECT_NE(evidence_of(rival_claim(), rows).find("noisy"), std::string::npos);
    EXPECT_EQ(rival_verdict(rival_claim(Walk::half32, Rival::our_single, 3), rows), untested);
}

TEST(Rivals, a_missing_walk_is_named_with_its_reason)
{
    auto rows = list(row_of(half32, 1), row_of(bvh2, 2));
    rows[0].samples_s.clear();
    rows[0].outcome = Failed{ErrorKind::unsupported, "TetGen gave up"};
    EXPECT_EQ(rival_verdict(rival_claim(), rows), untested);
    EXPECT_NE(evidence_of(rival_claim(), rows).find("TetGen gave up"), std::string::npos);
    EXPECT_NE(evidence_of(rival_claim(), list(row_of(bvh2, 2))).find("no such row"), std::string::npos);
}

TEST(Rivals, scenes_that_were_not_traced_are_named_and_the_others_decide)
{
    RivalClaim claim = rival_claim();
    claim.scenes = {"bunny", "armadillo"};
    EXPECT_EQ(rival_verdict(claim, list(row_of(half32, 1), row_of(bvh2, 2))), holds);
    EXPECT_NE(evidence_of(claim, list(row_of(half32, 1), row_of(bvh2, 2))).find("Not traced in this run: armadillo"),
              std::string::npos);
    EXPECT_EQ(rival_verdict(claim, list(row_of(half32, 1), row_of(bvh2, 2), row_of(half32, 2, "openmp", "armadillo"),
                                        row_of(bvh2, 1, "openmp", "armadillo"))),
              fails_to_hold)
        << "one scene refutes it";
    EXPECT_EQ(rival_verdict(claim, list(row_of(half32, 1, "openmp", "banana"), row_of(bvh2, 2, "openmp", "banana"))),
              untested);
}

TEST(Rivals, a_scene_of_another_size_or_of_a_bundle_is_the_same_scene)
{
    for (const char* const label : {"bunny", "bunny@5000", "bunny-rays"})
        EXPECT_EQ(
            rival_verdict(rival_claim(), list(row_of(half32, 1, "openmp", label), row_of(bvh2, 2, "openmp", label))),
            holds)
            << label;
    EXPECT_FALSE(is_scene("bunny-2", "bunny"));
    EXPECT_FALSE(is_scene("bunnies", "bunny"));
}

TEST(Rivals, emulated_devices_are_compared_only_with_their_own_rows)
{
    RivalClaim claim = rival_claim(Walk::tet64, Rival::any);
    claim.place = DeviceKind::emulated;
    claim.backend = "vulkan";
    const auto rows = list(row_of(tet64, 2, "vulkan"), row_of(bvh2, 3, "vulkan"), row_of(bvh2, 1, "opencl"),
                           row_of(tet64, 2, "opencl"), row_of(bvh2, 1));
    EXPECT_EQ(rival_verdict(claim, rows), holds);
    claim.backend = "opencl";
    EXPECT_EQ(rival_verdict(claim, rows), fails_to_hold);
    claim.backend = "cuda-host";
    EXPECT_EQ(rival_verdict(claim, rows), untested);
}

TEST(Rivals, other_rays_are_another_contest)
{
    auto rows = list(row_of(half32, 1), row_of(bvh2, 2), row_of(bvh2, 0.5));
    rows[2].key.rays = RayKind::random;
    EXPECT_EQ(rival_contests(rows, {}).size(), 2u);
    EXPECT_EQ(rival_verdict(rival_claim(), rows), holds);
    RivalClaim random = rival_claim();
    random.rays = {RayKind::random};
    EXPECT_EQ(rival_verdict(random, rows), untested);
}

TEST(Rivals, a_claim_of_losing_holds_below_its_boundary)
{
    RivalClaim claim = rival_claim();
    claim.is_below = true;
    EXPECT_EQ(rival_verdict(claim, list(row_of(half32, 2), row_of(bvh2, 1))), holds);
    EXPECT_EQ(rival_verdict(claim, list(row_of(half32, 1), row_of(bvh2, 2))), fails_to_hold);
    EXPECT_EQ(rival_verdict(claim, list(row_of(half32, 1), row_of(bvh2, 1))), untested);
}

TEST(Rivals, a_claim_is_not_refuted_if_a_missing_row_could_speak_for_it)
{
    RivalClaim losing = rival_claim(Walk::packets, Rival::any);
    losing.is_below = true;
    EXPECT_EQ(rival_verdict(losing, list(row_of(packets, 1), row_of(bvh2, 9))), untested) << "Embree could be faster";
    EXPECT_EQ(rival_verdict(losing, list(row_of(packets, 1), row_of(bvh2, 9), embree(Method::single, 5))),
              fails_to_hold);
    const RivalClaim winning = rival_claim(Walk::single);
    auto rows = list(row_of(half32, 2), row_of(tet64, 3), row_of(bvh2, 1));
    EXPECT_EQ(rival_verdict(winning, rows), fails_to_hold);
    rows[1].samples_s.clear();
    rows[1].outcome = Skipped{Status::skipped, "no time"};
    EXPECT_EQ(rival_verdict(winning, rows), untested) << "tet64 could be faster";
    EXPECT_NE(evidence_of(winning, rows).find("no time"), std::string::npos);
}

TEST(Rivals, tets_have_paid_once_faster_rays_have_made_up_for_the_build)
{
    RivalClaim claim = rival_claim();
    claim.measure = Measure::break_even;
    claim.is_below = true;
    const auto rows = list(row_of(half32, 1), row_of(bvh2, 2));
    EXPECT_EQ(rival_verdict(claim, rows), untested) << "without sessions no build time is known";
    EXPECT_NE(evidence_of(claim, rows).find("a build time is not known"), std::string::npos);
    EXPECT_NEAR(seconds_until_paid(4.4, 1.29), 4.4 / 0.29, 1e-9);
    EXPECT_EQ(seconds_until_paid(4.4, 1), std::numeric_limits<double>::infinity());
    EXPECT_EQ(seconds_until_paid(-1, 2), 0) << "a faster build, and faster rays";
    EXPECT_EQ(number_text(claim, {15.172, 14, 16.5}), "15.17 [14.00, 16.50] s");
    EXPECT_EQ(number_text(claim, {std::numeric_limits<double>::infinity(), 3, {}}), "never");
}

TEST(Rivals, rows_that_a_user_left_out_could_be_faster)
{
    const auto rows = list(row_of(half32, 1), row_of(bvh2, 2));
    EXPECT_EQ(judged(rival_claim(), rows, {.kernels = true}).verdict, untested);
    EXPECT_EQ(judged(rival_claim(Walk::half32, Rival::our_single, 3), rows, {.kernels = true}).verdict, fails_to_hold);
    EXPECT_EQ(judged(rival_claim(), rows, {.apis = true}).verdict, holds) << "a processor's rows have one API";
}

TEST(Rivals, rows_that_a_filter_left_out_make_only_claims_about_them_not_testable)
{
    const std::vector<RowRecord> rows = {row_of(half32, 1), row_of(bvh2, 2)};
    const auto without = [&](const KernelId& kernel, const std::string& scene = "bunny") {
        return judged(rival_claim(), rows, {false, false, {row_of(kernel, 1, "openmp", scene).key}});
    };
    const JudgedClaim left_out = without(cwbvh);
    EXPECT_EQ(left_out.verdict, untested);
    EXPECT_NE(to_claim(left_out).evidence.find("--filter left out 1 row that it is about, such as bvh cwbvh on openmp "
                                               "for bunny"),
              std::string::npos);
    EXPECT_EQ(without(tet64).verdict, holds) << "it is of neither kind";
    EXPECT_EQ(without(cwbvh, "banana").verdict, holds);
    EXPECT_EQ(judged(rival_claim(), {}, {false, false, {rows[0].key}}).verdict, untested);
    const std::vector<RowRecord> slow = {row_of(half32, 2), row_of(bvh2, 1)};
    EXPECT_EQ(judged(rival_claim(), slow, {false, false, {row_of(cwbvh, 1).key}}).verdict, fails_to_hold)
        << "a faster rival would not help it";
}

TEST(Rivals, a_gpus_rows_of_an_api_that_was_left_out_could_be_faster)
{
    RivalClaim claim = rival_claim(Walk::half32, Rival::any);
    claim.place = DeviceKind::gpu;
    auto rows = list(row_of(half32, 1, "cuda"), row_of(bvh2, 2, "cuda"));
    for (RowRecord& row : rows) {
        row.device.kind = DeviceKind::gpu;
        row.device.pci = "0000:01:00.0";
    }
    EXPECT_EQ(judged(claim, rows).verdict, holds);
    EXPECT_EQ(judged(claim, rows, {.apis = true}).verdict, untested);
    claim.boundary = 3;
    EXPECT_EQ(judged(claim, rows).verdict, fails_to_hold);
    EXPECT_EQ(judged(claim, rows, {.apis = true}).verdict, untested);
}

TEST(Rivals, options_that_leave_out_an_api_of_a_gpu_are_seen)
{
    Device gpu, other;
    gpu.kind = other.kind = DeviceKind::gpu;
    gpu.usable = other.usable = true;
    gpu.pci = "0000:01:00.0";
    other.pci = "0000:02:00.0";
    FakeBackend cuda("cuda", gpu), vulkan("vulkan", gpu), opencl("opencl", other);
    const std::vector<Backend*> backends{&cuda, &vulkan, &opencl};
    Options options;
    EXPECT_FALSE(left_out(options, backends).apis);
    options.backends = {"cuda"};
    EXPECT_TRUE(left_out(options, backends).apis);
    options.backends = {"cuda", "vulkan"};
    EXPECT_FALSE(left_out(options, backends).apis) << "the other GPU is without rows";
    EXPECT_FALSE(left_out(options, backends).kernels);
    options.math = {MathMode::exact};
    EXPECT_FALSE(left_out(options, backends).kernels);
    options.schedules = {Schedule::tiles};
    EXPECT_TRUE(left_out(options, backends).kernels) << "packets";
}

TEST(Rivals, the_old_figure_is_next_to_the_new_one)
{
    const std::string evidence = evidence_of(rival_claim(), list(row_of(half32, 1), row_of(bvh2, 2)));
    EXPECT_NE(evidence.find("Then 1.50 bunny (a machine)."), std::string::npos) << evidence;
    EXPECT_NE(evidence.find("Now 2.00 [1.9"), std::string::npos) << evidence;
    EXPECT_NE(evidence.find("is above 1 "), std::string::npos) << "the rule: " << evidence;
    const auto rows = list(row_of(half32, 1), row_of(bvh2, 2));
    const PaperTable table = claims_table(rival_contests(rows, {}), {}, {rival_claim()});
    EXPECT_EQ(table.notes, std::vector<std::string>{"a machine: some views on a machine."});
    EXPECT_EQ(std::get<Quantity>(table.rows.at(0).at(1)).ours.value, 1) << "one holds";
}

TEST(Rivals, every_claim_has_its_own_name_and_a_scene_of_the_run_or_of_the_paper)
{
    std::vector<std::string_view> ids;
    for (const RivalClaim& claim : rival_claims()) {
        EXPECT_EQ(std::count(ids.begin(), ids.end(), claim.id), 0) << claim.id;
        ids.push_back(claim.id);
        EXPECT_GT(claim.boundary, 0);
        EXPECT_FALSE(claim.rays.empty());
        for (const std::string_view name : claim.scenes)
            EXPECT_TRUE(name == "banana" ||
                        std::ranges::find(rival_scenes(), name, &RivalScene::name) != rival_scenes().end())
                << name;
    }
}

TEST(Rivals, every_row_has_its_ratio_to_the_fastest_bvh)
{
    const auto rows = list(row_of(packets, 1), row_of(bvh2, 4), embree(Method::packet16, 2));
    const auto tables = rival_tables(rows, {}, {});
    ASSERT_EQ(tables.size(), 3u);
    const auto& table = tables.at(2);
    ASSERT_EQ(table.rows.size(), 3u);
    const std::size_t column = 6;
    ASSERT_EQ(table.columns.at(column).key, "over_bvh");
    EXPECT_NEAR(std::get<Quantity>(table.rows.at(0).at(column)).ours.value, 2, 1e-9);
    EXPECT_NEAR(std::get<Quantity>(table.rows.at(1).at(column)).ours.value, 0.5, 1e-9);
    EXPECT_NEAR(std::get<Quantity>(table.rows.at(2).at(column)).ours.value, 1, 1e-9);
}
