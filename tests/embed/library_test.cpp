// The C functions: hits are those of every triangle tried one by one, in the coordinates of the mesh.
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "tests/support/temporary_folder.h"
#include "tetrace/tetrace.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <thread>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr float no_end = std::numeric_limits<float>::infinity();

struct Free {
    void operator()(tetrace_scene* scene) const { tetrace_scene_free(scene); }
    void operator()(tetrace_tracer* tracer) const { tetrace_close(tracer); }
};
using ScenePointer = std::unique_ptr<tetrace_scene, Free>;
using TracerPointer = std::unique_ptr<tetrace_tracer, Free>;

ScenePointer loaded(const std::string& name)
{
    tetrace_scene* scene = nullptr;
    EXPECT_EQ(tetrace_scene_load(name.c_str(), &scene), TETRACE_OK) << tetrace_last_error();
    return ScenePointer(scene);
}

TracerPointer opened(const ScenePointer& scene, const char* layout, const char* backend = "openmp",
                     std::uint32_t device = 0)
{
    tetrace_tracer* tracer = nullptr;
    EXPECT_EQ(tetrace_open(scene.get(), backend, device, layout, &tracer), TETRACE_OK) << tetrace_last_error();
    return TracerPointer(tracer);
}

std::vector<tetrace_hit> traced(const TracerPointer& tracer, const std::vector<tetrace_ray>& rays,
                                std::uint32_t flags = 0)
{
    std::vector<tetrace_hit> hits(rays.size());
    EXPECT_EQ(tetrace_trace(tracer.get(), rays.data(), rays.size(), flags, hits.data()), TETRACE_OK)
        << tetrace_last_error();
    return hits;
}

/// A scene file whose mesh was moved and scaled, as the builder does: mesh units are 4 domain units large.
class Library : public testing::Test {
protected:
    Library()
    {
        scene_.build.centre = {3, -2, 5};
        scene_.build.scale_exponent = -2;
        write_scene(file_, scene_);
    }

    [[nodiscard]] Double3 in_mesh(Float3 point) const { return to_double(point) * 4 + scene_.build.centre; }

    /// Rays from inside the box, from around it and from far away, most of them with a range.
    [[nodiscard]] std::vector<tetrace_ray> some_rays() const
    {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> number(-1, 1);
        std::vector<tetrace_ray> rays;
        const auto [low, high] = bounding_box(scene_.mesh);
        const Double3 centre = in_mesh(to_float((low + high) * 0.5));
        for (int i = 0; i < 3000; ++i) {
            const Double3 to = centre + Double3{number(random), number(random), number(random)} * 4;
            const double reach = i % 3 == 0 ? 3 : i % 3 == 1 ? 20 : 4000;
            const Double3 from = centre + Double3{number(random), number(random), number(random)} * reach;
            const double stretch = i % 3 == 2 ? 1 : std::exp2(3 * number(random));
            const Float3 origin = to_float(from), direction = to_float((to - from) * stretch);
            const float begin = i % 4 == 0 ? 0.25F : 0;
            rays.push_back({{origin.x, origin.y, origin.z},
                            begin,
                            {direction.x, direction.y, direction.z},
                            i % 5 == 0 ? 0.75F : no_end});
        }
        return rays;
    }

    struct Crossing {
        double t, u, v;
    };
    /// Where the ray's line meets the triangle's plane.
    [[nodiscard]] Crossing crossing(const tetrace_ray& ray, std::size_t triangle) const
    {
        const auto& [a, b, c] = scene_.mesh.triangles[triangle];
        const Double3 corner = in_mesh(scene_.mesh.vertices[a]);
        const Double3 edge_1 = in_mesh(scene_.mesh.vertices[b]) - corner,
                      edge_2 = in_mesh(scene_.mesh.vertices[c]) - corner;
        const Double3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
        const Double3 offset = Double3{ray.origin[0], ray.origin[1], ray.origin[2]} - corner;
        const Double3 p = cross(direction, edge_2), q = cross(offset, edge_1);
        const double determinant = dot(edge_1, p);
        return {dot(edge_2, q) / determinant, dot(offset, p) / determinant, dot(direction, q) / determinant};
    }

    /// What is wrong with a hit; empty if nothing is. Distances are in mesh units: what is nearer to a triangle's edge
    /// or to an end of the range than rounding may be either way.
    [[nodiscard]] std::string fault_of(const tetrace_ray& ray, const tetrace_hit& hit, bool any_hit = false) const
    {
        const double unit = length(Double3{ray.direction[0], ray.direction[1], ray.direction[2]});
        const double far = length(Double3{ray.origin[0], ray.origin[1], ray.origin[2]});
        const double slack = 1e-4 + 1e-6 * far; // a far origin is rounded by more
        const double margin = slack;            // edges are about one unit long
        const bool is_hit = hit.triangle != TETRACE_NO_HIT;
        if (is_hit) {
            if (hit.triangle >= scene_.mesh.triangles.size()) return "names no triangle";
            if (!(hit.t >= ray.t_min && hit.t <= ray.t_max)) return "is out of its range";
            const Crossing at = crossing(ray, hit.triangle);
            if (!(std::abs(at.t - hit.t) * unit < 20 * slack)) return "has another t";
            if (!(std::abs(at.u - hit.u) < 20 * margin && std::abs(at.v - hit.v) < 20 * margin))
                return "has another u or v";
            if (at.u < -margin || at.v < -margin || at.u + at.v > 1 + margin) return "is not in its triangle";
        }
        if (is_hit && any_hit) return "";
        const double end = is_hit ? hit.t : ray.t_max;
        for (std::size_t i = 0; i < scene_.mesh.triangles.size(); ++i) {
            const Crossing at = crossing(ray, i);
            const bool is_inside = at.u > margin && at.v > margin && at.u + at.v < 1 - margin;
            if (is_inside && (at.t - ray.t_min) * unit > 20 * slack && (end - at.t) * unit > 20 * slack)
                return "passes triangle " + std::to_string(i);
        }
        return "";
    }

    void expect_right(const std::vector<tetrace_ray>& rays, const std::vector<tetrace_hit>& hits, bool any_hit = false)
    {
        ASSERT_EQ(rays.size(), hits.size());
        for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(fault_of(rays[i], hits[i], any_hit), "") << "ray " << i;
        const auto met =
            std::ranges::count_if(hits, [](const tetrace_hit& hit) { return hit.triangle != TETRACE_NO_HIT; });
        EXPECT_GT(met, static_cast<long>(rays.size() / 8));
        EXPECT_LT(met, static_cast<long>(rays.size() - rays.size() / 8));
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "moved.tet";
    Scene scene_ = make_cubes(6);
};

} // namespace

TEST_F(Library, finds_the_nearest_triangle_in_its_range_through_every_layout)
{
    const ScenePointer scene = loaded(file_.string());
    const std::vector<tetrace_ray> rays = some_rays();
    for (const char* const layout : {"half32", "tet64", "tet80", "tet96", "bvh2", "bvh4", "cwbvh"}) {
        SCOPED_TRACE(layout);
        const TracerPointer tracer = opened(scene, layout);
        expect_right(rays, traced(tracer, rays));
        expect_right(rays, traced(tracer, rays, TETRACE_ANY_HIT), true);
    }
}

TEST_F(Library, finds_the_nearest_triangle_through_a_drivers_own_bvh)
{
    const ScenePointer scene = loaded(file_.string());
    tetrace_tracer* made = nullptr;
    EXPECT_EQ(tetrace_open(scene.get(), "openmp", 0, "rt", &made), TETRACE_UNSUPPORTED) << tetrace_last_error();
    if (tetrace_open(scene.get(), "vulkan", 0, "rt", &made) != TETRACE_OK) GTEST_SKIP() << tetrace_last_error();
    const TracerPointer tracer(made);
    const std::vector<tetrace_ray> rays = some_rays();
    expect_right(rays, traced(tracer, rays));
    expect_right(rays, traced(tracer, rays, TETRACE_ANY_HIT), true);
}

TEST_F(Library, test_finds_answers_that_are_wrong)
{
    const std::vector<tetrace_ray> rays = some_rays();
    const std::vector<tetrace_hit> hits = traced(opened(loaded(file_.string()), "half32"), rays);
    std::size_t met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].triangle == TETRACE_NO_HIT) continue;
        ++met;
        tetrace_hit wrong = hits[i];
        wrong.triangle = (wrong.triangle + 7) % static_cast<std::uint32_t>(scene_.mesh.triangles.size());
        EXPECT_NE(fault_of(rays[i], wrong), "");
    }
    EXPECT_GT(met, 100u);
}

TEST_F(Library, rays_go_on_from_a_hit_where_t_min_says)
{
    const std::vector<tetrace_ray> rays = some_rays();
    for (const char* const layout : {"half32", "bvh2"}) {
        const TracerPointer tracer = opened(loaded(file_.string()), layout);
        const std::vector<tetrace_hit> hits = traced(tracer, rays);
        std::vector<tetrace_ray> onward;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (hits[i].triangle == TETRACE_NO_HIT || i % 3 == 2) continue; // from far away t is coarse
            onward.push_back(rays[i]);
            onward.back().t_min = hits[i].t * 1.01F;
            onward.back().t_max = no_end;
        }
        const std::vector<tetrace_hit> next = traced(tracer, onward);
        for (std::size_t i = 0; i < onward.size(); ++i)
            ASSERT_EQ(fault_of(onward[i], next[i]), "") << "ray " << i;
    }
}

TEST_F(Library, every_device_finds_the_same_bits)
{
    const tetrace_device* devices = nullptr;
    std::size_t count = 0;
    ASSERT_EQ(tetrace_devices(&devices, &count), TETRACE_OK) << tetrace_last_error();
    const ScenePointer scene = loaded(file_.string());
    const std::vector<tetrace_ray> rays = some_rays();
    const std::vector<tetrace_hit> expected = traced(opened(scene, "half32"), rays);
    std::size_t others = 0;
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(devices[i].usable == 0, std::strlen(devices[i].reason) > 0) << devices[i].backend;
        if (devices[i].usable == 0 || std::string(devices[i].backend) == "openmp") continue;
        SCOPED_TRACE(std::string(devices[i].backend) + ": " + devices[i].name);
        const auto hits = traced(opened(scene, "half32", devices[i].backend, devices[i].index), rays);
        EXPECT_EQ(std::memcmp(hits.data(), expected.data(), sizeof(tetrace_hit) * hits.size()), 0);
        ++others;
    }
    EXPECT_GT(others, 0u) << "cuda_host runs everywhere";
}

TEST_F(Library, may_be_called_from_several_threads)
{
    const ScenePointer scene = loaded(file_.string());
    const TracerPointer tracer = opened(scene, "half32");
    const std::vector<tetrace_ray> rays = some_rays();
    const std::vector<tetrace_hit> expected = traced(tracer, rays);
    const std::string before = tetrace_last_error(); // of an earlier test
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&, i] {
            const TracerPointer own = i % 2 == 0 ? opened(scene, "bvh2") : nullptr;
            for (int k = 0; k < 3; ++k) {
                const auto hits = traced(own ? own : tracer, rays);
                if (own) continue;
                EXPECT_EQ(std::memcmp(hits.data(), expected.data(), sizeof(tetrace_hit) * hits.size()), 0);
            }
            EXPECT_EQ(tetrace_scene_load("no such scene", nullptr), TETRACE_USAGE);
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(tetrace_last_error(), before) << "another thread's";
}

TEST_F(Library, says_what_is_wrong_and_writes_no_hit)
{
    tetrace_scene* no_scene = nullptr;
    EXPECT_EQ(tetrace_scene_load("cubs", &no_scene), TETRACE_USAGE);
    EXPECT_TRUE(contains(tetrace_last_error(), "scene cubs: neither a name of the catalogue (cubes"));
    EXPECT_EQ(tetrace_scene_load((folder_ / "none.tet").c_str(), &no_scene), TETRACE_MISSING);
    write_file(folder_ / "damaged.tet", "tet?");
    EXPECT_EQ(tetrace_scene_load((folder_ / "damaged.tet").c_str(), &no_scene), TETRACE_INVALID_INPUT);
    EXPECT_EQ(no_scene, nullptr);

    const ScenePointer scene = loaded(file_.string());
    tetrace_tracer* no_tracer = nullptr;
    EXPECT_EQ(tetrace_open(scene.get(), "metal", 0, nullptr, &no_tracer), TETRACE_USAGE);
    EXPECT_TRUE(contains(tetrace_last_error(), "backend 'metal' is not one of openmp, opencl"));
    EXPECT_EQ(tetrace_open(scene.get(), "openmp", 1, nullptr, &no_tracer), TETRACE_USAGE);
    EXPECT_TRUE(contains(tetrace_last_error(), "openmp has 1 devices"));
    EXPECT_EQ(tetrace_open(scene.get(), "openmp", 0, "tet20", &no_tracer), TETRACE_USAGE);
    EXPECT_TRUE(contains(tetrace_last_error(), "layout 'tet20' is not one of tet80, tet96, half32, tet64, bvh2"));
    EXPECT_EQ(no_tracer, nullptr);

    const TracerPointer tracer = opened(scene, nullptr);
    const auto refused = [&](const tetrace_ray& ray, std::uint32_t flags = 0) {
        const std::vector<tetrace_ray> rays = {{{0, 0, 0}, 0, {1, 0, 0}, 1}, ray};
        std::vector<tetrace_hit> hits(2, tetrace_hit{7, 7, 7, 7});
        EXPECT_EQ(tetrace_trace(tracer.get(), rays.data(), 2, flags, hits.data()), TETRACE_USAGE);
        EXPECT_EQ(hits[0].triangle, 7u);
        return std::string(tetrace_last_error());
    };
    EXPECT_EQ(refused({{0, NAN, 0}, 0, {1, 0, 0}, 1}), "tracing: ray 1: its origin is not finite");
    EXPECT_EQ(refused({{0, 0, 0}, 0, {1, no_end, 0}, 1}), "tracing: ray 1: its direction is not finite");
    EXPECT_EQ(refused({{0, 0, 0}, 0, {0, 0, 0}, 1}), "tracing: ray 1: its direction is 0");
    EXPECT_EQ(refused({{0, 0, 0}, -1, {1, 0, 0}, 1}), "tracing: ray 1: its t_min is not a number from 0 up");
    EXPECT_EQ(refused({{0, 0, 0}, 0, {1, 0, 0}, NAN}), "tracing: ray 1: its t_max is not a number");
    EXPECT_TRUE(contains(refused({{0, 0, 0}, 0, {1, 0, 0}, 1}, 2), "flags are 0 or TETRACE_ANY_HIT"));
    EXPECT_EQ(tetrace_trace(tracer.get(), nullptr, 1, 0, nullptr), TETRACE_USAGE);
    EXPECT_EQ(tetrace_trace(tracer.get(), nullptr, 0, 0, nullptr), TETRACE_OK) << "without rays nothing is written";
}

TEST_F(Library, tells_bounds_in_the_mesh_s_coordinates)
{
    tetrace_scene_info info{};
    ASSERT_EQ(tetrace_scene_get_info(loaded(file_.string()).get(), &info), TETRACE_OK);
    EXPECT_EQ(info.triangles, scene_.mesh.triangles.size());
    EXPECT_EQ(info.tets, scene_.tets.tets.size());
    const auto [low, high] = bounding_box(scene_.mesh);
    EXPECT_EQ(info.low[0], low.x * 4 + 3);
    EXPECT_EQ(info.high[2], high.z * 4 + 5);
}

TEST_F(Library, names_triangles_as_a_mesh_file_does)
{
    const std::string builder = TETRACE_BUILDER_PROGRAM;
    if (builder.empty()) GTEST_SKIP() << "tetrace-builder is not built";
    const ScopedVariable use("TETRACE_BUILDER", builder);
    const ScopedVariable cache("XDG_CACHE_HOME", folder_.path());
    write_file(folder_ / "box.off",
               "OFF\n8 12 0\n100 0 0\n107 0 0\n107 5 0\n100 5 0\n100 0 3\n107 0 3\n107 5 3\n100 5 3\n"
               "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n"
               "3 3 0 4\n3 3 4 7\n");
    const TracerPointer tracer = opened(loaded((folder_ / "box.off").string()), "half32");
    const auto hits = traced(tracer, {{{105, 2, 10}, 0, {0, 0, -2}, no_end}, {{103, 2, 1}, 0, {-1, 0, 0}, no_end}});
    EXPECT_EQ(hits[0].triangle, 2u);
    EXPECT_EQ(hits[0].t, 3.5F);
    EXPECT_EQ(hits[1].triangle, 10u);
    EXPECT_EQ(hits[1].t, 3.0F);
}
