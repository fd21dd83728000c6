#pragma once

#include "core/backend.h"

namespace tetrace::openmp {

/// Traces all pixels of a job, tile after tile, into hits (row after row) on that many threads.
using TraceFunction = void (*)(const PackedScene& scene, const TraceJob& job, Hit* hits, unsigned threads,
                               unsigned tile_height);

/// One compiled kernel; CMake compiles kernel.cpp once for each.
struct CompiledKernel {
    KernelId id;
    TraceFunction trace;
};
[[nodiscard]] const std::vector<CompiledKernel>& compiled_kernels();

} // namespace tetrace::openmp
