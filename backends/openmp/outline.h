#pragma once

#include "backends/openmp/packets.h"

namespace tetrace::openmp {

/// Sets the job's outline from its lines and its origin: the edges of the domain between a side that the camera sees
/// and one that it does not. None for a camera inside.
void set_outline(PacketJob& job);

} // namespace tetrace::openmp
