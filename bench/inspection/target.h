#pragma once

#include <string>
#include <vector>

namespace tetrace {

/// Whose compiler is asked: Mesa's RADV on null hardware, or nvcc with ptxas.
enum class Maker { amd, nvidia };

/// A GPU that kernels are compiled for. It need not be here.
struct Target {
    std::string name; ///< "gfx1100", "navi21", "sm_90"
    Maker maker = Maker::amd;
};

/// "sm_" and a number is NVIDIA's; other lower-case letters and digits are AMD's.
/// Throws Error{usage} naming the option for anything else.
[[nodiscard]] Target parse_target(const std::string& option, const std::string& text);

/// The targets of those names, in their order and each once; without names, those that represent the generations.
[[nodiscard]] std::vector<Target> targets_of(const std::vector<std::string>& names);

/// The names of an AMD target that drivers may know, the user's first: Mesa 22.3 knows gfx906 as "vega20" only.
[[nodiscard]] std::vector<std::string> family_names(const std::string& target);

} // namespace tetrace
