// How good is the oracle? Right answers near edges and silhouettes are falsified, and it must catch them all, but those
// that have a witness. TETRACE_CAMPAIGN is how many rays a mesh gets.
#include "backends/embree/queries.h"
#include "bench/truth/judge.h"
#include "core/base/exact.h"
#include "scenes/load.h"
#include "scenes/procedural.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/near_misses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

enum class Falsified { next_layer, layer_behind, neighbour, no_hit, edge_on, t_off, u_outside, v_outside };
constexpr std::array<const char*, 8> kinds{"the next layer",      "the layer after that", "a neighbour", "NO_HIT",
                                           "an edge-on triangle", "t off by ten bounds",  "u outside",   "v outside"};

struct Count {
    std::uint64_t falsified = 0, caught = 0, excused = 0, exact = 0, overlooked = 0;
};
using Counts = std::array<Count, kinds.size()>;

std::uint32_t wanted(std::uint32_t otherwise)
{
    const char* const text = std::getenv("TETRACE_CAMPAIGN");
    return text == nullptr ? otherwise : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

class Campaign {
public:
    explicit Campaign(const TriangleMesh& mesh)
        : mesh_(mesh), rays_(mesh), search_(mesh), settler_(mesh, search_), judge_(mesh, 1),
          embree_(mesh, embree::Tree::robust, 0)
    {
    }

    /// Falsifies answers until each kind has `wanted` of them, a block of rays at a time; fewer of kinds that apply to
    /// less than one ray in eight.
    [[nodiscard]] Counts run(std::uint32_t wanted) const
    {
        Counts counts{};
        const std::uint32_t block = std::clamp(wanted / 8, 64u, 65'536u);
        for (std::uint32_t first = 0; first < 8 * wanted; first += block) {
            Kinds asked{};
            for (std::size_t kind = 0; kind < kinds.size(); ++kind)
                asked[kind] = counts[kind].falsified < wanted;
            if (asked == Kinds{}) break;
#pragma omp parallel
            {
                Counts mine{};
#pragma omp for schedule(dynamic, 64)
                for (std::uint32_t number = first; number < first + block; ++number)
                    falsify(mine, number, asked);
#pragma omp critical
                add(counts, mine);
            }
        }
        return counts;
    }

private:
    using Kinds = std::array<bool, kinds.size()>; // those that answers are still wanted of

    static void add(Counts& counts, const Counts& mine)
    {
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
            counts[kind].falsified += mine[kind].falsified;
            counts[kind].caught += mine[kind].caught;
            counts[kind].excused += mine[kind].excused;
            counts[kind].exact += mine[kind].exact;
            counts[kind].overlooked += mine[kind].overlooked;
        }
    }

    // What Embree finds along a ray: up to three layers.
    [[nodiscard]] std::vector<std::uint32_t> layers(const ExactRay& ray) const
    {
        std::vector<std::uint32_t> found;
        for (float near = 0; found.size() < 3;) {
            RTCRayHit query = embree::query_of(ray.origin, ray.direction, near, NO_END);
            embree::intersect(embree_.scene(), query, embree::Coherence::incoherent);
            if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
            found.push_back(query.hit.primID);
            near = query.ray.tfar * (1 + 0x1p-16f);
        }
        return found;
    }

    [[nodiscard]] Hit hit_on(const ExactRay& ray, std::uint32_t face) const
    {
        const HitPoint point = point_of(mesh_, ray, face);
        if (std::isfinite(point.t))
            return {face, 0, static_cast<float>(point.t), static_cast<float>(point.u), static_cast<float>(point.v), 0};
        const auto& [a, b, c] = mesh_.triangles[face];
        const Double3 centre =
            (to_double(mesh_.vertices[a]) + to_double(mesh_.vertices[b]) + to_double(mesh_.vertices[c])) * (1.0 / 3);
        const Double3 way = to_double(ray.direction);
        return {face,     0,        static_cast<float>(dot(centre - to_double(ray.origin), way) / dot(way, way)),
                1.0f / 3, 1.0f / 3, 0};
    }

    void falsify(Counts& counts, std::uint32_t number, const Kinds& asked) const
    {
        const ExactRay ray = rays_.ray(number);
        const auto found = layers(ray);
        const auto with = [&](Falsified kind, const Hit& hit) {
            const auto index = static_cast<std::size_t>(kind);
            if (asked[index]) judge(counts[index], ray, hit, number % 64 == 0);
        };
        if (found.empty()) return;
        with(Falsified::no_hit, {NO_HIT, NO_TET, 0, 0, 0, 0});
        if (found.size() > 1) with(Falsified::next_layer, hit_on(ray, found[1]));
        if (found.size() > 2) with(Falsified::layer_behind, hit_on(ray, found[2]));
        const double bound = tie_bound(ray.origin);
        std::uint32_t flattest = NO_HIT, neighbour = NO_HIT;
        double least = 0.125;
        for (const std::uint32_t face : search_.within(ray, {}, 16 * bound)) {
            if (face == found[0]) continue;
            const double flatness = sine_of(ray, face);
            if (flatness < least) {
                least = flatness;
                flattest = face;
            }
            if (shares_vertex(face, found[0])) neighbour = face;
        }
        if (flattest != NO_HIT) with(Falsified::edge_on, hit_on(ray, flattest));
        if (neighbour != NO_HIT) with(Falsified::neighbour, hit_on(ray, neighbour));

        const HitPoint point = point_of(mesh_, ray, found[0]);
        const Hit right = hit_on(ray, found[0]);
        if (!std::isfinite(point.t) || point.t_error > 0.0625) return;
        const float sense = number % 2 == 0 ? 1.0f : -1.0f;
        Hit hit = right;
        hit.t += sense * static_cast<float>(10 * point.t_error);
        with(Falsified::t_off, hit);
        hit = right;
        hit.u = sense > 0 ? 1 + static_cast<float>(10 * point.u_error) : -static_cast<float>(10 * point.u_error);
        if (std::abs(static_cast<double>(hit.u) - point.u) > 2 * point.u_error) with(Falsified::u_outside, hit);
        hit = right;
        hit.v = sense > 0 ? 1 + static_cast<float>(10 * point.v_error) : -static_cast<float>(10 * point.v_error);
        if (std::abs(static_cast<double>(hit.v) - point.v) > 2 * point.v_error) with(Falsified::v_outside, hit);
    }

    void judge(Count& count, const ExactRay& ray, const Hit& hit, bool asks_nearby) const
    {
        ++count.falsified;
        const JudgedRay judged{ray, ray, {}, judge_.first(ray, {}), 0, 0, 0, 0};
        Verdicts verdicts;
        if (judge_.judge(verdicts, judged, hit, HitFormula::kernels)) {
            ++count.caught;
            if (asks_nearby && is_met_nearby(ray, hit)) ++count.overlooked;
            return;
        }
        count.excused += verdicts.ties;
        count.exact += verdicts.agreed + verdicts.settled;
        if (verdicts.ties == 1) expect_a_witness(ray, hit.face_id);
    }

    // The witness holds against all triangles of the mesh's neighbourhood, gathered anew from a wider tube.
    void expect_a_witness(const ExactRay& ray, std::uint32_t face) const
    {
        const double bound = tie_bound(ray.origin);
        Settlement tie = settler_.settle(ray, {}, face, bound);
        if (face == NO_HIT) tie.witness.back() = tie.witness.back() + witness_corner(to_double(ray.direction) * 16);
        const auto around = search_.within(ray, {}, 4 * bound);
        EXPECT_TRUE(is_witness(mesh_, {ray, {}, face, bound, around}, tie.witness));
        EXPECT_LE(tie.distance, bound * (1 + 1e-12));
    }

    // Whether Embree finds that answer, with that t, along one of many parallel rays within 7/8 of the bound: then the
    // oracle has overlooked a witness.
    [[nodiscard]] bool is_met_nearby(const ExactRay& ray, const Hit& hit) const
    {
        if (hit.face_id != NO_HIT && !names_right_point(mesh_, ray, hit, HitFormula::kernels, 0)) return false;
        constexpr std::uint32_t stream = 103, rays_nearby = 256;
        const double reach = tie_bound(ray.origin) - 0x1p-24 * 4; // an origin is rounded
        for (std::uint32_t i = 0; i < rays_nearby; ++i) {
            const Double3 shift = random_direction({stream, i, 0, 0}) * (reach * (i % 8) / 8);
            const Float3 origin = snap_to_grid(to_float(to_double(ray.origin) + shift));
            RTCRayHit query = embree::query_of(origin, ray.direction, 0, NO_END);
            embree::intersect(embree_.scene(), query, embree::Coherence::incoherent);
            if (hit.face_id != (query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? NO_HIT : query.hit.primID)) continue;
            if (settler_.settle({origin, ray.direction}, {}, hit.face_id, 0x1p-40).kind != Settlement::Kind::exact)
                continue;
            ADD_FAILURE() << "origin moved by " << length(to_double(origin) - to_double(ray.origin)) << " of "
                          << tie_bound(ray.origin);
            return true;
        }
        return false;
    }

    [[nodiscard]] double sine_of(const ExactRay& ray, std::uint32_t face) const
    {
        const auto& [a, b, c] = mesh_.triangles[face];
        const Double3 v = to_double(mesh_.vertices[a]);
        const Double3 normal = cross(to_double(mesh_.vertices[b]) - v, to_double(mesh_.vertices[c]) - v);
        const Double3 way = to_double(ray.direction);
        return std::abs(dot(normal, way)) / (length(normal) * length(way));
    }
    [[nodiscard]] bool shares_vertex(std::uint32_t a, std::uint32_t b) const
    {
        const auto& corners = mesh_.triangles[a];
        return std::ranges::any_of(mesh_.triangles[b],
                                   [&](std::uint32_t v) { return std::ranges::find(corners, v) != corners.end(); });
    }

    const TriangleMesh& mesh_;
    NearMisses rays_;
    ExactSearch search_;
    Settler settler_;
    Judge judge_;
    embree::Accelerator embree_;
};

void expect_all_caught(const char* name, const TriangleMesh& mesh, std::uint32_t answers)
{
    const Counts counts = Campaign(mesh).run(answers);
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        const Count& count = counts[kind];
        fmt::print("{}: {}: {} falsified, {} caught, {} with a witness, {} right\n", name, kinds[kind], count.falsified,
                   count.caught, count.excused, count.exact);
        EXPECT_EQ(count.caught + count.excused + count.exact, count.falsified);
        EXPECT_EQ(count.overlooked, 0u) << name << ", " << kinds[kind] << ": a ray nearby explains what was caught";
        const bool is_point = kind >= static_cast<std::size_t>(Falsified::t_off);
        if (is_point) {
            EXPECT_EQ(count.caught, count.falsified) << name << ", " << kinds[kind];
        }
    }
    EXPECT_GT(counts[static_cast<std::size_t>(Falsified::no_hit)].caught, 0u) << name;
}

class OracleCampaignOn : public testing::TestWithParam<std::string> {};

} // namespace

TEST(OracleCampaign, falsified_answers_on_hard_meshes_are_caught_unless_they_have_a_witness)
{
    for (const auto& [name, scene] : make_hard_scenes())
        expect_all_caught(name, scene.mesh, wanted(400));
}

TEST_P(OracleCampaignOn, falsified_answers_are_caught_unless_they_have_a_witness)
{
    const std::string name = GetParam();
    if (const std::string reason = why_not_available(name); !reason.empty()) GTEST_SKIP() << reason;
    expect_all_caught(name.c_str(), load_scene({name, {}}, {}).scene.mesh, wanted(1'500));
}

INSTANTIATE_TEST_SUITE_P(each, OracleCampaignOn, testing::Values("bunny", "armadillo"),
                         [](const auto& instance) { return instance.param; });
