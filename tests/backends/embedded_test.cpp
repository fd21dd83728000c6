#include "backends/embedded.h"

#include "core/base/error.h"

#include <gtest/gtest.h>
#include <lzma.h>

using namespace tetrace;

namespace {

std::vector<unsigned char> packed_by_xz(std::string_view text)
{
    std::vector<unsigned char> stream(lzma_stream_buffer_bound(text.size()));
    std::size_t length = 0;
    EXPECT_EQ(lzma_easy_buffer_encode(6, LZMA_CHECK_CRC64, nullptr, reinterpret_cast<const unsigned char*>(text.data()),
                                      text.size(), stream.data(), &length, stream.size()),
              LZMA_OK);
    stream.resize(length);
    return stream;
}

std::string rejection(std::span<const unsigned char> stream, std::size_t length)
{
    const PackedKernel packed[] = {{"maria", length}};
    try {
        const UnpackedKernels kernels(packed, stream);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::internal);
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST(Embedded, kernels_are_unpacked_under_their_names_followed_by_a_0)
{
    const auto stream = packed_by_xz("void first() {}void third() {}");
    const PackedKernel packed[] = {{"first", 15}, {"second", 0}, {"third", 15}};
    const UnpackedKernels kernels(packed, stream);
    ASSERT_EQ(kernels.list().size(), 3u);
    const EmbeddedKernel* kernel = find_kernel(kernels.list(), "first");
    ASSERT_NE(kernel, nullptr);
    EXPECT_EQ(kernel->text(), "void first() {}");
    EXPECT_STREQ(kernel->text().data(), "void first() {}");
    EXPECT_EQ(find_kernel(kernels.list(), "second")->text(), "");
    EXPECT_EQ(find_kernel(kernels.list(), "third")->text(), "void third() {}");
    EXPECT_EQ(find_kernel(kernels.list(), "fourth"), nullptr);
}

TEST(Embedded, a_stream_that_is_not_xzs_or_of_another_length_is_an_error_that_says_so)
{
    const auto stream = packed_by_xz("void first() {}");
    EXPECT_EQ(rejection(stream, 15), "accepted");
    for (const std::size_t length : {std::size_t{14}, std::size_t{16}})
        EXPECT_NE(rejection(stream, length).find("cannot be unpacked"), std::string::npos) << length;
    EXPECT_NE(rejection(std::span(stream).first(stream.size() - 1), 15), "accepted");
    EXPECT_NE(rejection(std::span(stream).subspan(1), 15), "accepted");
    auto damaged = stream;
    damaged[damaged.size() / 2] ^= 0x10;
    EXPECT_NE(rejection(damaged, 15), "accepted");
}
