#include "backends/openmp/hit_tile.h"

#include <algorithm>
#include <cassert>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace tetrace::openmp {
namespace {

#ifdef __SSE2__
constexpr std::size_t line_bytes = 64;

void store_line(const std::byte* from, std::byte* to)
{
    for (std::size_t i = 0; i < line_bytes; i += sizeof(__m128i))
        _mm_stream_si128(reinterpret_cast<__m128i*>(to + i),
                         _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i)));
}

// Whole lines go past the caches, the parts of a line at both ends do not: past the caches each would be a write of its
// own.
void store_row(std::span<const Hit> row, Hit* to)
{
    const std::byte* from = std::as_bytes(row).data();
    const std::byte* const end = from + row.size_bytes();
    auto* at = reinterpret_cast<std::byte*>(to);
    const std::size_t before = (line_bytes - reinterpret_cast<std::uintptr_t>(at) % line_bytes) % line_bytes;
    const std::byte* const first_line = from + std::min(before, row.size_bytes());
    at = std::copy(from, first_line, at);
    for (from = first_line; end - from >= static_cast<std::ptrdiff_t>(line_bytes); from += line_bytes, at += line_bytes)
        store_line(from, at);
    std::copy(from, end, at);
}
#else
void store_row(std::span<const Hit> row, Hit* to)
{
    std::ranges::copy(row, to);
}
#endif

} // namespace

HitTile::HitTile(std::span<Hit> image, std::uint32_t width, std::uint32_t height)
    : image_(image), width_(width), height_(height)
{
    assert(image.size() == std::size_t{width} * height);
}

HitTile::~HitTile()
{
#ifdef __SSE2__
    _mm_sfence();
#endif
}

void HitTile::store(std::uint32_t x, std::uint32_t y) const
{
    const std::uint32_t columns = std::min(packet_block_size, width_ - x),
                        rows = std::min(packet_block_size, height_ - y);
    for (std::uint32_t row = 0; row < rows; ++row)
        store_row({hits_.data() + std::size_t{row} * packet_block_size, columns},
                  &image_[std::size_t{y + row} * width_ + x]);
}

} // namespace tetrace::openmp
