// A beam answers only what all of its rays answer: sides at edges, and ways through a scene.
#include "tests/support/device_rays.h"
#include "tests/support/random.h"

#include "backends/openmp/packets.h"
#include "kernels/layouts/layout.h"

#include <cstddef>
#include <cstdint>

namespace {

#define LANES 4
using tetrace::openmp::PacketJob;
using tetrace::test::traced;

#include "backends/openmp/packet/lanes.h"

#include "backends/openmp/packet/rays.h"

#include "backends/openmp/packet/walk.h"

#include "backends/openmp/packet/start.h"

#include "backends/openmp/packet/shaft.h"

#include "backends/openmp/packet/beams.h"

constexpr std::uint32_t image_size = 64;
const float planes_of_domain[] = {-1, 1, -1, 1, -1, 1};

PacketJob job_of(const tetrace::View& view)
{
    PacketJob job{};
    for (int axis = 0; axis < 3; ++axis) {
        job.origin[axis] = view.origin[axis];
        job.corner[axis] = view.corner[axis];
        job.step_x[axis] = view.step_x[axis];
        job.step_y[axis] = view.step_y[axis];
    }
    job.lines = planes_of_domain;
    job.divisions = 1;
    job.width = job.height = image_size;
    job.max_steps = 10'000;
    return job;
}

PacketJob job_of(const tetrace::PackedScene& scene, const tetrace::TraceJob& from)
{
    PacketJob job = job_of(from.view);
    job.records = reinterpret_cast<const std::uint32_t*>(scene.tets.data());
    job.lines = reinterpret_cast<const float*>(scene.lines.data());
    job.divisions = scene.divisions;
    job.entry_ranges = scene.entry_ranges.data();
    job.entry_links = scene.entry_links.data();
    job.start_tet = from.start_tet;
    return job;
}

// Views from outside the domain and within, along axes and across, also mirrored.
tetrace::View random_view(tetrace::test::Random& random)
{
    tetrace::Camera camera;
    camera.origin = random.point(-1, 1);
    if (random.below(2) == 0) camera.origin[static_cast<int>(random.below(3))] += 2.5f;
    const tetrace::Double3 towards = to_double(random.point(-0.5f, 0.5f));
    camera.forward = normalized(random.below(4) == 0 ? tetrace::Double3{0, 0, 1} : towards);
    camera.right = normalized(cross(camera.forward, tetrace::Double3{0.3, 1, 0.1}));
    camera.up = cross(camera.right, camera.forward);
    if (random.below(2) == 0) camera.up = camera.up * -1.0;
    return make_view(camera, image_size, image_size);
}

Words words_of(tetrace::Float3 place, int axis)
{
    return as_words(all(place[axis]));
}

struct Asked {
    std::uint64_t sure = 0, answered = 0, wrong = 0;
};

// Asks beams for the sides of edges that nearly meet one of their outermost rays, and all their rays likewise.
void ask(tetrace::test::Random& random, bool has_doubts, Asked& asked)
{
    const PacketJob job = job_of(random_view(random));
    Eye eye = eye_of(job);
    if (!has_doubts) eye.doubt = eye.least_doubt = Floats{};
    Packets packets;
    packets.count = LANES;
    for (std::uint32_t i = 0; i < LANES; ++i) {
        packets.x[i] = packet_width * random.below(image_size / packet_width);
        packets.y[i] = packet_height * random.below(image_size / packet_height);
    }
    BeamWalk walk;
    aim(eye, packets, 0, walk);
    for (std::uint32_t lane = 0; lane < LANES; ++lane) {
        Packet rays;
        make_rays(job, packets.x[lane], packets.y[lane], rays);
        const std::uint32_t corner_ray = random.below(LANES);
        const float along = random.between(0.25f, 2), beyond = random.between(0.5f, 3);
        const tetrace::Float3 from = random.point(-1, 1);
        tetrace::Float3 to;
        for (int axis = 0; axis < 3; ++axis) {
            const float passed = job.origin[axis] + along * rays.direction[axis][corner_ray];
            const float at = from[axis] + beyond * (passed - from[axis]);
            to[axis] = std::min(std::max(at, -1.0f), 1.0f);
        }
        const Words p[3] = {words_of(from, 0), words_of(from, 1), words_of(from, 2)};
        const Words q[3] = {words_of(to, 0), words_of(to, 1), words_of(to, 2)};
        const SureSides sure = sure_sides(imaged(job, eye, walk, p), imaged(job, eye, walk, q));
        const Shear<any_axis> shear = shear_of<any_axis>(rays.direction);
        const Sides sides = sides_of(seen_at(rays, shear, p), seen_at(rays, shear, q));
        const bool left = (lanes_of(sure.left) >> lane & 1u) != 0, right = (lanes_of(sure.right) >> lane & 1u) != 0;
        const std::uint32_t lefts = lanes_of(sides.left), ties = lanes_of(sides.tie);
        ++asked.answered;
        asked.sure += left || right ? 1 : 0;
        asked.wrong += (left && lefts != every_lane) || (right && (lefts | ties) != 0) ? 1 : 0;
    }
}

Asked ask_many(bool has_doubts)
{
    tetrace::test::Random random(0xBEA5);
    Asked asked;
    for (int i = 0; i < 100'000; ++i)
        ask(random, has_doubts, asked);
    return asked;
}

} // namespace

TEST(Beams, are_sure_of_a_side_only_where_all_their_rays_have_it)
{
    const Asked asked = ask_many(true);
    EXPECT_EQ(asked.wrong, 0u);
    EXPECT_GT(asked.sure, asked.answered / 4);
    EXPECT_LT(asked.sure, asked.answered);
}

TEST(Beams, without_doubts_are_sure_of_wrong_sides)
{
    EXPECT_GT(ask_many(false).wrong, 0u);
}

TEST(Beams, take_the_ways_of_all_their_rays)
{
    const tetrace::test::DeviceRays scene(tetrace::make_cubes(4), tetrace::Layout::half32);
    for (const auto& from : {scene.from_outside(image_size, image_size), scene.from_inside(image_size, image_size)}) {
        const PacketJob job = job_of(scene.packed(), from);
        tetrace::KernelId scalar{.method = tetrace::Method::project, .layout = tetrace::Layout::half32};
        const auto hits = traced(*tetrace::openmp_backend().open(0, scalar, scene.data(), {.threads = 1}), from);
        std::uint32_t begun = 0, ended = 0, asked = 0;
        for (std::uint32_t y = 0; y < image_size; y += tetrace::openmp::packet_block_size) {
            Packets packets;
            packets.count = 0;
            for (std::uint32_t i = 0; i < most_packets; ++i) {
                packets.x[packets.count] = i % (image_size / packet_width) * packet_width;
                packets.y[packets.count++] = y + i / (image_size / packet_width) * packet_height;
            }
            walk_beams(job, packets);
            for (std::uint32_t i = 0; i < packets.count; ++i, ++asked) {
                begun += packets.record[i] != NO_LINK ? 1 : 0;
                ended += packets.has_ended[i] ? 1 : 0;
                for (std::uint32_t lane = 0; lane < LANES && packets.record[i] != NO_LINK; ++lane) {
                    const tetrace::Hit& hit =
                        hits[(packets.y[i] + lane / packet_width) * image_size + packets.x[i] + lane % packet_width];
                    if (!packets.has_ended[i]) {
                        ASSERT_LE(packets.steps[i], hit.steps);
                        continue;
                    }
                    ASSERT_EQ(packets.steps[i], hit.steps);
                    ASSERT_EQ(packets.record[i] >> 2, hit.tet);
                    ASSERT_EQ(packets.exit[i] == NO_LINK ? NO_HIT : packets.exit[i] >> 2, hit.face_id);
                }
            }
        }
        EXPECT_GT(begun, asked / 4);
        EXPECT_GT(ended, asked / 20);
    }
}
