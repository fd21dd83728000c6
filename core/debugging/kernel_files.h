#pragma once

#include "core/pack/kernel_id.h"

#include <string>
#include <vector>

namespace tetrace {

/// A file for those who look into a kernel without this program.
struct KernelFile {
    std::string name;
    std::string what;    ///< what it is, and what else compiling it needs; without a full stop
    std::string command; ///< that makes or compiles it without tetrace; empty where there is none
    std::string bytes;
};

/// A backend that has its kernels as texts or code that a driver gets. No driver is loaded for them.
class KernelFileSource {
public:
    virtual ~KernelFileSource() = default;
    /// The files of a kernel of that method and layout, in its math mode, for all tasks. Empty where there is none.
    [[nodiscard]] virtual std::vector<KernelFile> kernel_files(const KernelId& kernel) const = 0;
};

} // namespace tetrace
