#include "backends/embedded.h"

#include "core/error.h"

#include <gtest/gtest.h>
#include <zlib.h>

using namespace tetrace;

namespace {

std::vector<unsigned char> gzipped(std::string_view text)
{
    std::vector<unsigned char> packed(text.size() + 64);
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
    stream.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<unsigned>(text.size());
    stream.next_out = packed.data();
    stream.avail_out = static_cast<unsigned>(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::string rejection(std::span<const unsigned char> bytes, std::size_t length)
{
    const PackedKernel packed[] = {{"maria", bytes, length}};
    try {
        const UnpackedKernels kernels(packed);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::internal);
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST(embedded, kernels_are_unpacked_under_their_names_with_a_0_behind_them)
{
    const auto first = gzipped("void first() {}"), second = gzipped("");
    const PackedKernel packed[] = {{"first", first, 15}, {"second", second, 0}};
    const UnpackedKernels kernels(packed);
    ASSERT_EQ(kernels.list().size(), 2u);
    const EmbeddedKernel* kernel = find_kernel(kernels.list(), "first");
    ASSERT_NE(kernel, nullptr);
    EXPECT_EQ(kernel->text(), "void first() {}");
    EXPECT_STREQ(kernel->text().data(), "void first() {}");
    EXPECT_EQ(find_kernel(kernels.list(), "second")->text(), "");
    EXPECT_EQ(find_kernel(kernels.list(), "third"), nullptr);
}

TEST(embedded, bytes_that_are_not_gzips_or_of_another_length_are_an_error_that_names_the_kernel)
{
    const auto packed = gzipped("void first() {}");
    EXPECT_EQ(rejection(packed, 15), "accepted");
    for (const std::size_t length : {std::size_t{14}, std::size_t{16}})
        EXPECT_EQ(rejection(packed, length), "the embedded kernel maria cannot be unpacked") << length;
    EXPECT_NE(rejection(std::span(packed).first(packed.size() - 1), 15), "accepted");
    EXPECT_NE(rejection(std::span(packed).subspan(1), 15), "accepted");
}
