#include "bench/pictures/images.h"

#include "core/base/error.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <string>

using namespace tetrace;

namespace {

/// A folder of the test's own, removed at its end.
class Images : public testing::Test {
protected:
    void SetUp() override
    {
        std::string name = (std::filesystem::temp_directory_path() / "tetrace-images-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

bool process_has_openimageio()
{
    std::ifstream maps("/proc/self/maps");
    const std::string text{std::istreambuf_iterator<char>(maps), {}};
    return text.find("libOpenImageIO") != std::string::npos;
}

std::string message_of(const std::function<void()>& action)
{
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

} // namespace

TEST_F(Images, a_missing_module_names_the_package)
{
    const auto module = folder_ / "tetrace_images.so";
    try {
        const ImageWriter writer(module);
        FAIL() << "loaded a module that is not there";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::missing);
        EXPECT_NE(std::string(error.what()).find("libopenimageio-dev"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(module.string()), std::string::npos) << error.what();
    }
}

TEST_F(Images, a_module_that_is_no_library_is_refused)
{
    const auto module = folder_ / "tetrace_images.so";
    std::ofstream(module) << "not a shared object";
    EXPECT_NE(message_of([&] { const ImageWriter writer(module); }).find("libopenimageio-dev"), std::string::npos);
}

TEST_F(Images, openimageio_is_loaded_by_the_first_picture_and_not_before)
{
    EXPECT_FALSE(process_has_openimageio()) << "what measures must not link the images module's libraries";
    try {
        const ImageWriter writer;
        EXPECT_TRUE(process_has_openimageio());
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();
    }
}
