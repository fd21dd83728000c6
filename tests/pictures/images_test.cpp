#include "bench/pictures/images.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

using namespace tetrace;
using namespace tetrace::test;

namespace {

bool process_has_openimageio()
{
    return contains(read_text("/proc/self/maps"), "libOpenImageIO");
}

} // namespace

TEST(Images, a_missing_module_names_the_package)
{
    const TemporaryFolder folder;
    const auto module = folder / "tetrace_images.so";
    const std::string error = error_of([&] { const ImageEncoder encoder(module); });
    EXPECT_TRUE(error.starts_with("missing: ")) << error;
    EXPECT_TRUE(contains(error, "libopenimageio-dev"));
    EXPECT_TRUE(contains(error, module.string()));
}

TEST(Images, a_module_that_is_no_library_is_refused)
{
    const TemporaryFolder folder;
    const auto module = folder / "tetrace_images.so";
    write_file(module, "not a shared object");
    EXPECT_TRUE(contains(error_of([&] { const ImageEncoder encoder(module); }), "libopenimageio-dev"));
}

TEST(Images, openimageio_is_loaded_by_the_first_picture_and_not_before)
{
    EXPECT_FALSE(process_has_openimageio()) << "what measures must not link the images module's libraries";
    try {
        const ImageEncoder encoder;
        EXPECT_TRUE(process_has_openimageio());
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();
    }
}
