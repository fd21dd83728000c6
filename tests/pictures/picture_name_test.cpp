#include "bench/pictures/images.h"

#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

const PictureKey key{"bunny", 3, Picture::steps};

} // namespace

TEST(PicturePath, a_single_picture_has_the_name_that_was_given)
{
    EXPECT_EQ(picture_path("/none/a.exr", key, ".exr", true), "/none/a.exr");
}

TEST(PicturePath, several_pictures_have_their_distinction_before_the_ending)
{
    EXPECT_EQ(picture_path("/none/a.exr", key, ".exr", false), "/none/a-bunny-3-steps.exr");
}

TEST(PicturePath, a_folder_gets_the_default_name)
{
    EXPECT_EQ(picture_path("/tmp", key, ".ppm", true), "/tmp/bunny-3-steps.ppm");
    EXPECT_EQ(picture_path(std::nullopt, key, ".png", false), "bunny-3-steps.png");
}

TEST(PictureEnding, is_that_of_the_file_else_what_can_be_written)
{
    EXPECT_EQ(picture_ending("/none/a.exr", false), ".exr");
    EXPECT_EQ(picture_ending("/tmp", true), ".png");
    EXPECT_EQ(picture_ending("/tmp", false), ".ppm");
    EXPECT_EQ(picture_ending(std::nullopt, false), ".ppm");
}

TEST(CheckPictureEnding, refuses_hits_in_anything_but_an_exr)
{
    const std::vector<Picture> pictures{Picture::normals, Picture::hits};
    EXPECT_NO_THROW(check_picture_ending(std::nullopt, pictures));
    EXPECT_NO_THROW(check_picture_ending("/tmp", pictures));
    EXPECT_NO_THROW(check_picture_ending("a.exr", pictures));
    for (const char* const other : {"a.png", "a.ppm"})
        EXPECT_EQ(error_of([&] { check_picture_ending(other, pictures); }),
                  fmt::format("usage: --out '{}': --picture hits is written as .exr only; name a file that ends in "
                              ".exr, or a folder that is there",
                              other));
}

TEST(CheckPictureEnding, refuses_other_forms_and_names_the_accepted_ones)
{
    EXPECT_NO_THROW(check_picture_ending(std::nullopt, {}));
    EXPECT_NO_THROW(check_picture_ending("/tmp", {}));
    EXPECT_NO_THROW(check_picture_ending("a.png", {}));
    EXPECT_NO_THROW(check_picture_ending("a.ppm", {}));
    try {
        check_picture_ending("a.jpg", {});
        FAIL() << "accepted a.jpg";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find(".png, .exr or .ppm"), std::string::npos);
    }
}
