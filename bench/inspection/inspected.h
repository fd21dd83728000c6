#pragma once

#include "bench/inspection/machine_code.h"
#include "bench/options/options.h"
#include "core/device/backend.h"
#include "core/pack/kernel_id.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Whose compiler is asked: Mesa's RADV on null hardware; nvcc with ptxas; hipcc; or the driver of a device that is
/// here.
enum class Maker { amd, nvidia, hip, driver };

/// A target of hipcc is this and AMD's name of the chip.
inline constexpr const char* hip_prefix = "hip:";

/// A GPU that kernels are compiled for. It need not be here, unless its driver is asked.
struct Target {
    std::string
        name; ///< "gfx1100", "navi21", "sm_90", "hip:gfx90a"; of a driver's device as in rows: "cuda", "vulkan:1"
    Maker maker = Maker::amd;
    Backend* backend = nullptr; ///< of the driver's device
    std::size_t device = 0;     ///< its index
};

/// "sm_" and a number is NVIDIA's; "hip:" and a chip hipcc's; other lower-case letters and digits are AMD's.
/// Throws Error{usage} naming the option for anything else.
[[nodiscard]] Target parse_target(const std::string& option, const std::string& text);

/// The targets of those names, in their order and each once; without names, those that represent the generations.
[[nodiscard]] std::vector<Target> targets_of(const std::vector<std::string>& names);

/// The names of an AMD target that drivers may know, the user's first: Mesa 22.3 knows gfx906 as "vega20" only.
[[nodiscard]] std::vector<std::string> family_names(const std::string& target);

/// An entry point of a kernel. The kernel's task and schedule are the entry's.
struct EntryPoint {
    KernelId kernel;
    Entry entry = Entry::outside;
};

/// Every entry point of our kernels that the maker's GPUs may get, in the kernels' order. AMD's have no schedule
/// persistent: Vulkan lacks such kernels, and HIP's subgroups have another size. Not every driver's backend has all.
[[nodiscard]] std::vector<EntryPoint> all_entry_points(Maker maker);

/// Whether --structure, --method, --layout, --schedule, --math and --entry keep it. Defaults: as for rows, and math
/// mode exact.
[[nodiscard]] bool wants(const Options& options, const EntryPoint& point);

/// "outside", "rays", "inside persistent".
[[nodiscard]] std::string name_of(const EntryPoint& point);

/// What follows the target in the name of a file with an entry point's code: "-maria-tet80-exact-outside.s".
[[nodiscard]] std::string code_file_name(const EntryPoint& point);

/// Whether a program was compiled.
enum class InspectedStatus { ok, skipped, error };
template <>
inline constexpr auto enum_names<InspectedStatus> = names_up_to<InspectedStatus::error>("ok", "skipped", "error");

/// Where the fused operations are: none; only in the box tests of BVHs, which decide nothing (docs/spec/bvhs.md, B7);
/// where signs are decided, which exact mode forbids; or anywhere, in math mode fast.
enum class FusedIn { nothing, boxes, decisions, anything };
template <>
inline constexpr auto enum_names<FusedIn> = names_up_to<FusedIn::anything>("nothing", "boxes", "decisions", "anything");

/// A program: an entry point, compiled for a target. What its compiler does not report is empty.
struct Inspected {
    Target target;
    EntryPoint point;
    InspectedStatus status = InspectedStatus::ok;
    std::string reason;   ///< if it is not ok
    std::string compiler; ///< with version

    using Count = std::optional<std::uint64_t>;
    Count registers;         ///< per thread
    Count scalar_registers;  ///< per subgroup, on AMD
    Count spilled_registers; ///< AMD
    Count spill_store_bytes; ///< NVIDIA, per thread
    Count spill_load_bytes;  ///< NVIDIA, per thread
    Count scratch_bytes;     ///< memory per thread (NVIDIA) or subgroup (AMD) for what is not in registers
    Count lanes;             ///< threads per subgroup
    Count subgroups;         ///< resident on a SIMD (AMD) or multiprocessor (NVIDIA)
    Count max_subgroups;     ///< the same for an empty kernel
    Count code_bytes;
    Count instructions, branches, loads, loads_in_loops;
    std::optional<double> latency_cycles, cycles_a_subgroup; ///< ACO's estimates: latency, inverse throughput
    Count fused, divisions;                                  ///< as CodeFigures has them
    std::uint64_t unrounded = 0;                             ///< as CodeFigures has it
    std::string first_fused;
    Count sass_fused;                         ///< in NVIDIA's machine code, sequences of divisions included
    std::map<std::string, double> statistics; ///< of a driver, as CompiledCode has them

    [[nodiscard]] std::optional<double> occupancy() const
    {
        if (!subgroups || !max_subgroups || *max_subgroups == 0) return std::nullopt;
        return static_cast<double>(*subgroups) / static_cast<double>(*max_subgroups);
    }
    /// Whether any register went to memory.
    [[nodiscard]] bool spills() const
    {
        return spilled_registers.value_or(0) + spill_store_bytes.value_or(0) + spill_load_bytes.value_or(0) > 0;
    }
    [[nodiscard]] std::optional<FusedIn> fused_in() const
    {
        if (!fused) return std::nullopt;
        if (point.kernel.math == MathMode::fast) return FusedIn::anything;
        if (*fused == 0) return FusedIn::nothing;
        const bool stated = point.kernel.structure == Structure::bvh && unrounded == 0;
        return stated ? FusedIn::boxes : FusedIn::decisions;
    }
};

/// Sets the members of a row that a driver's statistics have, as Mesa 22.3 to 25, NVIDIA's Vulkan and backends/cuda
/// call them.
void take_statistics(Inspected& row, const std::map<std::string, double>& statistics);

/// Called with the part of a target's programs that is done, in [0, 1].
using PartDone = std::function<void(double)>;

/// The rows of a target that was not compiled for.
[[nodiscard]] inline std::vector<Inspected> unasked(const Target& target, const std::vector<EntryPoint>& points,
                                                    const std::string& reason)
{
    std::vector<Inspected> rows;
    for (const EntryPoint& point : points) {
        Inspected& row = rows.emplace_back();
        row.target = target;
        row.point = point;
        row.status = InspectedStatus::skipped;
        row.reason = reason;
    }
    return rows;
}

} // namespace tetrace
