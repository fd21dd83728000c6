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
    std::span<const std::byte> bytes; ///< a 0 follows them, so that a text is a C string

    [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
};

/// A kernel in the packed stream in the program, which holds all kernels of a list one after the other.
struct PackedKernel {
    std::string_view name;
    std::size_t length; ///< of the unpacked kernel
};

/// Kernels unpacked, all at once: a list's first use takes some 50 ms.
/// stream: in xz's format. Throws Error{internal} if it is not, or its total length is another.
class UnpackedKernels {
public:
    UnpackedKernels(std::span<const PackedKernel> packed, std::span<const unsigned char> stream);
    [[nodiscard]] std::span<const EmbeddedKernel> list() const { return list_; }

private:
    std::vector<std::vector<std::byte>> storage_; ///< aligned by operator new, for callers that read words
    std::vector<EmbeddedKernel> list_;
};

/// The kernel of that name; null if there is none.
[[nodiscard]] inline const EmbeddedKernel* find_kernel(std::span<const EmbeddedKernel> kernels, std::string_view name)
{
    for (const EmbeddedKernel& kernel : kernels)
        if (kernel.name == name) return &kernel;
    return nullptr;
}

/// method_layout_math, for example "maria_tet80_exact": the name of an embedded kernel that is built once per math
/// mode; without the mode where it is an option of the device's compiler.
[[nodiscard]] inline std::string embedded_name(const KernelId& id)
{
    return std::string(name_of(id.method)).append("_").append(name_of(id.layout)).append("_").append(name_of(id.math));
}

} // namespace tetrace
