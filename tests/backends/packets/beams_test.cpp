// A beam answers only what all of its rays answer: sides at edges, and ways through a scene.
#include "kernels/layouts/layout.h"
#include "tests/backends/packets/beam_probe.h"
#include "tests/support/device_rays.h"
#include "tests/support/packet_widths.h"
#include "tests/support/random.h"

#include <cstddef>
#include <cstdint>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using openmp::PacketJob;

constexpr std::uint32_t image_size = 64;
const float planes_of_domain[] = {-1, 1, -1, 1, -1, 1};

PacketJob job_of(const View& view)
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

PacketJob job_of(const PackedScene& scene, const TraceJob& from)
{
    PacketJob job = job_of(from.view);
    job.records = reinterpret_cast<const std::uint32_t*>(scene.tets.data());
    job.lines = reinterpret_cast<const float*>(scene.lines.data());
    job.divisions = scene.divisions;
    job.entry_ranges = scene.entry_ranges.data();
    job.entry_half_faces = scene.entry_half_faces.data();
    job.start_tet = from.start_tet;
    return job;
}

// Views from outside the domain and within, along axes and across, also mirrored.
View random_view(Random& random)
{
    Camera camera;
    camera.origin = random.point(-1, 1);
    if (random.below(2) == 0) camera.origin[static_cast<int>(random.below(3))] += 2.5f;
    const Double3 towards = to_double(random.point(-0.5f, 0.5f));
    camera.forward = normalized(random.below(4) == 0 ? Double3{0, 0, 1} : towards);
    camera.right = normalized(cross(camera.forward, Double3{0.3, 1, 0.1}));
    camera.up = cross(camera.right, camera.forward);
    if (random.below(2) == 0) camera.up = camera.up * -1.0;
    return make_view(camera, image_size, image_size);
}

const BeamProbe& probe_of(unsigned lanes)
{
    using namespace test;
    return lanes == 4 ? tetrace_beam_probe_4 : lanes == 8 ? tetrace_beam_probe_8 : tetrace_beam_probe_16;
}

struct Asked {
    std::uint64_t sure = 0, answered = 0, wrong = 0;
};

// Asks beams for the sides of edges that nearly meet one of their outermost rays, and all their rays likewise.
void ask(const BeamProbe& probe, Random& random, bool has_doubts, Asked& asked)
{
    const PacketJob job = job_of(random_view(random));
    std::vector<BeamQuestion> questions(probe.lanes);
    for (BeamQuestion& question : questions) {
        question.x = probe.packet_width * random.below(image_size / probe.packet_width);
        question.y = probe.packet_height * random.below(image_size / probe.packet_height);
        question.ray = random.below(probe.lanes);
        question.along = random.between(0.25f, 2);
        question.beyond = random.between(0.5f, 3);
        const Float3 from = random.point(-1, 1);
        std::copy_n(&from.x, 3, question.from);
    }
    std::vector<BeamAnswer> answers(probe.lanes);
    probe.ask(job, has_doubts, questions.data(), answers.data());
    const std::uint32_t all_rays = (1u << probe.lanes) - 1u;
    for (const BeamAnswer& answer : answers) {
        ++asked.answered;
        asked.sure += answer.left || answer.right ? 1 : 0;
        asked.wrong +=
            (answer.left && answer.lefts != all_rays) || (answer.right && (answer.lefts | answer.ties) != 0) ? 1 : 0;
    }
}

/// 400,000 questions, whatever the width.
Asked ask_many(const BeamProbe& probe, bool has_doubts)
{
    Random random(0xBEA5);
    Asked asked;
    while (asked.answered < 400'000)
        ask(probe, random, has_doubts, asked);
    return asked;
}

/// Of each width, skipped where it is missing.
class Beams : public PacketWidths {};

} // namespace

TETRACE_EACH_PACKET_WIDTH(Beams);

TEST_P(Beams, are_sure_of_a_side_only_where_all_their_rays_have_it)
{
    const Asked asked = ask_many(probe_of(GetParam()), true);
    EXPECT_EQ(asked.wrong, 0u);
    EXPECT_GT(asked.sure, asked.answered / 4);
    EXPECT_LT(asked.sure, asked.answered);
}

TEST_P(Beams, without_doubts_are_sure_of_wrong_sides)
{
    EXPECT_GT(ask_many(probe_of(GetParam()), false).wrong, 0u);
}

TEST_P(Beams, take_the_ways_of_all_their_rays)
{
    const BeamProbe& probe = probe_of(GetParam());
    const DeviceRays scene(make_cubes(4), Layout::half32);
    for (const auto& from : {scene.from_outside(image_size, image_size), scene.from_inside(image_size, image_size)}) {
        const PacketJob job = job_of(scene.packed(), from);
        KernelId scalar{.method = Method::project, .layout = Layout::half32};
        const auto hits = traced(*openmp_backend().open(0, scalar, scene.data(), {.threads = 1}), from);
        std::uint32_t begun = 0, ended = 0, asked = 0;
        std::vector<BeamEnd> ends(probe.count);
        for (std::uint32_t rows = 0; rows < image_size; rows += probe.count * probe.lanes / image_size) {
            probe.walk(job, rows, ends.data());
            for (const BeamEnd& end : ends) {
                ++asked;
                begun += end.record != NO_HALF_FACE ? 1 : 0;
                ended += end.has_ended ? 1 : 0;
                for (std::uint32_t lane = 0; lane < probe.lanes && end.record != NO_HALF_FACE; ++lane) {
                    const std::uint32_t x = end.x + lane % probe.packet_width, y = end.y + lane / probe.packet_width;
                    const Hit& hit = hits[y * image_size + x];
                    if (!end.has_ended) {
                        ASSERT_LE(end.steps, hit.steps);
                        continue;
                    }
                    ASSERT_EQ(end.steps, hit.steps);
                    ASSERT_EQ(end.record >> 2, hit.tet);
                    ASSERT_EQ(end.exit == NO_HALF_FACE ? NO_HIT : end.exit >> 2, hit.face_id);
                }
            }
        }
        EXPECT_GT(begun, asked / 4);
        EXPECT_GT(ended, asked / 100); // few of those that are wide
    }
}
