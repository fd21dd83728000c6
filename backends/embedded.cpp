#include "backends/embedded.h"

#include "core/base/error.h"

#include <lzma.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace tetrace {

namespace {

/// Throws Error{internal}.
std::vector<std::byte> unpack(std::span<const unsigned char> stream, std::size_t length)
{
    std::vector<std::byte> bytes(length);
    std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
    std::size_t read = 0, written = 0;
    const lzma_ret result =
        lzma_stream_buffer_decode(&memory, 0, nullptr, stream.data(), &read, stream.size(),
                                  reinterpret_cast<unsigned char*>(bytes.data()), &written, bytes.size());
    if (result != LZMA_OK || read != stream.size() || written != length)
        throw Error(ErrorKind::internal, "the embedded kernels cannot be unpacked: xz says " + std::to_string(result) +
                                             " after " + std::to_string(written) + " of " + std::to_string(length) +
                                             " bytes");
    return bytes;
}

} // namespace

UnpackedKernels::UnpackedKernels(std::span<const PackedKernel> packed, std::span<const unsigned char> stream)
{
    std::size_t length = 0;
    for (const PackedKernel& kernel : packed)
        length += kernel.length;
    const std::vector<std::byte> all = unpack(stream, length);
    auto next = all.begin();
    for (const PackedKernel& kernel : packed) {
        auto& bytes = storage_.emplace_back(kernel.length + 1); // the closing 0
        std::copy_n(next, kernel.length, bytes.begin());
        next += static_cast<std::ptrdiff_t>(kernel.length);
        list_.push_back({kernel.name, std::span(bytes).first(kernel.length)});
    }
}

} // namespace tetrace
