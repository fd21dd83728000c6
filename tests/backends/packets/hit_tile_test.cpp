#include "backends/openmp/packet_session.h"

#include <gtest/gtest.h>

#include <vector>

namespace tetrace::openmp {
namespace {

constexpr Hit untouched = {7, 7, 7, 7, 7, 7};

// Another hit for each pixel.
Hit hit_at(std::uint32_t x, std::uint32_t y)
{
    return {x, y, static_cast<float>(x), static_cast<float>(y), 0.5F, x + y};
}

void expect_equal(const Hit& a, const Hit& b, std::size_t index)
{
    EXPECT_TRUE(a.face_id == b.face_id && a.tet == b.tet && a.t == b.t && a.u == b.u && a.v == b.v &&
                a.steps == b.steps)
        << "hit " << index;
}

// An image that begins `shift` hits after the start of its memory, so that its rows begin anywhere in a cache line,
// with untouched hits before and after it.
void store_image(std::uint32_t width, std::uint32_t height, std::size_t shift)
{
    SCOPED_TRACE(testing::Message() << width << " x " << height << ", shifted by " << shift);
    const std::size_t pixels = std::size_t{width} * height;
    std::vector<Hit> memory(pixels + 2 * shift, untouched);
    {
        HitTile tile(std::span<Hit>(memory).subspan(shift, pixels), width, height);
        for (std::uint32_t y = 0; y < height; y += packet_block_size)
            for (std::uint32_t x = 0; x < width; x += packet_block_size) {
                for (std::uint32_t i = 0; i < tile.hits().size(); ++i)
                    tile.hits()[i] = hit_at(x + i % packet_block_size, y + i / packet_block_size);
                tile.store(x, y);
            }
    }
    for (std::size_t i = 0; i < memory.size(); ++i) {
        const std::size_t pixel = i - shift;
        const bool is_in_image = i >= shift && pixel < pixels;
        expect_equal(memory[i],
                     is_in_image
                         ? hit_at(static_cast<std::uint32_t>(pixel % width), static_cast<std::uint32_t>(pixel / width))
                         : untouched,
                     i);
    }
}

TEST(HitTile, fills_its_image_wherever_rows_begin_in_a_cache_line_and_nothing_else)
{
    for (std::size_t shift = 1; shift <= 8; ++shift)
        for (const std::uint32_t width : {1U, 2U, 3U, 31U, 32U, 33U, 64U, 101U})
            store_image(width, 35, shift);
}

} // namespace
} // namespace tetrace::openmp
