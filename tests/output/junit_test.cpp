#include "bench/output/junit.h"

#include "bench/measuring/verify.h"
#include "bench/terminal/text.h"
#include "scenes/procedural.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

RowRun skipped_row(const std::string& reason)
{
    RowRun row;
    row.key = {"cubes", "other", {}};
    row.device.name = "a device <of & \"quotes\">";
    row.outcome = Skipped{Status::unsupported, reason};
    return row;
}

/// Python's parser, where it is installed, says whether the text is XML.
void expect_well_formed(const std::string& xml)
{
    const TemporaryFolder folder;
    write_file(folder / "result.xml", xml);
    if (std::system("python3 -c 'import xml.dom.minidom' 2> /dev/null") != 0)
        GTEST_SKIP() << "python3 is not installed (package python3), so nothing reads the XML";
    const std::string command = "python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' " +
                                (folder / "result.xml").string();
    EXPECT_EQ(std::system(command.c_str()), 0) << xml;
}

} // namespace

TEST(Junit, texts_are_escaped_and_what_xml_cannot_hold_is_replaced)
{
    EXPECT_EQ(xml_text("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &apos;d&apos;");
    EXPECT_EQ(xml_text(std::string("\x1b[1m\0", 5)), "?[1m?");
    EXPECT_EQ(xml_text("Gr\xc3\xb6\xc3\x9f"
                       "e \xe2\x82\xac \xf0\x9f\x90\xb0"),
              "Gr\xc3\xb6\xc3\x9f"
              "e \xe2\x82\xac \xf0\x9f\x90\xb0");
    EXPECT_EQ(xml_text("\xff\xc3"), "??");
    EXPECT_EQ(xml_text("\xc0\x80 \xed\xa0\x80"), "?? ???");
}

TEST(Junit, rows_without_an_answer_are_skipped_or_errors_with_their_reason)
{
    std::vector<RowRun> rows;
    rows.push_back(skipped_row("buffers of 3 < 4 & 5 \x01 GB"));
    rows.push_back(skipped_row(""));
    rows[1].outcome = Failed{ErrorKind::internal, "device lost"};
    const std::string xml = junit_xml(rows, {false, false});
    EXPECT_TRUE(
        contains(xml, "<testsuites name=\"tetrace check\" tests=\"2\" failures=\"0\" errors=\"1\" skipped=\"1\">"));
    EXPECT_TRUE(contains(xml, "<skipped message=\"unsupported: buffers of 3 &lt; 4 &amp; 5 ? GB\"/>"));
    EXPECT_TRUE(contains(xml, "<error message=\"error: device lost\"/>"));
    expect_well_formed(xml);
}

TEST(Junit, a_wrong_row_is_a_failure_that_shows_the_first_difference)
{
    const Options options = parse_options({"check", "--size", "16", "--views", "0"});
    LoadedScene loaded;
    loaded.scene = make_cubes(4);
    loaded.scene.name = "cubes";
    SceneWork scene(std::move(loaded), options);
    std::vector<RowRun> rows;
    rows.push_back(open_row({"cubes", "openmp", {}}, scene, options));
    verify_rows({&rows[0]}, scene, options);
    Traced& result = std::get<Traced>(rows[0].outcome);
    result.compared = true;
    result.different = 1;
    result.first_different = DifferingRay{0, 8, 8, {0, 7, 1, 0, 0, 3}, {1, 8, 1, 0, 0, 4}};
    const std::string xml = junit_xml(rows, {true});
    EXPECT_TRUE(contains(xml, "<failure message=\"wrong: 1 ray: 1 different from openmp&apos;s\">"));
    EXPECT_TRUE(contains(xml, "the first at view 0, pixel (8, 8)"));
    EXPECT_TRUE(contains(xml, "<property name=\"hit_hash\""));
    EXPECT_TRUE(contains(xml, "classname=\"openmp "));
    expect_well_formed(xml);
}
