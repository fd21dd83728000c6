#pragma once

#include "core/pack/kernel_id.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace tetrace {

/// What a device's compiler made of a kernel.
struct CompiledCode {
    std::string compiler;                     ///< driver with version, and the device that it compiled for
    unsigned lanes = 0;                       ///< of a subgroup
    std::map<std::string, double> statistics; ///< under the names that the compiler gives them
    std::string text;                         ///< the code, an instruction a line; empty where the driver tells none
};

/// A backend that can show what its compilers make of our kernels. The device need not be usable: compile_only is
/// enough.
class CodeSource {
public:
    virtual ~CodeSource() = default;
    /// kernel: without one, an empty kernel is compiled. starts_outside: of task trace, no ray starts in a tet.
    /// Throws Error{unsupported} where the driver tells nothing of its code, Error{internal} where it fails.
    [[nodiscard]] virtual CompiledCode compiled(std::size_t device, const std::optional<KernelId>& kernel,
                                                bool starts_outside) const = 0;
};

} // namespace tetrace
