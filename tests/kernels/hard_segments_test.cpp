// Task tally by project on as many hard rays as are asked for: through vertices, along edges, in faces, through
// grids, a mesh of a surface and a mesh of tets as users have them. TETRACE_HARD_RAYS is how many rays each scene gets,
// TETRACE_HARD_FIRST the number of its first one, so that a campaign may run in parts, one after the other or at once.
//
// Each ray: the answer of the kernel is that of the walk that its noting build notes; it is not lost; each tet is a
// neighbour of the one before, and none comes twice; a line from outside begins and any ray ends at the boundary of the
// domain. Its length, and how many faces are in the wrong order, are those of the walk's places. The sums of the tets
// are, as integers, those of the walks and of the answers. One batch in TETRACE_HARD_SHARE, and the first, is also
// judged by the oracle (docs/spec/volume.md, S7).
#include "bench/truth/tally.h"
#include "core/base/stopwatch.h"
#include "scenes/export_tets.h"
#include "scenes/load.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::size_t segments_at_once = 4096;

std::uint64_t number_from(const char* variable, std::uint64_t otherwise)
{
    const char* const text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// What is checked of each walk, with the scene's tets: only integers, so no bound is needed.
class WalkRules {
public:
    WalkRules(const Scene& scene, const CrossedScene& tets)
        : scene_(scene), mesh_of_packed_(tets.mesh_of_packed()), last_walk_(scene.tets.tets.size(), 0)
    {
    }

    /// Why the answer is wrong; null: it is not.
    [[nodiscard]] const char* flaw_of(const GivenRay& ray, const Segments& answer, const CrossedTets& walk)
    {
        if (answer.first == LOST) return "it is lost";
        if (answer != summary_of(walk)) return "its answer is not that of its walk";
        if (walk.tets.empty()) return nullptr;
        if (const char* const flaw = flaw_of_chain(walk)) return flaw;
        if (ray.half_face == NO_HALF_FACE && !is_at_boundary(walk.tets.front())) return "it begins inside";
        if (!is_at_boundary(walk.tets.back())) return "it ends inside";
        return nullptr;
    }

private:
    [[nodiscard]] const Tet& tet(std::uint32_t packed) const { return scene_.tets.tets[mesh_of_packed_[packed]]; }
    [[nodiscard]] bool is_at_boundary(std::uint32_t packed) const
    {
        return std::ranges::find(tet(packed).neighbours, NO_HALF_FACE) != std::ranges::end(tet(packed).neighbours);
    }

    [[nodiscard]] const char* flaw_of_chain(const CrossedTets& walk)
    {
        ++walks_;
        for (std::size_t i = 0; i < walk.tets.size(); ++i) {
            const std::uint32_t number = mesh_of_packed_.at(walk.tets[i]);
            if (std::exchange(last_walk_[number], walks_) == walks_) return "it crosses a tet twice";
            const auto leads_here = [&](std::uint32_t across) {
                return across != NO_HALF_FACE && half_face_tet(across) == number;
            };
            if (i > 0 && std::ranges::none_of(tet(walk.tets[i - 1]).neighbours, leads_here))
                return "one of its tets is not a neighbour of the tet before";
        }
        return nullptr;
    }

    const Scene& scene_;
    const std::vector<std::uint32_t>& mesh_of_packed_;
    std::vector<std::uint64_t> last_walk_; ///< number of the last walk that crossed each tet
    std::uint64_t walks_ = 0;
};

struct Campaign {
    std::uint64_t rays = 0, crossing = 0, tets = 0, reversed = 0, flawed = 0;
    Verdicts judged;
};

Campaign run_campaign(const Scene& scene, std::uint64_t first, std::uint64_t count)
{
    const CrossedScene tets(scene, Method::project, Layout::half32, Task::tally);
    const auto session = tets.session(1);
    const std::uint64_t share = std::max<std::uint64_t>(number_from("TETRACE_HARD_SHARE", 64), 1);
    WalkRules rules(scene, tets);
    Campaign all;
    for (std::uint64_t done = 0; done < count; done += segments_at_once) {
        const std::size_t size = std::min<std::uint64_t>(segments_at_once, count - done) / TILE_WIDTH * TILE_WIDTH;
        const RaySet set = hard_ray_set(scene, first + done, size);
        const std::vector<Hit> answers = tets.answers(*session, set);
        const std::vector<CrossedTets> walks = tets.walks(set);
        require_total(session->tally(), answers);
        require_sums(session->tally(), tally_of_walks(
                                           size, scene.tets.tets.size(), [&](std::size_t i) { return walks[i]; }, 1));
        for (std::size_t i = 0; i < size; ++i) {
            const Segments answer = segments_of(answers[i]);
            if (const char* const flaw = rules.flaw_of(set.rays[i], answer, walks[i])) {
                if (all.flawed++ < 10) ADD_FAILURE() << "ray " << first + done + i << ": " << flaw;
            }
            all.crossing += walks[i].tets.empty() ? 0 : 1;
            all.tets += walks[i].tets.size();
            all.reversed += answer.reversed;
        }
        all.rays += size;
        if (done / segments_at_once % share == 0) all.judged.add(tets.judged(set, answers, walks));
    }
    return all;
}

void expect_no_flaw(const std::string& name, const Scene& scene)
{
    const std::uint64_t count = std::max<std::uint64_t>(number_from("TETRACE_HARD_RAYS", 4608), TILE_WIDTH);
    const std::uint64_t first = number_from("TETRACE_HARD_FIRST", 0);
    Stopwatch watch;
    const Campaign all = run_campaign(scene, first, count);
    fmt::print(
        "{}: rays {} to {}, {} cross {} tets, {} faces reversed, {} flawed; of {} judged by the oracle {} agree, "
        "{} ties, {} wrong, {} lost; {:.0f} s\n",
        name, first, first + all.rays - 1, all.crossing, all.tets, all.reversed, all.flawed, all.judged.rays,
        all.judged.agreed, all.judged.ties, all.judged.wrong, all.judged.lost, watch.seconds());
    std::fflush(stdout);
    EXPECT_EQ(all.flawed + all.judged.wrong + all.judged.lost, 0u) << name;
    EXPECT_GT(all.crossing, all.rays / 2) << name;
    EXPECT_GT(all.judged.agreed, all.judged.rays / 4) << name;
}

/// A file of tets, with several regions, as users have them.
Scene tets_of_a_file()
{
    const TemporaryFolder folder;
    export_tets(load_scene({"field@2000", {}}, {}).scene, folder / "field.mesh");
    return load_scene({(folder / "field.mesh").string(), {}}, {}).scene;
}

} // namespace

TEST(HardSegments, through_grids_lose_no_ray_and_no_length)
{
    for (const auto& [name, scene] : make_hard_scenes())
        expect_no_flaw(name, scene);
}

TEST(HardSegments, through_a_mesh_of_tets_lose_no_ray_and_no_length)
{
    expect_no_flaw("file of tets", tets_of_a_file());
}

TEST(HardSegments, through_bunny_lose_no_ray_and_no_length)
{
    if (const std::string reason = why_not_available("bunny"); !reason.empty()) GTEST_SKIP() << reason;
    expect_no_flaw("bunny", load_scene({"bunny", {}}, {}).scene);
}

TEST(HardSegments, falsified_walks_break_the_rules)
{
    const Scene scene = make_cubes(3);
    const CrossedScene tets(scene, Method::project, Layout::half32);
    const RaySet set = hard_ray_set(scene, 0, 360);
    WalkRules rules(scene, tets);
    std::size_t falsified = 0;
    for (std::size_t i = 0; const CrossedTets& walk : tets.walks(set)) {
        const GivenRay& ray = set.rays[i++];
        ASSERT_EQ(rules.flaw_of(ray, summary_of(walk), walk), nullptr);
        if (walk.tets.size() < 3) continue;
        ++falsified;
        CrossedTets shorter = walk, twice = walk, early = walk;
        shorter.tets.erase(shorter.tets.begin() + 1);
        shorter.places.erase(shorter.places.begin() + 1);
        twice.tets.push_back(walk.tets[walk.tets.size() - 2]);
        twice.places.push_back(walk.places.back());
        early.tets.resize(2);
        early.places.resize(3);
        EXPECT_NE(rules.flaw_of(ray, summary_of(twice), twice), nullptr) << i;
        EXPECT_NE(rules.flaw_of(ray, summary_of(walk), shorter), nullptr) << i;
        Segments longer = summary_of(walk);
        longer.length += 1;
        EXPECT_NE(rules.flaw_of(ray, longer, walk), nullptr) << i;
        EXPECT_NE(rules.flaw_of(ray, {LOST, 0, 0, 0, 0, 0}, walk), nullptr) << i;
        const auto& ends = scene.tets.tets[tets.mesh_of_packed()[early.tets.back()]].neighbours;
        if (std::ranges::find(ends, NO_HALF_FACE) == std::ranges::end(ends)) {
            EXPECT_STREQ(rules.flaw_of(ray, summary_of(early), early), "it ends inside") << i;
        }
    }
    EXPECT_GT(falsified, 100u);
}
