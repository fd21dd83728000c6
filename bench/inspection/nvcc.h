#pragma once

#include "bench/inspection/inspected.h"

#include <cstdint>
#include <filesystem>
#include <map>
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

/// NVIDIA's compiler; not usable if the reason is not empty.
struct Nvcc {
    std::filesystem::path program;
    std::filesystem::path disassembler; ///< nvdisasm; empty: not installed
    std::string version;                ///< "nvcc 13.0"
    std::vector<std::string> targets;   ///< "sm_75", ... that it supports
    std::string reason;                 ///< why it cannot be used, with the package to install
};

/// Looks along PATH, in $CUDA_PATH and $CUDA_HOME, and in the toolkits' usual folders.
[[nodiscard]] Nvcc find_nvcc();

/// Compiles each kernel of the entry points once for an NVIDIA target, with the flags of the build. All rows are
/// skipped if nvcc is missing or does not support the target; those of a kernel that does not compile are errors. code:
/// as in ask_null_hardware(): PTX, and machine code if there is a disassembler. text: replaces that of the entry
/// points' one kernel; empty: nothing is replaced.
[[nodiscard]] std::vector<Inspected> ask_nvcc(const Nvcc& nvcc, const Target& target,
                                              const std::vector<EntryPoint>& points, const std::filesystem::path& code,
                                              const PartDone& tell, const std::string& text = {});

/// What `ptxas -v` reports for an entry.
struct PtxasReport {
    std::uint64_t registers = 0, stack_bytes = 0, spill_store_bytes = 0, spill_load_bytes = 0;
};

/// The reports in ptxas's messages, by entry.
[[nodiscard]] std::map<std::string, PtxasReport> read_ptxas(const std::string& messages);

} // namespace tetrace
