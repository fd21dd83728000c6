// The exact search and the verdicts, against other exact arithmetic and against answers that are made wrong.
#include "bench/judging/answers.h"
#include "bench/judging/made_rays.h"
#include "bench/truth/hit_point.h"
#include "core/base/exact.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/near_misses.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();

/// A scene's mesh, and a search in it.
struct Judged {
    explicit Judged(TriangleMesh of) : mesh(std::move(of)), search(mesh) {}

    [[nodiscard]] JudgedAnswer judge(const MeshRay& ray, const MeshAnswer& answer) const
    {
        return judge_answer({mesh, search, {}}, ray, answer);
    }
    [[nodiscard]] MeshAnswer right(const MeshRay& ray, std::uint32_t face) const
    {
        const auto [t, u, v] = search.point_of(ray, face);
        const auto rounded = [](double a) { return static_cast<double>(static_cast<float>(a)); };
        return {static_cast<double>(face), rounded(t), rounded(u), rounded(v)};
    }

    TriangleMesh mesh;
    NearestSearch search;
};

/// By core/base/exact.h, triangle by triangle. Precondition: coordinates on its grid, t from 0.
std::vector<std::uint32_t> nearest_of_all(const TriangleMesh& mesh, Float3 origin, Float3 direction)
{
    std::vector<std::uint32_t> nearest;
    Float3 least[3];
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Float3 corners[3] = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
        if (!cross_exactly(origin, direction, corners[0], corners[1], corners[2]).met) continue;
        const auto order =
            nearest.empty() ? std::strong_ordering::less : compare_distance(origin, direction, corners, least);
        if (order > 0) continue;
        if (order < 0) {
            nearest.clear();
            std::copy(corners, corners + 3, least);
        }
        nearest.push_back(i);
    }
    return nearest;
}

MeshRay mesh_ray(const RayNumbers& r)
{
    return {{r[0], r[1], r[2]}, {r[4], r[5], r[6]}, r[3], r[7]};
}

/// Two triangles in the plane z = 0 that share the edge from (0, 0) to (1, 1), and one without area.
TriangleMesh square()
{
    return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 2, 2}}};
}

/// Answers that are made wrong, as in the campaign of tests/truth/oracle_campaign_test.cpp.
enum class Falsified { next_layer, layer_after, neighbour, edge_on, miss, no_face, t_off, u_off, v_off };
constexpr const char* falsified_names[] = {"the next layer", "the layer after that",       "a neighbour", "edge-on",
                                           "a miss",         "a face that the mesh lacks", "t off",       "u off",
                                           "v off"};

bool shares_vertex(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b)
{
    const auto& corners = mesh.triangles[a];
    return std::ranges::any_of(mesh.triangles[b],
                               [&](std::uint32_t v) { return std::ranges::find(corners, v) != corners.end(); });
}

double sine_of(const TriangleMesh& mesh, const MeshRay& ray, std::uint32_t face)
{
    const auto& [a, b, c] = mesh.triangles[face];
    const Double3 v = to_double(mesh.vertices[a]);
    const Double3 normal = cross(to_double(mesh.vertices[b]) - v, to_double(mesh.vertices[c]) - v);
    return std::abs(dot(normal, ray.direction)) / (length(normal) * length(ray.direction));
}

/// The face of a wrong answer; nothing if there is none for this ray.
std::optional<std::uint32_t> false_face(const Judged& judged, const MeshRay& ray, Falsified kind, std::uint32_t number)
{
    const auto nearest = judged.search.nearest(ray);
    if (kind == Falsified::next_layer || kind == Falsified::layer_after) {
        MeshRay rest = ray;
        auto met = nearest;
        for (int layer = kind == Falsified::next_layer ? 1 : 2; layer > 0 && !met.empty(); --layer) {
            rest.t_min = std::nextafter(judged.search.point_of(ray, met.front()).t, no_end);
            met = judged.search.nearest(rest);
        }
        return met.empty() || std::ranges::binary_search(nearest, met.front()) ? std::nullopt
                                                                               : std::optional(met.front());
    }
    std::vector<std::uint32_t> faces;
    for (std::uint32_t face = 0; face < judged.mesh.triangles.size(); ++face) {
        if (std::ranges::binary_search(nearest, face) || judged.search.sees_edge_on(ray, face)) continue;
        const bool is_wanted = kind == Falsified::neighbour ? shares_vertex(judged.mesh, face, nearest.front())
                                                            : sine_of(judged.mesh, ray, face) < 0.125;
        if (is_wanted) faces.push_back(face);
    }
    return faces.empty() ? std::nullopt : std::optional(faces[number % faces.size()]);
}

/// Nothing if the ray cannot have such an answer.
std::optional<MeshAnswer> falsified(const Judged& judged, const MeshRay& ray, Falsified kind, std::uint32_t number)
{
    const auto nearest = judged.search.nearest(ray);
    if (nearest.empty()) return std::nullopt;
    if (kind == Falsified::miss) return MeshAnswer{-1, 0, 0, 0};
    if (kind < Falsified::miss) {
        const auto face = false_face(judged, ray, kind, number);
        return face ? std::optional(judged.right(ray, *face)) : std::nullopt;
    }
    MeshAnswer answer = judged.right(ray, nearest.front());
    const HitPoint point =
        point_of(judged.mesh, ray.origin, ray.direction, nearest.front(), AnswerTolerance{}.unit_roundoff);
    if (!std::isfinite(point.t)) return std::nullopt;
    const double bounds = number % 2 == 0 ? 10 : -10;
    if (kind == Falsified::no_face) answer.face = static_cast<double>(judged.mesh.triangles.size());
    if (kind == Falsified::t_off) answer.t += bounds * point.t_error;
    if (kind == Falsified::u_off) answer.u += bounds * point.u_error;
    if (kind == Falsified::v_off) answer.v += bounds * point.v_error;
    return answer;
}

/// As files have it.
std::vector<MeshAnswer> through_npy(const std::vector<MeshAnswer>& answers)
{
    const TemporaryFolder folder;
    std::vector<float> numbers;
    for (const MeshAnswer& answer : answers)
        for (const double number : {answer.face, answer.t, answer.u, answer.v})
            numbers.push_back(static_cast<float>(number));
    write_npy(folder / "hits.npy", 4, numbers);
    return mesh_answers_of(read_npy(folder / "hits.npy", 4, "answers"), folder / "hits.npy");
}

} // namespace

TEST(Answers, nearest_triangles_are_those_of_other_exact_arithmetic)
{
    std::uint64_t ties = 0, hits = 0;
    for (const auto& [name, scene] : make_hard_scenes()) {
        const Judged judged(scene.mesh);
        const NearMisses near_misses(scene.mesh);
        for (std::uint32_t i = 0; i < 400; ++i) {
            const ExactRay ray = near_misses.ray(i);
            const auto expected = nearest_of_all(scene.mesh, ray.origin, ray.direction);
            const MeshRay same{to_double(ray.origin), to_double(ray.direction), 0, no_end};
            ASSERT_EQ(judged.search.nearest(same), expected) << name << ", near miss " << i;
        }
        for (const RayNumbers& numbers : make_mesh_rays(MadeRays::hard, scene.mesh, 1000)) {
            MeshRay ray = mesh_ray(numbers);
            const Float3 origin = to_float(ray.origin), direction = to_float(ray.direction);
            ray.t_min = 0;
            ray.t_max = no_end;
            const bool is_on_grid = snap_to_grid(origin) == origin && snap_to_grid(direction) == direction;
            if (!is_on_grid || length(ray.origin) > 32) continue;
            const auto expected = nearest_of_all(scene.mesh, origin, direction);
            ASSERT_EQ(judged.search.nearest(ray), expected) << name;
            ties += expected.size() > 1 ? 1 : 0;
            hits += expected.empty() ? 0 : 1;
        }
    }
    EXPECT_GT(hits, 1000u);
    EXPECT_GT(ties, 300u) << "hard rays pass exactly through vertices and edges";
}

TEST(Answers, falsified_ones_in_a_file_are_all_caught)
{
    std::array<std::size_t, std::size(falsified_names)> made{}; // not every mesh has all layers
    for (const auto& [name, scene] : make_hard_scenes()) {
        const Judged judged(scene.mesh);
        const NearMisses near_misses(scene.mesh);
        for (int kind = 0; kind < static_cast<int>(std::size(falsified_names)); ++kind) {
            std::vector<MeshRay> rays;
            std::vector<MeshAnswer> answers;
            for (std::uint32_t i = 0; i < 500; ++i) {
                const ExactRay miss = near_misses.ray(i);
                const MeshRay ray{to_double(miss.origin), to_double(miss.direction), 0, no_end};
                const auto answer = falsified(judged, ray, static_cast<Falsified>(kind), i);
                if (!answer) continue;
                rays.push_back(ray);
                answers.push_back(*answer);
            }
            const AnswerCounts counts =
                judge_answers({judged.mesh, judged.search, {}}, rays, through_npy(answers), 1, {});
            made[static_cast<std::size_t>(kind)] += rays.size();
            EXPECT_EQ(counts.faults(), rays.size()) << name << ", " << falsified_names[kind];
        }
    }
    for (std::size_t kind = 0; kind < made.size(); ++kind)
        EXPECT_GT(made[kind], 100u) << falsified_names[kind];
}

TEST(Answers, have_one_verdict_each)
{
    const Judged judged(square());
    const MeshRay inside{{0.75, 0.25, 1}, {0, 0, -1}, 0, no_end}, on_edge{{0.5, 0.5, 1}, {0, 0, -1}, 0, no_end},
        beside{{2, 2, 1}, {0, 0, -1}, 0, no_end}, in_plane{{-1, 0.5, 0}, {1, 0, 0}, 0, no_end},
        short_one{{0.75, 0.25, 1}, {0, 0, -1}, 0, 0.5}, late{{0.75, 0.25, 1}, {0, 0, -1}, 1.5, no_end},
        to_end{{0.75, 0.25, 1}, {0, 0, -1}, 1, 1};
    const MeshAnswer miss{}, first{0, 1, 0.5, 0.25}, second{1, 1, 0.5, 0.25};
    const struct {
        MeshRay ray;
        MeshAnswer answer;
        AnswerVerdict verdict;
    } cases[] = {
        {inside, first, AnswerVerdict::right},
        {inside, second, AnswerVerdict::wrong},
        {inside, miss, AnswerVerdict::missed},
        {inside, {0, 1.0001, 0.5, 0.25}, AnswerVerdict::inaccurate},
        {inside, {0, 1, 0.25, 0.25}, AnswerVerdict::inaccurate},
        {inside, {0, 1, 0.5, NAN}, AnswerVerdict::inaccurate},
        {inside, {3, 1, 0.5, 0.25}, AnswerVerdict::wrong},
        {inside, {-2, 1, 0.5, 0.25}, AnswerVerdict::wrong},
        {to_end, first, AnswerVerdict::right},
        {on_edge, {0, 1, 0, 0.5}, AnswerVerdict::tie},
        {on_edge, {1, 1, 0.5, 0}, AnswerVerdict::tie},
        {on_edge, {2, 1, 0.5, 0}, AnswerVerdict::wrong}, // a triangle without area
        {on_edge, miss, AnswerVerdict::missed},
        {beside, miss, AnswerVerdict::right},
        {beside, first, AnswerVerdict::invented},
        {in_plane, miss, AnswerVerdict::right}, // it runs in the plane of all
        {in_plane, {1, 1, 0, 0.5}, AnswerVerdict::invented},
        {short_one, miss, AnswerVerdict::right},
        {short_one, first, AnswerVerdict::invented},
        {late, first, AnswerVerdict::invented},
    };
    for (const auto& [ray, answer, verdict] : cases) {
        const JudgedAnswer found = judged.judge(ray, answer);
        EXPECT_EQ(name_of(found.verdict), name_of(verdict)) << &ray - &cases[0].ray << ": " << found.reason;
        EXPECT_EQ(found.reason.empty(), !is_fault(verdict));
    }
    EXPECT_EQ(judged.judge(on_edge, miss).nearest, (std::vector<std::uint32_t>{0, 1})) << "the witnesses";
}

TEST(Answers, may_name_a_triangle_seen_edge_on_where_another_is_met)
{
    const Judged corner({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {{0, 1, 2}, {0, 1, 3}}});
    const MeshRay along{{0.5, -1, 0}, {0, 1, 0}, 0, no_end}; // in the plane of 0, through an edge of both
    EXPECT_EQ(corner.search.nearest(along), std::vector<std::uint32_t>{1});
    EXPECT_EQ(corner.judge(along, {0, 1, 0.5, 0}).verdict, AnswerVerdict::tie);
    EXPECT_EQ(corner.judge(along, {0, 1.25, 0.5, 0.25}).verdict, AnswerVerdict::inaccurate);
}

TEST(Answers, that_name_a_triangle_seen_edge_on_have_a_t_even_where_rounding_loses_the_one_met)
{
    // The second triangle is the first one's plane continued, but for one unit of float32.
    const Judged fold({{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {0, -1, -1 + 0x1p-24f}}, {{0, 1, 2}, {0, 1, 3}}});
    const MeshRay along{{-0.5, -1, -1.5}, {1, 1, 2}, 0, no_end};
    ASSERT_FALSE(std::isfinite(point_of(fold.mesh, along.origin, along.direction, 1, 0x1p-24).t));
    ASSERT_EQ(fold.search.nearest(along), std::vector<std::uint32_t>{1});
    for (const double face : {0.0, 1.0}) {
        EXPECT_FALSE(is_fault(fold.judge(along, {face, 1, 0.5, 0}).verdict)) << face;
        for (const double t : {1.25, -1.0, 1e9, no_end, static_cast<double>(NAN)})
            EXPECT_EQ(fold.judge(along, {face, t, 0.5, 0}).verdict, AnswerVerdict::inaccurate) << face << ", " << t;
    }
}

TEST(Answers, are_near_an_edge_where_the_choice_of_a_triangle_is)
{
    TriangleMesh mesh = square();
    const auto add_upright = [&](float x, float z) { // seen edge-on from above
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{x, 0, z}, {x, 1, z}, {x, 1, z + 0.25f}});
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    for (const auto& [x, z] : {std::pair{0.75f, 0.5f}, {100.0f, 0.5f}, {0.75f, 5.0f}}) // 3: passed, 4: far, 5: at t < 0
        add_upright(x, z);
    const Judged judged(mesh);
    const MeshRay inside{{0.75, 0.25, 1}, {0, 0, -1}, 0, no_end}, on_edge{{0.5, 0.5, 1}, {0, 0, -1}, 0, no_end},
        beside_edge{{0.25, -0.5 - 0x1p-26, 1}, {0.25, 0.5, -1}, 0, no_end},
        short_one{{0.5, 0.5, 1}, {0, 0, -1}, 0, 0.5};
    const MeshAnswer miss{}, first{0, 1, 0.5, 0.25};
    const struct {
        MeshRay ray;
        MeshAnswer answer;
        AnswerVerdict verdict;
        bool is_near_edge;
    } cases[] = {
        {inside, miss, AnswerVerdict::missed, false},
        {on_edge, miss, AnswerVerdict::missed, true},
        {on_edge, {0, 2, 0, 0.5}, AnswerVerdict::inaccurate, false},
        {beside_edge, first, AnswerVerdict::invented, true},
        {short_one, first, AnswerVerdict::invented, false}, // it ends before the edge
        {inside, {3, 0.5, 0, 0}, AnswerVerdict::wrong, true},
        {inside, {4, 0.5, 0, 0}, AnswerVerdict::wrong, false},
        {inside, {5, 0.5, 0, 0}, AnswerVerdict::wrong, false},
    };
    for (const auto& [ray, answer, verdict, is_near_edge] : cases) {
        const JudgedAnswer found = judged.judge(ray, answer);
        EXPECT_EQ(name_of(found.verdict), name_of(verdict)) << &ray - &cases[0].ray << ": " << found.reason;
        EXPECT_EQ(found.is_near_edge, is_near_edge) << &ray - &cases[0].ray;
    }
}

TEST(Answers, are_judged_where_float32_ends)
{
    // Far off the grid of scenes, and apart by less than float64 keeps in a product.
    const float tiny = 0x1p-100f;
    const Judged thin(
        {{{0, 0, tiny}, {1, 0, tiny}, {0, 1, tiny}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{3, 4, 5}, {0, 1, 2}}});
    const MeshRay down{{0.25, 0.25, 1}, {0, 0, -1}, 0, no_end}, up{{0.25, 0.25, -1}, {0, 0, 1}, 0, no_end};
    EXPECT_EQ(thin.search.nearest(down), std::vector<std::uint32_t>{1});
    EXPECT_EQ(thin.search.nearest(up), std::vector<std::uint32_t>{0});
    const Judged one(square());
    const double below = std::nextafter(1.0, 0.0); // a float64 ray that ends one unit before the square
    EXPECT_TRUE(one.search.nearest({{0.75, 0.25, 1}, {0, 0, -1}, 0, below}).empty());
    EXPECT_EQ(one.search.nearest({{0.75, 0.25, 1}, {0, 0, -1}, 0, 1}).size(), 1u);
    const double past = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(one.search.nearest({{past, 0.25, 1}, {0, 0, -1}, 0, no_end}).empty());
    EXPECT_EQ(one.search.nearest({{1, 0.25, 1}, {0, 0, -1}, 0, no_end}).size(), 1u);
}

TEST(Answers, of_float64_have_its_tolerance)
{
    const Judged judged(square());
    const MeshRay ray{{0.7, 0.3, 1}, {0.1, 0.1, -1.1}, 0, no_end};
    const auto [t, u, v] = judged.search.point_of(ray, judged.search.nearest(ray).front());
    const MeshAnswer exact{0, t, u, v}, rounded{0, static_cast<double>(static_cast<float>(t)), u, v};
    const AnswerCase in_double{judged.mesh, judged.search, {0x1p-53, 2}}, in_float{judged.mesh, judged.search, {}};
    EXPECT_EQ(judge_answer(in_double, ray, exact).verdict, AnswerVerdict::right);
    EXPECT_EQ(judge_answer(in_float, ray, rounded).verdict, AnswerVerdict::right);
    EXPECT_EQ(judge_answer(in_double, ray, rounded).verdict, AnswerVerdict::inaccurate);
}

TEST(Answers, of_bad_files_are_refused_with_the_row)
{
    const double inf = no_end;
    const struct {
        std::vector<double> ray;
        const char* says;
    } rays[] = {
        {{0, 0, NAN, 0, 0, 0, 1, inf}, "origin z is nan"},    {{0, 0, 0, 0, 0, 0, 0, inf}, "direction is 0"},
        {{0, 0, 0, inf, 0, 0, 1, inf}, "t_min is inf"},       {{0, 0, 0, 2, 0, 0, 1, 1}, "t_max is below t_min"},
        {{0, 1e300, 0, 0, 0, 0, 1, 1}, "origin y is 1e+300"},
    };
    const auto message_of = [](const auto& call) -> std::string {
        try {
            static_cast<void>(call());
            return "accepted";
        } catch (const Error& error) {
            return error.kind() == ErrorKind::invalid_input ? error.what() : "another kind";
        }
    };
    for (const auto& [ray, says] : rays) {
        const std::string text = message_of([&] { return mesh_rays_of({1, 8, true, ray}, "rays.npy"); });
        EXPECT_NE(text.find(says), std::string::npos) << text << "\nlacks " << says;
        EXPECT_NE(text.find("rays.npy: row 0"), std::string::npos) << text;
    }
    const Judged judged(square());
    for (const double far :
         {static_cast<double>(std::numeric_limits<float>::max()), 1e300}) // "no end" of many programs
        for (const double t_min : {-far, 0.0, 5e-324}) {
            const auto accepted = mesh_rays_of({1, 8, true, {0.75, 0.25, 1, t_min, 0, 0, -1, far}}, "rays.npy");
            EXPECT_EQ(judged.judge(accepted.front(), {0, 1, 0.5, 0.25}).verdict, AnswerVerdict::right);
        }
    for (const double face : {0.5, static_cast<double>(NAN)})
        EXPECT_NE(message_of([&] {
                      return mesh_answers_of({1, 4, true, {face, 0, 0, 0}}, "hits.npy");
                  }).find("hits.npy: row 0"),
                  std::string::npos);
}

TEST(MadeRays, are_as_many_as_wanted_and_what_files_may_hold)
{
    const Scene scene = make_hard_scenes().front().scene;
    for (const MadeRays kind : values_of<MadeRays>()) {
        const auto rays = make_mesh_rays(kind, scene.mesh, 1001);
        ASSERT_EQ(rays.size(), 1001u);
        std::vector<double> numbers;
        for (const RayNumbers& ray : rays)
            numbers.insert(numbers.end(), ray.begin(), ray.end());
        EXPECT_NO_THROW(static_cast<void>(mesh_rays_of({rays.size(), 8, false, numbers}, "rays.npy"))) << name_of(kind);
    }
    const TriangleMesh point{{{1, 1, 1}}, {{0, 0, 0}}};
    EXPECT_THROW(static_cast<void>(make_mesh_rays(MadeRays::hard, point, 1)), Error);
}
