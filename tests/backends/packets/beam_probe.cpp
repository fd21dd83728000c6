// The beams of packets of LANES rays for beams_test.cpp: compiled as packet/block.cpp is, and like it without inline
// functions of any library.
#include "tests/backends/packets/beam_probe.h"
#include "kernels/layouts/layout.h"

#include <cstddef>
#include <cstdint>
#if LANES > 4
#include <immintrin.h>
#endif

namespace {

using tetrace::openmp::Goal;
using tetrace::openmp::PacketJob;
using tetrace::test::BeamAnswer;
using tetrace::test::BeamEnd;
using tetrace::test::BeamQuestion;

#include "backends/openmp/packet/lanes.h"

#include "backends/openmp/packet/rays.h"

#include "backends/openmp/packet/walk.h"

#include "backends/openmp/packet/beams.h"

float within_domain(float place)
{
    return place < -1 ? -1 : place > 1 ? 1 : place;
}

bool has_lane(Mask mask, uint lane)
{
    return (lanes_of(mask) >> lane & 1u) != 0;
}

BeamAnswer ask_beam(const PacketJob& job, const Eye& eye, const BeamWalk& walk, uint lane, const BeamQuestion& question)
{
    Packet rays;
    make_rays(job, question.x, question.y, rays);
    Words p[3], q[3];
    for (uint axis = 0; axis < 3; ++axis) {
        const float from = question.from[axis];
        const float passed = job.origin[axis] + question.along * rays.direction[axis][question.ray];
        p[axis] = as_words(all(from));
        q[axis] = as_words(all(within_domain(from + question.beyond * (passed - from))));
    }
    const SureSides sure = sure_sides(imaged(job, eye, walk, p), imaged(job, eye, walk, q));
    const Shear<any_axis> shear = shear_of<any_axis>(rays.direction);
    const Sides sides = sides_of(seen_at(rays, shear, p), seen_at(rays, shear, q));
    return {has_lane(sure.left, lane), has_lane(sure.right, lane), lanes_of(sides.left), lanes_of(sides.tie)};
}

void ask_beams(const PacketJob& job, bool has_doubts, const BeamQuestion* questions, BeamAnswer* answers)
{
    Eye eye = eye_of(job);
    if (!has_doubts) eye.doubt = eye.min_doubt = Floats{};
    Packets packets;
    packets.count = LANES;
    for (uint i = 0; i < LANES; ++i) {
        packets.x[i] = questions[i].x;
        packets.y[i] = questions[i].y;
    }
    BeamWalk walk;
    aim(eye, packets, 0, walk);
    for (uint lane = 0; lane < LANES; ++lane)
        answers[lane] = ask_beam(job, eye, walk, lane, questions[lane]);
}

void walk_block(const PacketJob& job, std::uint32_t y, BeamEnd* ends)
{
    Packets packets;
    const uint across = job.width / packet_width;
    for (packets.count = 0; packets.count < max_packets; ++packets.count) {
        packets.x[packets.count] = packets.count % across * packet_width;
        packets.y[packets.count] = y + packets.count / across * packet_height;
    }
    walk_beams(job, packets);
    for (uint i = 0; i < packets.count; ++i)
        ends[i] = {packets.x[i],    packets.y[i],     packets.record[i],
                   packets.exit[i], packets.steps[i], packets.has_ended[i]};
}

} // namespace

#define JOINED(prefix, lanes) prefix##lanes
#define PROBE(prefix, lanes) JOINED(prefix, lanes)

constexpr tetrace::test::BeamProbe tetrace::test::PROBE(tetrace_beam_probe_, LANES) = {
    LANES, packet_width, packet_height, ask_beams, walk_block, max_packets};
