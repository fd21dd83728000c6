#pragma once

#include "backends/openmp/packets.h"

#include <cstdint>

namespace tetrace::test {

/// An edge that nearly meets one ray of a beam.
struct BeamQuestion {
    std::uint32_t x, y;  ///< the beam's first pixel
    std::uint32_t ray;   ///< of the beam, by its lane
    float from[3];       ///< one end of the edge
    float along, beyond; ///< of the place on the ray that the edge meets, were it not cut off at the domain: its ray
                         ///< parameter, and how many times as far away the edge's other end is
};

/// What a beam is sure of at an edge, and what all its rays have there: a bit a ray.
struct BeamAnswer {
    bool left, right;
    std::uint32_t lefts, ties;
};

/// How far the beam of a packet has come: see Packets of beams.h.
struct BeamEnd {
    std::uint32_t x, y, record, exit, steps;
    bool has_ended;
};

/// The beams of packets of one width (beam_probe.cpp, which may be compiled for another processor than the test).
struct BeamProbe {
    unsigned lanes;
    std::uint32_t packet_width, packet_height;
    /// Asks as many beams as there are lanes, a question each. has_doubts: whether they allow for rounding.
    void (*ask)(const openmp::PacketJob& job, bool has_doubts, const BeamQuestion* questions, BeamAnswer* answers);
    /// Walks as many beams as a block of pixels has, row after row of the image's whole width from row y on.
    void (*walk)(const openmp::PacketJob& job, std::uint32_t y, BeamEnd* ends);
    std::uint32_t count; ///< of those beams
};
// At no address where the build leaves that width out.
extern "C" {
extern const BeamProbe tetrace_beam_probe_4;
[[gnu::weak]] extern const BeamProbe tetrace_beam_probe_8;
[[gnu::weak]] extern const BeamProbe tetrace_beam_probe_16;
}

} // namespace tetrace::test
