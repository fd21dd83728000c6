#pragma once

#include "backends/cuda_host/shim.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace tetrace::cuda_host {

/// A thread's place in its launch.
struct Place {
    Dimensions thread, block, block_size;
};

/// An entry point compiled for the host: runs the thread of a place. arguments: the address of each argument, as in a
/// launch.
using Entry = void (*)(const Place& place, void** arguments);

struct CompiledEntry {
    const char* name; ///< "trace_tiles_maria_tet80_exact"
    Entry entry;
};

/// Every entry point of this build; CMake compiles kernel.cpp and probe.cpp once for each kernel.
[[nodiscard]] const std::vector<CompiledEntry>& compiled_entries();

/// A kernel's arguments taken from their addresses.
template <class... Arguments, std::size_t... Positions>
void call(void (*kernel)(Arguments...), void** arguments, std::index_sequence<Positions...>)
{
    kernel(*static_cast<const Arguments*>(arguments[Positions])...);
}

template <class... Arguments>
void call(void (*kernel)(Arguments...), const Place& place, [[maybe_unused]] void** arguments)
{
    current_thread = place.thread;
    current_block = place.block;
    block_size = place.block_size;
    call(kernel, arguments, std::index_sequence_for<Arguments...>{});
}

} // namespace tetrace::cuda_host
