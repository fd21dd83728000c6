// Traces a block of an image, or given rays, in packets of LANES rays: compiled once for each of 4, 8 and 16
// (CMakeLists.txt), the wider ones with instructions that few processors have. So nothing here may have external
// linkage but the entry point, and no inline function of a library may be called: the linker keeps one of all copies of
// such a one, and might keep this.
#include "backends/openmp/packets.h"
#include "kernels/layout.h"

#include <cstddef>
#include <cstdint>
#if LANES > 4
#include <immintrin.h>
#endif

namespace {

using tetrace::openmp::PacketJob;

#include "backends/openmp/packet/lanes.h"

#include "backends/openmp/packet/rays.h"

#include "backends/openmp/packet/walk.h"

#include "backends/openmp/packet/start.h"

#include "backends/openmp/packet/hits.h"

#include "backends/openmp/packet/shaft.h"

#include "backends/openmp/packet/given.h"

constexpr uint packets_at_once = 4;

// Lanes of several packets that have one deepest axis.
template <int z, uint count>
[[gnu::noinline]] void trace_lanes(const PacketJob& job, Packet* packets, const ByAxis* lanes)
{
    const bool is_outside = job.start_tet == NO_TET;
    Walk<z> walks[count];
    for (uint i = 0; i < count; i++) {
        walks[i].shear = shear_of<z>(packets[i].direction);
        walks[i].turn = walks[i].record = Words{};
        for (Seen& seen : walks[i].carried)
            seen = Seen{Floats{}, Floats{}};
        walks[i].live = 0;
        if (lanes[i].of[z] == 0) continue;
        if (is_outside)
            enter_domain(job, packets[i], walks[i], lanes[i].of[z]);
        else
            leave_start(job, packets[i], walks[i], lanes[i].of[z]);
    }
    walk_on<z, count>(job, packets, walks, is_outside ? 0 : 1);
}

// Packets whose first pixels are given.
template <uint count>
void trace_packets(const PacketJob& job, const uint* x, const uint* y)
{
    Packet packets[count];
    ByAxis lanes[count];
    uint any[3] = {};
    for (uint i = 0; i < count; i++) {
        make_rays(job, x[i], y[i], packets[i]);
        lanes[i] = by_deepest_axis(packets[i]);
        for (uint axis = 0; axis < 3; axis++)
            any[axis] |= lanes[i].of[axis];
    }
    if (any[0] != 0) trace_lanes<0, count>(job, packets, lanes);
    if (any[1] != 0) trace_lanes<1, count>(job, packets, lanes);
    if (any[2] != 0) trace_lanes<2, count>(job, packets, lanes);
    for (Packet& packet : packets)
        write_hits(job, packet, packet.lanes);
}

void trace_square(const PacketJob& job, const Square& square)
{
    uint x[packets_at_once], y[packets_at_once], count = 0;
    for (uint row = square.y; row < square.y_end; row += packet_height)
        for (uint column = square.x; column < square.x_end; column += packet_width) {
            x[count] = column;
            y[count] = row;
            if (++count < packets_at_once) continue;
            trace_packets<packets_at_once>(job, x, y);
            count = 0;
        }
    for (uint i = 0; i < count; i++)
        trace_packets<1>(job, x + i, y + i);
}

// Squares of pixels down to a size of 8, those that see nothing of the domain left out together.
template <uint size>
void trace_squares(const PacketJob& job, uint x, uint y)
{
    if (x >= job.width || y >= job.height) return;
    const Square square = square_at(job, x, y, size);
    if (misses_domain(job, square)) {
        write_misses(job, square.x, square.y, square.x_end, square.y_end);
    } else if constexpr (size <= 8) {
        trace_square(job, square);
    } else {
        constexpr uint half = size / 2;
        for (uint i = 0; i < 4; i++)
            trace_squares<half>(job, x + i % 2 * half, y + i / 2 * half);
    }
}

} // namespace

#define JOINED(prefix, lanes) prefix##lanes
#define ENTRY_POINT(prefix, lanes) JOINED(prefix, lanes)

extern "C" void tetrace::openmp::ENTRY_POINT(tetrace_trace_rays_, LANES)(const PacketJob& job)
{
    if (job.has_ends)
        trace_rays<true>(job);
    else
        trace_rays<false>(job);
}

extern "C" void tetrace::openmp::ENTRY_POINT(tetrace_trace_block_, LANES)(const PacketJob& job, std::uint32_t x,
                                                                          std::uint32_t y)
{
    trace_squares<tetrace::openmp::packet_block_size>(job, x, y);
}
