#include "bench/debugging/ray_steps.h"

#include "bench/debugging/trace_run.h"
#include "bench/measuring/ray_walks.h"
#include "bench/measuring/view_recorder.h"
#include "bench/output/check_matrix.h"
#include "bench/output/row_fields.h"
#include "bench/rows/scene_work.h"
#include "core/device/self_test.h"
#include "core/mesh/tet_mesh.h"
#include "tests/support/row_runs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wrapped_session.h"

#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr ImagePixel pixel{12, 11};

/// Answers as openmp does, but the walk of every ray that is cut off after that many steps is in another tet.
class StrayingSession : public WrappedSession {
public:
    StrayingSession(std::unique_ptr<Session> inner, std::uint32_t step) : WrappedSession(std::move(inner)), step_(step)
    {
    }

private:
    void change(std::span<Hit> hits) override
    {
        for (Hit& hit : hits)
            if (hit.steps == step_ && hit.face_id == LOST) hit.tet = hit.tet == 0 ? 1 : 0;
    }

    std::uint32_t step_;
};

/// Answers right only for images of one ray.
class CrowdedSession : public WrappedSession {
public:
    using WrappedSession::WrappedSession;

private:
    void change(std::span<Hit> hits) override
    {
        if (hits.size() == 1) return;
        for (Hit& hit : hits)
            hit.face_id = NO_HIT;
    }
};

/// Answers as openmp does, but for one pixel.
class SpottedSession : public WrappedSession {
public:
    using WrappedSession::WrappedSession;

private:
    void change(std::span<Hit> hits) override
    {
        if (hits.size() > 1) hits[pixel.y * 24 + pixel.x].face_id ^= 1;
    }
};

/// Answers as openmp does, but for the first of its rays.
class FirstGivenSession : public WrappedSession {
public:
    using WrappedSession::WrappedSession;

private:
    void change(std::span<Hit> hits) override { hits.front().face_id ^= 1; }
};

class RaySteps : public testing::Test {
protected:
    RaySteps()
    {
        options_.width = options_.height = 24;
        options_.views = "0";
        options_.pixel = pixel;
        scene_ = std::make_unique<SceneWork>(loaded_cubes(6), options_);
    }

    [[nodiscard]] RowRun row(Method method = Method::maria, Layout layout = Layout::tet80)
    {
        RowRun opened = open_row({"cubes", "openmp", {Structure::cdt, method, layout}}, *scene_, options_);
        EXPECT_NE(opened.session, nullptr) << reason_of(opened);
        return opened;
    }
    [[nodiscard]] const TetMesh& mesh() const { return scene_->loaded().scene.tets; }

    Options options_;
    std::unique_ptr<SceneWork> scene_;
};

} // namespace

TEST_F(RaySteps, lead_from_neighbour_to_neighbour_to_the_triangle_that_is_hit)
{
    for (const auto& [method, layout] :
         {std::pair(Method::maria, Layout::tet80), std::pair(Method::maria, Layout::tet96),
          std::pair(Method::project, Layout::half32), std::pair(Method::project, Layout::tet64),
          std::pair(Method::project, Layout::tet20), std::pair(Method::plucker, Layout::tet80)}) {
        RowRun traced = row(method, layout);
        const RayOnDevice ray = follow_ray(traced, 0, pixel);
        ASSERT_LT(ray.hit.face_id, scene_->loaded().scene.mesh.triangles.size()) << "the pixel hits";
        ASSERT_EQ(ray.steps.size(), ray.hit.steps);
        EXPECT_EQ(ray.hit, ray.alone);
        EXPECT_FALSE(ray.is_cut);
        for (std::size_t i = 0; i < ray.steps.size(); ++i) {
            const RayStep& step = ray.steps[i];
            ASSERT_TRUE(step.tet && step.face) << "step " << i;
            const Tet& tet = mesh().tets[*step.tet];
            const bool is_last = i + 1 == ray.steps.size();
            EXPECT_TRUE(is_last ? tet.faces[*step.face] == ray.hit.face_id
                                : half_face_tet(tet.neighbours[*step.face]) == ray.steps[i + 1].tet);
            const auto is_positive = [](float product) { return product > 0; };
            const auto positive = std::ranges::count_if(step.products, is_positive);
            EXPECT_TRUE(positive == 0 || positive == 3) << "the ray crosses the face by which it leaves";
        }
        EXPECT_EQ(ray.hit.tet, *ray.steps.back().tet) << "numbered as the scene's";
    }
}

TEST_F(RaySteps, are_the_same_in_all_layouts_of_a_method)
{
    RowRun a = row(Method::project, Layout::tet80), b = row(Method::project, Layout::half32);
    const RayOnDevice first = follow_ray(a, 0, pixel), second = follow_ray(b, 0, pixel);
    EXPECT_EQ(first.steps, second.steps);
    EXPECT_EQ(first_difference(first, second), std::nullopt);
}

TEST_F(RaySteps, show_where_a_device_first_strays)
{
    TraceRun run;
    run.rows.push_back(row());
    run.rows.push_back(row());
    run.rays.push_back(follow_ray(run.rows[0], 0, pixel));
    ASSERT_GT(run.rays[0].steps.size(), 4u);
    run.rows[1].session = std::make_unique<StrayingSession>(std::move(run.rows[1].session), 3);
    run.rows[1].key.backend = "other";
    run.rays.push_back(follow_ray(run.rows[1], 0, pixel));
    EXPECT_EQ(first_difference(run.rays[1], run.rays[0]), 1u) << "the second step leads elsewhere";
    EXPECT_TRUE(differs(run.rays[1], run.rays[0]));
    EXPECT_FALSE(differs(run.rays[0], run.rays[0]));
    run.scene = std::move(scene_);
    run.ray = ray_of(run.scene->views().front(), pixel);
    const Report report = trace_report(run, options_);
    const std::string text = report.sheet.text();
    EXPECT_TRUE(contains(text, "other: differs first at step 2: other is in tet ")) << text;
    EXPECT_TRUE(contains(text, "<- first difference")) << text;
    const auto& devices = report.json["tetrace"]["trace"]["devices"];
    EXPECT_EQ(devices[1]["first_difference"], 2);
    EXPECT_TRUE(devices[1]["differs"].get<bool>());
    EXPECT_FALSE(devices[0].contains("first_difference"));
}

TEST_F(RaySteps, end_where_a_device_names_a_tet_that_there_is_not)
{
    class Mad : public WrappedSession {
    public:
        using WrappedSession::WrappedSession;
        void change(std::span<Hit> hits) override
        {
            for (Hit& hit : hits)
                hit.tet = 123456789;
        }
    };
    RowRun mad = row();
    mad.session = std::make_unique<Mad>(std::move(mad.session));
    const RayOnDevice ray = follow_ray(mad, 0, pixel);
    ASSERT_FALSE(ray.steps.empty());
    for (const RayStep& step : ray.steps) {
        EXPECT_FALSE(step.tet || step.face);
        EXPECT_EQ(step.beyond, "123456789 is not a tet of the scene");
    }
}

TEST_F(RaySteps, of_a_ray_that_misses_lead_outside)
{
    RowRun traced = row();
    const RayOnDevice ray = follow_ray(traced, 0, {0, 0});
    EXPECT_EQ(ray.hit.face_id, NO_HIT);
    EXPECT_TRUE(ray.steps.empty() || ray.steps.back().beyond == "outside");
}

TEST_F(RaySteps, are_a_command_that_check_prints_for_its_first_differing_ray)
{
    options_.resolution = 6;
    SceneRequest request;
    request.name = "cubes";
    scene_ = std::make_unique<SceneWork>(loaded_cubes(6), options_, scene_arguments(request, options_));
    RowRun spotted = row();
    spotted.key.backend = "cuda-host";
    spotted.session = std::make_unique<SpottedSession>(std::move(spotted.session));
    verify_rows({&spotted}, *scene_, options_);
    note_walks(spotted);
    const std::string command = "tetrace trace --scene cubes --resolution 6 --size 24x24 --view 0 --pixel 12,11 "
                                "--method maria --layout tet80 --backend cuda-host";
    EXPECT_TRUE(contains(differences_text(spotted), "\n  Step by step: " + command + "\n"))
        << differences_text(spotted);
    EXPECT_EQ(row_json(RowFacts(spotted))["verification"]["first_different"]["command"], command);

    std::istringstream words(command.substr(8));
    const Options again = parse_options({std::istream_iterator<std::string>(words), {}});
    EXPECT_EQ(again.verb, Verb::trace);
    EXPECT_EQ(again.pixel, pixel);
    EXPECT_EQ(selected_views(again), std::vector<std::uint32_t>{0});
    EXPECT_EQ(scene_arguments(request, again), scene_arguments(request, options_)) << "the same scene and images";
}

TEST_F(RaySteps, of_given_rays_and_bvhs_are_commands_too)
{
    options_.resolution = 6;
    SceneRequest request;
    request.name = "cubes";
    scene_ = std::make_unique<SceneWork>(loaded_cubes(6), options_, scene_arguments(request, options_));
    for (const Layout layout : {Layout::half32, Layout::bvh2}) {
        RowKey key{"cubes", "openmp", {}, RayKind::diffuse};
        key.ray_order = RayOrder::morton;
        for (const KernelId& kernel : kernels_of(Task::rays))
            if (kernel.layout == layout && is_default(kernel) && kernel.schedule == Schedule::tiles &&
                kernel.math == MathMode::exact)
                key.kernel = kernel;
        RowRun given = open_row(key, *scene_, options_);
        given.key.backend = "cuda-host";
        given.session = std::make_unique<FirstGivenSession>(std::move(given.session));
        verify_rows({&given}, *scene_, options_);
        note_walks(given);
        const auto& ray = traced(given)->first_different;
        ASSERT_TRUE(ray) << reason_of(given);
        const std::string command =
            fmt::format("tetrace trace --scene cubes --resolution 6 --size 24x24 --view 0 --pixel {},{} --method {} "
                        "--layout {} --rays diffuse --ray-order morton --backend cuda-host",
                        ray->x, ray->y, name_of(key.kernel.method), name_of(layout));
        EXPECT_TRUE(contains(differences_text(given), "\n  Step by step: " + command + "\n"))
            << differences_text(given);
        std::istringstream words(command.substr(8));
        const Options again = parse_options({std::istream_iterator<std::string>(words), {}});
        RowRun followed = open_row(key, *scene_, options_);
        EXPECT_EQ(follow_ray(followed, 0, *again.pixel).hit.face_id, ray->openmp.face_id) << "the same ray";
    }
}

TEST_F(RaySteps, of_a_run_without_openmp_are_compared_with_nothing)
{
    TraceRun run;
    run.rows.push_back(row());
    run.rows.push_back(row());
    run.rows[1].key.backend = "other";
    run.rows[0].outcome = Failed{ErrorKind::driver, "it is not well"};
    run.rays.push_back(follow_ray(run.rows[1], 0, pixel));
    EXPECT_EQ(run.reference(), nullptr);
    run.scene = std::move(scene_);
    run.ray = ray_of(run.scene->views().front(), pixel);
    const Report report = trace_report(run, options_);
    const std::string text = report.sheet.text();
    EXPECT_TRUE(contains(text, "openmp: error: it is not well")) << text;
    EXPECT_TRUE(contains(text, "openmp has no hit to compare the devices with.")) << text;
    EXPECT_FALSE(contains(text, "the steps are openmp's")) << text;
    EXPECT_FALSE(report.json["tetrace"]["trace"]["devices"][1].contains("differs"));
}

TEST_F(RaySteps, of_other_scenes_and_devices_are_asked_for_in_full)
{
    options_.tets = {TetsKind::cdt};
    options_.switches = {"pq5Y"};
    options_.own_cameras = OwnCameras{"mine", {}, "my cameras.json"};
    options_.buffer_limit = 4096;
    SceneRequest request;
    request.name = "it's.ply";
    EXPECT_EQ(scene_arguments(request, options_),
              "--scene 'it'\\''s.ply' --tets cdt --switches pq5Y --camera-set 'my cameras.json' --size 24x24 "
              "--buffer-limit 4096");
}

TEST(DeviceProducts, are_what_float_arithmetic_gives_and_follow_a_device_that_computes_otherwise)
{
    const Float3 origin{0.1f, -0.2f, 3.0f}, direction{0.3f, 0.1f, -1.0f};
    const std::vector<PassedEdge> edges = {{{0.5f, 0.25f, 0.125f}, {-0.5f, 0.75f, 0.3f}}, {{1, 2, 4}, {3, 1, 2}}};
    const auto openmp = [](std::span<const Quad> operations) {
        return reference_backend().probe(0, MathMode::exact, operations);
    };
    const auto products = side_products(origin, direction, edges, openmp);
    ASSERT_EQ(products.size(), 2u);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& [a, b] = edges[i];
        const double ax = double{a.x} - origin.x, ay = double{a.y} - origin.y, az = double{a.z} - origin.z;
        const double bx = double{b.x} - origin.x, by = double{b.y} - origin.y, bz = double{b.z} - origin.z;
        const double side =
            direction.x * (ay * bz - az * by) + direction.y * (az * bx - ax * bz) + direction.z * (ax * by - ay * bx);
        EXPECT_NEAR(products[i], side, 1e-5);
    }
    const auto halves = [&](std::span<const Quad> operations) {
        auto words = openmp(operations);
        for (std::size_t i = 0; i < words.size(); ++i)
            if (operations[i].x == PROBE_MULTIPLY) words[i] -= 0x00800000u; // half of every product
        return words;
    };
    EXPECT_FLOAT_EQ(side_products(origin, direction, edges, halves)[1], products[1] / 4);
    EXPECT_TRUE(side_products(origin, direction, {}, openmp).empty());
}

TEST_F(RaySteps, that_need_the_rays_neighbours_are_distinguished_from_those_that_do_not)
{
    RowRun crowded = row();
    crowded.session = std::make_unique<CrowdedSession>(std::move(crowded.session));
    const RayOnDevice ray = follow_ray(crowded, 0, pixel);
    EXPECT_EQ(ray.hit.face_id, NO_HIT);
    EXPECT_NE(ray.alone.face_id, NO_HIT);
}
