#pragma once

#include "bench/inspection/inspected.h"

#include <filesystem>
#include <map>

namespace tetrace {

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
/// as in ask_null_hardware(): PTX, and machine code if there is a disassembler.
[[nodiscard]] std::vector<Inspected> ask_nvcc(const Nvcc& nvcc, const Target& target,
                                              const std::vector<EntryPoint>& points, const std::filesystem::path& code,
                                              const PartDone& tell);

/// What `ptxas -v` reports for an entry.
struct PtxasReport {
    std::uint64_t registers = 0, stack_bytes = 0, spill_store_bytes = 0, spill_load_bytes = 0;
};

/// The reports in ptxas's messages, by entry.
[[nodiscard]] std::map<std::string, PtxasReport> read_ptxas(const std::string& messages);

} // namespace tetrace
