#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tetrace {

/// What the text of a program's code shows.
struct CodeFigures {
    std::uint64_t instructions = 0;
    std::uint64_t branches = 0;
    std::uint64_t loads = 0;          ///< instructions that load a lane's own data from memory
    std::uint64_t loads_in_loops = 0; ///< those that lie between the target of a backward branch and the branch
    std::uint64_t fused = 0;          ///< floating-point instructions that multiply and add with one rounding
    std::uint64_t divisions = 0; ///< that the next compiler turns into sequences with fused operations: PTX's div, sqrt
    std::uint64_t unrounded = 0; ///< of `fused`, those that the next compiler may fuse: they state no rounding
    std::string first_fused;     ///< the first of them, as the text has it
};

/// AMD's assembly as RADV writes it, or ACO's last form of a program. v_fma, v_fmac and their like are fused. v_mad_f32
/// and v_mac_f32 are not: they round the product, as separate instructions would, and only flush denormals
/// (docs/spec/numbers.md, N1: there are none). v_div_fmas belongs to a division, whose result decides nothing.
[[nodiscard]] CodeFigures read_amd(std::string_view text);

/// One entry of the assembly that clang writes for AMD's GPUs, as read_amd() reads RADV's. Each division is a sequence
/// that ends with v_div_fmas and has 5 fused operations (LLVM's lowering of fdiv to f32, correctly rounded): they
/// decide nothing and are not counted, unless the entry has fewer.
[[nodiscard]] CodeFigures read_hip(std::string_view text, const std::string& entry);

/// One entry of a PTX text. fused: fma and mad, and every sum, difference and product that states no rounding, since
/// ptxas may fuse only those (PTX ISA, add.f32). No instruction of PTX is one of the machine's: `instructions` is 0.
[[nodiscard]] CodeFigures read_ptx(std::string_view text, const std::string& entry);

/// One entry of what nvdisasm prints. Divisions and square roots are sequences with fused operations here, so `fused`
/// by itself proves nothing.
[[nodiscard]] CodeFigures read_sass(std::string_view text, const std::string& entry);

} // namespace tetrace
