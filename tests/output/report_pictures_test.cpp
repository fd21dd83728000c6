// Pictures are in the page itself, byte for byte.
#include "bench/report/html/html.h"
#include "tests/output/report_fixture.h"

#include <string>

using namespace tetrace;
using namespace tetrace::test;

TEST_F(ReportPage, pictures_are_in_the_page_byte_for_byte)
{
    write_file(folder_ / "bunny-0-normals.png", white_pixel);
    const std::string page = page_of({bench_json()}, {folder_ / "bunny-0-normals.png"});
    EXPECT_TRUE(contains(page, "data:image/png;base64," + base64(white_pixel)));
    json result = reproduce_json();
    result["tetrace"]["figures"][0]["pictures"] = {"bunny-0-normals.png"};
    EXPECT_TRUE(contains(section_of(page_of({result}), "paper"), base64(white_pixel))) << "relative to the result";
}

TEST_F(ReportPage, a_named_picture_that_is_missing_is_a_sentence_and_one_asked_for_an_error)
{
    json result = reproduce_json();
    result["tetrace"]["figures"][0]["pictures"] = {"none.png"};
    const std::string paper = section_of(page_of({result}), "paper");
    EXPECT_TRUE(
        contains(paper, "The picture &apos;none.png&apos;, which the result names, is not shown: the file does not"));
    EXPECT_TRUE(contains(error_of_page(bench_json(), {folder_ / "none.png"}), "missing: reading the picture"));
}

TEST(Base64, is_that_of_the_standards_examples)
{
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}
