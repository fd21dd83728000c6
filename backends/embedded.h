#pragma once

#include "core/pack/kernel_id.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// A kernel's text or code as the build embeds it (cmake/Kernels.cmake).
struct EmbeddedKernel {
    std::string_view name;
    std::span<const std::byte> bytes; ///< a 0 stands behind them, so that a text is a C string

    [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
};

/// A kernel in the packed stream that the program carries, in which all of a list stand one behind the other.
struct PackedKernel {
    std::string_view name;
    std::size_t length; ///< of what it unpacks to
};

/// Kernels unpacked, all at once: a list's first use takes some 50 ms.
/// stream: xz's. Throws Error{internal} where its bytes are not xz's, or not of that length in all.
class UnpackedKernels {
public:
    UnpackedKernels(std::span<const PackedKernel> packed, std::span<const unsigned char> stream);
    [[nodiscard]] std::span<const EmbeddedKernel> list() const { return list_; }

private:
    std::vector<std::vector<std::byte>> storage_; ///< aligned by operator new, for those who read words
    std::vector<EmbeddedKernel> list_;
};

/// The kernel of that name; null where there is none.
[[nodiscard]] inline const EmbeddedKernel* find_kernel(std::span<const EmbeddedKernel> kernels, std::string_view name)
{
    for (const EmbeddedKernel& kernel : kernels)
        if (kernel.name == name) return &kernel;
    return nullptr;
}

/// method_layout_math, for example "maria_tet80_exact": how embedded kernels are called where a math mode is a build of
/// its own; without the mode where it is an option of the device's compiler.
[[nodiscard]] inline std::string embedded_name(const KernelId& id)
{
    return std::string(name_of(id.method)).append("_").append(name_of(id.layout)).append("_").append(name_of(id.math));
}

} // namespace tetrace
