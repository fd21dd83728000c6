#include "bench/inspection/hipcc.h"

#include "backends/cuda/driver_backend.h"
#include "bench/inspection/compiler.h"
#include "bench/inspection/work_folder.h"
#include "core/base/files.h"
#include "core/base/printable.h"
#include "core/device/launch.h"
#include "core/device/session.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <regex>

namespace tetrace {

namespace {

namespace fs = std::filesystem;

/// What a kernel's text needs of CUDA, by clang's own functions: no header and no library of ROCm, which lack the
/// newest chips in Debian. Subgroups of 64 vote by their first 32 lanes here: this text is for its code alone.
constexpr const char* prelude = R"(
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#define __shared__ __attribute__((shared))
struct uint2 { unsigned x, y; };
struct uint4 { unsigned x, y, z, w; };
#define COMPONENT(name, value) struct name { struct X { __device__ operator unsigned() const { return value; } } x; };
COMPONENT(BlockIndex, __builtin_amdgcn_workgroup_id_x())
COMPONENT(ThreadIndex, __builtin_amdgcn_workitem_id_x())
COMPONENT(BlockSize, __builtin_amdgcn_workgroup_size_x())
#define blockIdx BlockIndex()
#define threadIdx ThreadIndex()
#define blockDim BlockSize()
#define warpSize 32u
#define HIP_FN static inline __device__ __attribute__((always_inline))
HIP_FN uint2 make_uint2(unsigned x, unsigned y) { return {x, y}; }
HIP_FN uint4 make_uint4(unsigned x, unsigned y, unsigned z, unsigned w) { return {x, y, z, w}; }
template <class T> HIP_FN T __ldg(const T* from) { return *from; }
HIP_FN unsigned atomicAdd(unsigned* sum, unsigned added) { return __atomic_fetch_add(sum, added, __ATOMIC_RELAXED); }
HIP_FN float __uint_as_float(unsigned bits) { return __builtin_bit_cast(float, bits); }
HIP_FN unsigned __float_as_uint(float value) { return __builtin_bit_cast(unsigned, value); }
HIP_FN float __uint2float_rn(unsigned value) { return static_cast<float>(value); }
HIP_FN float sqrtf(float value) { return __builtin_sqrtf(value); }
HIP_FN float fabsf(float value) { return __builtin_fabsf(value); }
HIP_FN float fminf(float a, float b) { return __builtin_fminf(a, b); }
HIP_FN float fmaxf(float a, float b) { return __builtin_fmaxf(a, b); }
HIP_FN float __fmaf_rn(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
HIP_FN int __clz(int value) { return value == 0 ? 32 : __builtin_clz(static_cast<unsigned>(value)); }
HIP_FN int __popc(unsigned value) { return __builtin_popcount(value); }
HIP_FN unsigned __umulhi(unsigned a, unsigned b) { return static_cast<unsigned long>(a) * b >> 32; }
HIP_FN unsigned __activemask() { return static_cast<unsigned>(__builtin_amdgcn_read_exec()); }
HIP_FN unsigned __ballot_sync(unsigned, bool vote) { return static_cast<unsigned>(__builtin_amdgcn_uicmp(vote, 0u, 33)); }
HIP_FN unsigned __shfl_sync(unsigned, unsigned value, unsigned lane) { return __builtin_amdgcn_ds_bpermute(4 * lane, value); }
extern "C" __global__ void an_empty_kernel() {}
)";

/// What became of a kernel: the text of its code, or the reason why there is none.
struct HipCode {
    std::string text, reason;
};

HipCode compile_hip(const Hipcc& hipcc, const std::string& chip, const cuda::ProgramId& program,
                    const std::string& text)
{
    const EmbeddedKernel* const kernel = find_kernel(cuda::embedded_sources(), program.source);
    if (kernel == nullptr) return {{}, "this build lacks the source of " + program.source};
    const WorkFolder folder;
    const fs::path source = folder.path() / "kernel.hip", listing = folder.path() / "kernel.s";
    std::ofstream(source) << prelude << (text.empty() ? kernel->text() : std::string_view(text));
    const bool is_fast = program.math == MathMode::fast;
    const ChildOutcome outcome = run_compiler(
        hipcc.program,
        {"-x", "hip", "-std=c++17", "-O3", "-w", "-nogpuinc", "-nogpulib", "--offload-device-only", "-S",
         "--offload-arch=" + chip, is_fast ? "-ffast-math" : "-ffp-contract=off",
         is_fast ? "-fno-hip-fp32-correctly-rounded-divide-sqrt" : "-fhip-fp32-correctly-rounded-divide-sqrt",
         fmt::format("--gpu-max-threads-per-block={}", TILE_WIDTH * tile_height_of({})),
         "-DKERNEL_NAME=" + program.name(), "-o", listing.string(), source.string()});
    if (!succeeded(outcome)) return {{}, first_line(outcome.errors)};
    return {file_bytes(listing).value_or(""), {}};
}

/// The number that follows the words in an entry's part of a listing.
Inspected::Count number_after(const std::string& text, std::size_t from, const std::string& words)
{
    const std::size_t at = text.find(words, from);
    if (at == std::string::npos) return std::nullopt;
    return std::strtoull(text.c_str() + at + words.size(), nullptr, 10);
}

void take_hip(Inspected& row, const HipCode& code, const std::string& entry)
{
    const std::size_t end = code.text.find(".amdhsa_kernel " + entry + "\n");
    const std::size_t listed = code.text.find(".name:           " + entry + "\n");
    if (end == std::string::npos || listed == std::string::npos) {
        row.status = InspectedStatus::error;
        row.reason = code.reason.empty() ? "hipcc's listing lacks " + entry : code.reason;
        return;
    }
    row.registers = number_after(code.text, end, "; NumVgprs: ");
    row.scalar_registers = number_after(code.text, end, "; NumSgprs: ");
    row.scratch_bytes = number_after(code.text, end, "; ScratchSize: ");
    row.subgroups = number_after(code.text, end, "; Occupancy: ");
    row.code_bytes = number_after(code.text, end, "; codeLenInByte = ");
    row.max_subgroups = number_after(code.text, code.text.find(".amdhsa_kernel an_empty_kernel\n"), "; Occupancy: ");
    row.lanes = number_after(code.text, listed, ".wavefront_size: ");
    const auto vectors = number_after(code.text, listed, ".vgpr_spill_count: "),
               scalars = number_after(code.text, listed, ".sgpr_spill_count: ");
    if (vectors || scalars) row.spilled_registers = vectors.value_or(0) + scalars.value_or(0);
    const CodeFigures figures = read_hip(code.text, entry);
    row.instructions = figures.instructions;
    row.branches = figures.branches;
    row.loads = figures.loads;
    row.loads_in_loops = figures.loads_in_loops;
    row.fused = figures.fused;
    row.divisions = figures.divisions;
    row.first_fused = printable_line(figures.first_fused);
}

/// Without the prefix, which RADV's targets lack.
std::string chip_of(const Target& target)
{
    return target.name.substr(std::string(hip_prefix).size());
}

} // namespace

Hipcc find_hipcc()
{
    Hipcc hipcc;
    const char* const rocm = std::getenv("ROCM_PATH");
    hipcc.program = find_compiler("hipcc", {fs::path(rocm != nullptr ? rocm : "/opt/rocm") / "bin"});
    if (hipcc.program.empty()) {
        hipcc.reason = "AMD's compiler of HIP, hipcc, is missing; install ROCm's (Debian: hipcc)";
        return hipcc;
    }
    const ChildOutcome version = run_compiler(hipcc.program, {"--version"});
    std::smatch hip, clang;
    if (!succeeded(version) || !std::regex_search(version.out, hip, std::regex("HIP version: ([0-9]+\\.[0-9]+)")) ||
        !std::regex_search(version.out, clang, std::regex("clang version ([0-9]+\\.[0-9]+)")))
        hipcc.reason = hipcc.program.string() + " does not work: " + first_line(version.errors + version.out);
    else
        hipcc.version = fmt::format("hipcc {}, clang {}", hip[1].str(), clang[1].str());
    return hipcc;
}

std::vector<Inspected> ask_hipcc(const Hipcc& hipcc, const Target& target, const std::vector<EntryPoint>& points,
                                 const fs::path& code, const PartDone& tell, const std::string& text)
{
    if (!hipcc.reason.empty()) return unasked(target, points, hipcc.reason);
    std::map<std::string, HipCode> kernels;
    std::vector<Inspected> rows;
    for (const EntryPoint& point : points) {
        tell(static_cast<double>(rows.size()) / static_cast<double>(points.size()));
        const cuda::ProgramId program = cuda::program_of(point.kernel);
        auto found = kernels.find(program.name());
        if (found == kernels.end()) {
            found = kernels.emplace(program.name(), compile_hip(hipcc, chip_of(target), program, text)).first;
            if (found->second.reason.find("unsupported HIP gpu architecture") != std::string::npos ||
                found->second.reason.find("invalid target ID") != std::string::npos)
                return unasked(
                    target, points,
                    fmt::format("{} does not know {}: {}", hipcc.version, chip_of(target), found->second.reason));
            if (!code.empty() && found->second.reason.empty())
                write_whole(code / fmt::format("hip-{}-{}.s", chip_of(target), program.name()), found->second.text);
        }
        Inspected& row = rows.emplace_back();
        row.target = target;
        row.point = point;
        row.compiler = hipcc.version;
        take_hip(row, found->second, cuda::entry_name(point.kernel, point.entry == Entry::outside));
    }
    return rows;
}

} // namespace tetrace
