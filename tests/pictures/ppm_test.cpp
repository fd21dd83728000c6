#include "bench/pictures/images.h"

#include <gtest/gtest.h>
#include <limits>

using namespace tetrace;

TEST(Ppm, has_a_header_and_three_bytes_a_pixel_row_after_row)
{
    Pixmap pixmap(2, 2);
    pixmap.at(1, 0) = from_srgb(0x336699);
    pixmap.at(0, 1) = from_srgb(0xFFFFFF);
    EXPECT_EQ(ppm_bytes(pixmap), std::string("P6\n2 2\n255\n\0\0\0\x33\x66\x99\xFF\xFF\xFF\0\0\0", 23));
}

TEST(Ppm, every_byte_survives_the_way_to_linear_light_and_back)
{
    for (std::uint32_t byte = 0; byte < 256; ++byte)
        EXPECT_EQ(to_srgb(from_srgb(byte).b), byte);
}

TEST(Ppm, light_outside_the_screens_range_is_clamped)
{
    EXPECT_EQ(to_srgb(-1.0f), 0);
    EXPECT_EQ(to_srgb(7.0f), 255);
    EXPECT_EQ(to_srgb(std::numeric_limits<float>::quiet_NaN()), 0);
}
