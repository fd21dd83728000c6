#include "bench/pictures/images.h"

#include "tests/support/temporary_folder.h"

#include <OpenImageIO/imageio.h>
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Three by two pixels, all different, so that a swapped axis or channel shows.
Pixmap sample()
{
    Pixmap pixmap(3, 2);
    pixmap.pixels = {{0, 0, 0}, {1, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.25f}, {0.125f, 0.0625f, 1}, {0.75f, 0.5f, 0.25f}};
    return pixmap;
}

std::vector<float> read_floats(const std::filesystem::path& path)
{
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input || input->spec().width != 3 || input->spec().height != 2 || input->spec().nchannels != 3) {
        return {};
    }
    std::vector<float> values(18);
    return input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, values.data()) ? values : std::vector<float>{};
}

float channel(const Pixmap& pixmap, std::size_t i)
{
    const Colour& colour = pixmap.pixels[i / 3];
    return i % 3 == 0 ? colour.r : i % 3 == 1 ? colour.g : colour.b;
}

double encode_srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// The module that the build made.
class ImagesModule : public testing::Test {
protected:
    [[nodiscard]] std::string refusal(const std::filesystem::path& path, const Pixmap& pixmap) const
    {
        const std::string error = error_of([&] { writer_.write(path, pixmap); });
        EXPECT_TRUE(error.starts_with("invalid_input: ")) << error;
        return error;
    }
    /// Writes the sample and reads it again: each value is what the format stores for it, within a tolerance.
    void expect_stored(const std::string& name, const std::function<double(double)>& stored, double tolerance) const
    {
        const Pixmap pixmap = sample();
        writer_.write(folder_ / name, pixmap);
        const auto values = read_floats(folder_ / name);
        ASSERT_EQ(values.size(), 18u);
        for (std::size_t i = 0; i < values.size(); ++i)
            EXPECT_NEAR(values[i], stored(channel(pixmap, i)), tolerance) << i;
    }

    TemporaryFolder folder_;
    PictureWriter writer_{".png"};
};

} // namespace

TEST_F(ImagesModule, png_comes_back_as_srgb_bytes)
{
    expect_stored("a.png", encode_srgb, 0.5 / 255 + 1e-6); // half of a byte's step
}

TEST_F(ImagesModule, exr_comes_back_as_linear_light)
{
    expect_stored(
        "a.exr", [](double linear) { return linear; }, 0); // all are halves
}

TEST_F(ImagesModule, colours_outside_the_screens_range_are_clamped)
{
    Pixmap pixmap(3, 2, {7.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()});
    writer_.write(folder_ / "a.png", pixmap);
    const auto values = read_floats(folder_ / "a.png");
    ASSERT_EQ(values.size(), 18u);
    EXPECT_EQ(values[0], 1.0f);
    EXPECT_EQ(values[1], 0.0f);
    EXPECT_EQ(values[2], 0.0f);
}

TEST_F(ImagesModule, a_missing_folder_is_an_error_with_the_file_name)
{
    const auto path = folder_ / "none/a.png";
    EXPECT_TRUE(contains(refusal(path, sample()), path.string()));
}

TEST_F(ImagesModule, other_endings_are_refused_with_the_accepted_ones)
{
    EXPECT_TRUE(contains(refusal(folder_ / "a.jpg", sample()), ".png or .exr"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.jpg"));
}

TEST_F(ImagesModule, an_empty_picture_is_refused)
{
    EXPECT_TRUE(contains(refusal(folder_ / "a.png", Pixmap{}), "the picture is empty"));
}
