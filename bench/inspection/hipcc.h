#pragma once

#include "bench/inspection/inspected.h"

#include <filesystem>
#include <string>

namespace tetrace {

/// AMD's compiler of HIP; not usable if the reason is not empty.
struct Hipcc {
    std::filesystem::path program;
    std::string version; ///< "hipcc 5.2, clang 15.0"
    std::string reason;  ///< why it cannot be used, with the package to install
};

/// Looks along PATH, in $ROCM_PATH and in ROCm's usual folder.
[[nodiscard]] Hipcc find_hipcc();

/// Compiles each kernel of the entry points once for an AMD target, hip:gfx90a, as CUDA C++ with names for what HIP
/// calls otherwise; nothing of it can run. All rows are skipped if hipcc is missing or does not know the target; those
/// of a kernel that does not compile are errors. code: as in ask_null_hardware(): AMD's assembly. text: as
/// in ask_nvcc().
[[nodiscard]] std::vector<Inspected> ask_hipcc(const Hipcc& hipcc, const Target& target,
                                               const std::vector<EntryPoint>& points, const std::filesystem::path& code,
                                               const PartDone& tell, const std::string& text = {});

} // namespace tetrace
