#pragma once

#include "core/backend.h"

namespace tetrace::openmp {

/// Traces all pixels of a job, tile after tile, into hits (row after row) on that many threads.
using TraceFunction = void (*)(const PackedScene& scene, const TraceJob& job, Hit* hits, unsigned threads,
                               unsigned tile_height);

/// Searches the exits of a job's rays, whose rows are given, into faces, on that many threads.
using SearchFunction = void (*)(const PackedScene& scene, const Row* rays, const TraceJob& job, std::uint32_t* faces,
                                unsigned threads, unsigned tile_height);

/// One compiled kernel, as both tasks; CMake compiles kernel.cpp once for each.
struct CompiledKernel {
    KernelId id; ///< of task trace
    TraceFunction trace;
    SearchFunction search;
};
[[nodiscard]] const std::vector<CompiledKernel>& compiled_kernels();

} // namespace tetrace::openmp
