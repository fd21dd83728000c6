#pragma once

#include <cstdint>
#include <optional>

namespace tetrace {

/// How many warps are resident on an NVIDIA multiprocessor.
struct Warps {
    std::uint64_t resident = 0; ///< of a kernel
    std::uint64_t max = 0;      ///< of any
};

/// capability: 10 * major + minor. registers: of a thread. block: threads. shared_bytes: of a block. Empty for a
/// capability that is not known. Source: CUDA C++ Programming Guide, technical specifications per compute capability:
/// registers are allocated to warps in units of 256, and a warp's are in one of four parts of the multiprocessor's
/// 65,536; a block has a KiB of shared memory more than it asks for, from capability 8.0 on.
[[nodiscard]] std::optional<Warps> resident_warps(unsigned capability, std::uint64_t registers, std::uint64_t block,
                                                  std::uint64_t shared_bytes);

} // namespace tetrace
