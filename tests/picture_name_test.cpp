#include "bench/picture_name.h"

#include "core/error.h"

#include <gtest/gtest.h>

namespace tetrace {

namespace {

const PictureKey key{"bunny", 3, Picture::steps};

} // namespace

TEST(picture_path, a_single_picture_has_the_name_that_was_given)
{
    EXPECT_EQ(picture_path("/none/a.exr", key, true), "/none/a.exr");
}

TEST(picture_path, several_pictures_have_what_tells_them_apart_before_the_ending)
{
    EXPECT_EQ(picture_path("/none/a.exr", key, false), "/none/a-bunny-3-steps.exr");
}

TEST(picture_path, a_folder_gets_the_default_name)
{
    EXPECT_EQ(picture_path("/tmp", key, true), "/tmp/bunny-3-steps.png");
    EXPECT_EQ(picture_path(std::nullopt, key, false), "bunny-3-steps.png");
}

TEST(check_picture_ending, refuses_other_forms_and_names_the_accepted_ones)
{
    EXPECT_NO_THROW(check_picture_ending(std::nullopt));
    EXPECT_NO_THROW(check_picture_ending("/tmp"));
    EXPECT_NO_THROW(check_picture_ending("a.png"));
    try {
        check_picture_ending("a.jpg");
        FAIL() << "accepted a.jpg";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find(".png or .exr"), std::string::npos);
    }
}

} // namespace tetrace
