#include "backends/embedded.h"

#include "core/error.h"

#include <zlib.h>

namespace tetrace {

namespace {

bool unpack(std::span<const unsigned char> packed, std::span<std::byte> bytes)
{
    constexpr int gzip_windows = 15 + 16;
    z_stream stream{};
    if (inflateInit2(&stream, gzip_windows) != Z_OK) return false;
    stream.next_in = const_cast<unsigned char*>(packed.data()); // zlib reads it only
    stream.avail_in = static_cast<unsigned>(packed.size());
    stream.next_out = reinterpret_cast<unsigned char*>(bytes.data());
    stream.avail_out = static_cast<unsigned>(bytes.size());
    const int result = inflate(&stream, Z_FINISH);
    const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    return whole;
}

} // namespace

UnpackedKernels::UnpackedKernels(std::span<const PackedKernel> packed)
{
    for (const PackedKernel& kernel : packed) {
        auto& bytes = storage_.emplace_back(kernel.length + 1); // the closing 0
        if (!unpack(kernel.bytes, std::span(bytes).first(kernel.length)))
            throw Error(ErrorKind::internal, "the embedded kernel " + std::string(kernel.name) + " cannot be unpacked");
        list_.push_back({kernel.name, std::span(bytes).first(kernel.length)});
    }
}

} // namespace tetrace
