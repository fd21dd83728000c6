#include "bench/report/png.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <zlib.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const std::string two_pixels("\x01\x02\x03\0\x0a\xff", 6);
const std::string ppm = "P6\n2 1\n255\n" + two_pixels;

/// The pixels of a PNG of one row, which its one IDAT chunk holds after the filter's byte.
std::string pixels_of(const Png& png)
{
    const std::size_t data = png.bytes.find("IDAT") + 4, end = png.bytes.size() - 12 - 4;
    std::string line(1 + std::size_t{3} * png.width, '\0');
    uLongf size = line.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(line.data()), &size,
                         reinterpret_cast<const Bytef*>(png.bytes.data() + data), end - data),
              Z_OK);
    return line.substr(1);
}

class ReportPicture : public testing::Test {
protected:
    std::string error_of_reading(const std::string& bytes)
    {
        write_file(folder_ / "a.png", bytes);
        return error_of([&] { static_cast<void>(read_picture(folder_ / "a.png")); });
    }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(ReportPicture, a_ppm_becomes_a_png_of_the_same_pixels)
{
    write_file(folder_ / "a.ppm", ppm);
    const Png png = read_picture(folder_ / "a.ppm");
    EXPECT_EQ(png.width, 2u);
    EXPECT_EQ(png.height, 1u);
    EXPECT_EQ(pixels_of(png), two_pixels);
    // As `zlib.crc32` of Python has the checksums of these two chunks.
    EXPECT_EQ(png.bytes.substr(0, 33),
              std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\1\x08\2\0\0\0\x7b\x40\xe8\xdd", 33));
    EXPECT_EQ(png.bytes.substr(png.bytes.size() - 12), std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12));
    write_file(folder_ / "a.png", png.bytes);
    EXPECT_EQ(read_picture(folder_ / "a.png").bytes, png.bytes) << "a PNG stays as it is";
}

TEST_F(ReportPicture, what_is_no_picture_is_named_with_the_reason)
{
    EXPECT_TRUE(contains(error_of_reading("P3 1 1 255 0 0 0 and more bytes than a head has"), "neither PNG nor PPM"));
    EXPECT_TRUE(contains(error_of_reading("\x89PNG\r\n\x1a\n"), "neither PNG nor PPM"));
    EXPECT_TRUE(contains(error_of_reading(ppm + "x"), "its data does not match its header's 2 x 1 pixels"));
    EXPECT_TRUE(contains(error_of_reading(ppm.substr(0, ppm.size() - 1)), "its data does not match its header's 2 x "
                                                                          "1 pixels"));
    for (const char* const bad : {"", "P6", "P6 1 1 255", "P6 0 1 255 ", "P6 -1 1 255 abc", "P6 1 1 65535 abcabc",
                                  "P6 1 1 255xabc", "P6 70000 1 255 abc", "P6 4294967297 1 255 abc"})
        EXPECT_TRUE(contains(error_of_reading(bad), "invalid_input: reading the picture")) << bad;
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(read_picture(folder_ / "none.png")); }), "missing: reading"));
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(read_picture(folder_.path())); }), "it is not a file"));
}

TEST_F(ReportPicture, a_named_one_is_shown_or_a_sentence)
{
    write_file(folder_ / "a.ppm", ppm);
    EXPECT_TRUE(contains(named_picture(folder_.path(), "a.ppm").str(), base64(read_picture(folder_ / "a.ppm").bytes)));
    write_file(folder_ / "cut.ppm", ppm.substr(0, 14));
    const std::string cut = named_picture(folder_.path(), "cut.ppm").str();
    EXPECT_TRUE(contains(cut, "&apos;cut.ppm&apos;, which the result names, is not shown: its data does not match"));
    EXPECT_FALSE(contains(cut, folder_.path().string()));
    EXPECT_FALSE(contains(cut, "<img"));
}
