// Packets of rays that cross tets: the bits of the scalar kernel, in answers and in sums.
#include "bench/truth/tally.h"
#include "core/base/error.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/given_scene.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/packet_widths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <fmt/format.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::array tasks{Task::segments, Task::tally, Task::absorb};
constexpr std::size_t crossed_at_once = 9 * 2048;

/// TETRACE_HARD_RAYS is how many rays per scene, rounded up.
std::uint64_t crossed_rays()
{
    const char* const text = std::getenv("TETRACE_HARD_RAYS");
    return text == nullptr ? crossed_at_once : std::strtoull(text, nullptr, 10);
}

/// A half32 scene, crossed by packets of one width and by single rays.
class Crossed {
public:
    Crossed(const Scene& scene, Task task, unsigned lanes)
        : scene_(scene), tets_(scene, Method::project, Layout::half32, task), task_(task), lanes_(lanes)
    {
    }

    /// max_steps: 0 for as many as no walk takes. Returns the answers of packets.
    std::vector<Hit> expect_scalar_bits(const RaySet& set, const std::string& what, std::uint32_t max_steps = 0) const
    {
        const auto name = [&] { return fmt::format("{}, {} rays, {}", name_of(task_), set.rays.size(), what); };
        const auto packets = session(Schedule::packets), single = session(Schedule::tiles);
        const std::vector<Hit> answers = crossed(*packets, set, max_steps), expected = crossed(*single, set, max_steps);
        const auto different = std::ranges::mismatch(
            answers, expected, [](const Hit& a, const Hit& b) { return segments_of(a) == segments_of(b); });
        EXPECT_EQ(different.in1 - answers.begin(), std::ssize(answers)) << "the first ray that differs, " << name();
        if (task_ == Task::tally) {
            EXPECT_EQ(packets->tally(), single->tally()) << name();
        }
        return answers;
    }

private:
    [[nodiscard]] std::unique_ptr<Session> session(Schedule schedule) const
    {
        KernelId kernel = tets_.kernel();
        kernel.schedule = schedule;
        return openmp_backend().open(0, kernel, {&scene_.mesh, &tets_.packed()},
                                     {.threads = 2, .packet_lanes = lanes_});
    }
    [[nodiscard]] std::vector<Hit> crossed(Session& session, const RaySet& set, std::uint32_t max_steps) const
    {
        session.set_rays(segment_quads(set, tets_.packed()));
        std::vector<Hit> answers(set.rays.size());
        const std::uint32_t most = max_steps == 0 ? tets_.packed().tet_count + 1 : max_steps;
        static_cast<void>(session.trace(given_job(set.rays.size(), most, false), answers));
        return answers;
    }

    const Scene& scene_;
    CrossedScene tets_;
    Task task_;
    unsigned lanes_;
};

class CrossingPackets : public PacketWidths {};

// Packets of 4 with a mistake in one ray of a thread.
unsigned falsified_word = 0;
void change_a_word(const openmp::PacketJob& job)
{
    openmp::packet_kernel(4).rays(job);
    job.hits[std::size_t{HIT_WORDS} * 5 + falsified_word] ^= 1u;
}
void add_twice(const openmp::PacketJob& job)
{
    openmp::packet_kernel(4).rays(job);
    job.sums[6] += 1; // far from a carry
}
void turn_a_ray(const openmp::PacketJob& job)
{
    openmp::PacketJob turned = job;
    std::vector<std::uint32_t> directions(job.directions, job.directions + std::size_t{4} * job.ray_count);
    directions[4 * 5] = std::bit_cast<std::uint32_t>(std::bit_cast<float>(directions[4 * 5]) + 0x1p-6F);
    turned.directions = directions.data();
    openmp::packet_kernel(4).rays(turned);
}

RaySet chords(const Scene& scene, std::size_t count)
{
    const HardRays rays(scene);
    RaySet set = hard_ray_set(scene, 0, count);
    for (std::size_t i = 0; i < count; ++i)
        set.rays[i] = rays.ray(i * hard_kinds);
    return set;
}

Verdicts verdicts_of(openmp::TracePackets* rays, const CrossedScene& tets, const RaySet& set)
{
    openmp::PacketSession session({4, nullptr, rays}, tets.kernel().task, tets.packed(), 1);
    return tets.judged(set, tets.answers(session, set), tets.walks(set));
}

} // namespace

TETRACE_EACH_PACKET_WIDTH(CrossingPackets);

TEST_P(CrossingPackets, have_the_scalar_kernels_bits_through_vertices_along_edges_and_in_faces)
{
    for (const auto& [name, scene] : make_hard_scenes())
        for (const Task task : tasks) {
            const Crossed crossed(scene, task, GetParam());
            for (std::uint64_t first = 0; first < crossed_rays(); first += crossed_at_once)
                crossed.expect_scalar_bits(hard_ray_set(scene, first, crossed_at_once), name);
        }
}

TEST_P(CrossingPackets, of_every_kind_of_rays_have_the_scalar_kernels_bits)
{
    for (const bool inside : {false, true}) {
        const GivenScene cubes(96, inside);
        for (const RayKind kind : {RayKind::primary, RayKind::diffuse, RayKind::random})
            for (const Task task : tasks)
                Crossed(cubes.scene, task, GetParam())
                    .expect_scalar_bits(make_rays(kind, cubes.source()), std::string(name_of(kind)));
    }
}

TEST_P(CrossingPackets, have_the_scalar_kernels_bits_however_many_they_are)
{
    const Scene scene = make_cubes(5);
    for (const std::size_t count : {8u, 24u, 40u, 504u, 512u, 520u, 16'400u})
        Crossed(scene, Task::tally, GetParam()).expect_scalar_bits(hard_ray_set(scene, 7, count), "512 at once");
}

TEST_P(CrossingPackets, lose_the_rays_that_the_scalar_kernel_loses_and_add_the_same_lengths)
{
    const Scene scene = make_cubes(7);
    for (const Task task : tasks)
        for (const std::uint32_t most : {1u, 2u, 9u}) {
            const auto answers =
                Crossed(scene, task, GetParam()).expect_scalar_bits(hard_ray_set(scene, 0, 4000), "few steps", most);
            EXPECT_TRUE(std::ranges::any_of(answers, [](const Hit& hit) { return hit.face_id == LOST; })) << most;
        }
}

TEST(FalsifiedPackets, are_caught)
{
    const Scene scene = make_cubes(3);
    const CrossedScene tets(scene, Method::project, Layout::half32);
    const RaySet set = chords(scene, 80);
    EXPECT_TRUE(verdicts_of(openmp::packet_kernel(4).rays, tets, set).clean());
    for (falsified_word = 0; falsified_word < HIT_WORDS; ++falsified_word)
        EXPECT_EQ(verdicts_of(change_a_word, tets, set).wrong, 1u) << "word " << falsified_word;
    EXPECT_EQ(verdicts_of(turn_a_ray, tets, set).wrong, 1u);

    const CrossedScene tallied(scene, Method::project, Layout::half32, Task::tally);
    openmp::PacketSession session({4, nullptr, add_twice}, Task::tally, tallied.packed(), 1);
    const auto answers = tallied.answers(session, set);
    EXPECT_THROW(require_total(session.tally(), answers), Error);
}
