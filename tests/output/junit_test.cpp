#include "bench/output/junit.h"

#include "bench/expectations/check_verdict.h"
#include "bench/measuring/conformity.h"
#include "bench/measuring/view_recorder.h"
#include "bench/output/check_matrix.h"
#include "bench/terminal/text.h"
#include "scenes/procedural.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

RowRecord skipped_row(const std::string& reason)
{
    RowRecord row;
    row.key = {"cubes", "other", {}};
    row.device.name = "a device <of & \"quotes\">";
    row.outcome = Skipped{Status::unsupported, reason};
    return row;
}

/// If xmllint is installed, it checks the text against tests/output/junit.xsd.
void expect_valid(const std::string& xml)
{
    const TemporaryFolder folder;
    write_file(folder / "result.xml", xml);
    if (std::system("xmllint --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "xmllint is not installed (package libxml2-utils), so nothing reads the XML";
    const std::string command =
        "xmllint --noout --schema '" TETRACE_JUNIT_SCHEMA "' '" + (folder / "result.xml").string() + "'";
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
    std::vector<RowRecord> rows;
    rows.push_back(skipped_row("buffers of 3 < 4 & 5 \x01 GB"));
    rows.push_back(skipped_row(""));
    rows[1].outcome = Failed{ErrorKind::internal, "device lost"};
    const std::string xml = junit_xml(rows, judge_rows(rows, nullptr, false));
    EXPECT_TRUE(contains(xml, "<testsuites name=\"tetrace check\" tests=\"2\" failures=\"0\" errors=\"1\">"));
    EXPECT_TRUE(contains(xml, "errors=\"1\" skipped=\"1\" time="));
    EXPECT_TRUE(contains(xml, "<skipped message=\"unsupported: buffers of 3 &lt; 4 &amp; 5 ? GB\"/>"));
    EXPECT_TRUE(contains(xml, "<error message=\"error: device lost\"/>"));
    expect_valid(xml);
}

TEST(Junit, a_check_without_a_result_is_a_case_in_error)
{
    const std::string xml = junit_xml({}, {}, "--require cuda: no driver");
    EXPECT_TRUE(contains(xml, "<testsuites name=\"tetrace check\" tests=\"1\" failures=\"0\" errors=\"1\">"));
    EXPECT_TRUE(contains(xml, "<error message=\"--require cuda: no driver\"/>"));
    expect_valid(xml);
}

TEST(Junit, suites_are_named_after_the_verb)
{
    const std::string xml = junit_xml({skipped_row("none")}, judge_answers({skipped_row("none")}), "no time", "bench");
    EXPECT_TRUE(contains(xml, "<testsuites name=\"tetrace bench\""));
    EXPECT_TRUE(contains(xml, "classname=\"tetrace.bench\" name=\"has a result\""));
    expect_valid(xml);
}

TEST(Junit, classes_have_no_version_and_properties_have_them)
{
    const auto xml_of = [](const char* name, const char* driver) {
        std::vector<RowRecord> rows;
        rows.push_back(skipped_row(""));
        rows[0].key.backend = "vulkan";
        rows[0].device.name = name;
        rows[0].device.driver = driver;
        rows[0].device.library = "/opt/mesa/libvulkan_lvp.so";
        return junit_xml(rows, judge_rows(rows, nullptr, false));
    };
    for (const char* const name : {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe (LLVM 19.1.7, 128 bits)"})
        EXPECT_TRUE(contains(xml_of(name, ""), "classname=\"tetrace.vulkan.llvmpipe\""));
    EXPECT_TRUE(
        contains(xml_of("Intel(R) UHD Graphics 620", ""), "classname=\"tetrace.vulkan.Intel-UHD-Graphics-620\""));
    EXPECT_TRUE(contains(xml_of("", ""), "classname=\"tetrace.vulkan\""));
    const std::string xml = xml_of("llvmpipe (LLVM 15.0.6, 256 bits)", "Mesa 22.3.6");
    EXPECT_TRUE(contains(xml, "<property name=\"vulkan.device\" value=\"llvmpipe (LLVM 15.0.6, 256 bits)\"/>"));
    EXPECT_TRUE(contains(xml, "<property name=\"vulkan.driver\" value=\"Mesa 22.3.6\"/>"));
    EXPECT_TRUE(contains(xml, "<property name=\"vulkan.library\" value=\"/opt/mesa/libvulkan_lvp.so\"/>"));
    expect_valid(xml);
}

TEST(CheckTables, devices_of_one_name_are_told_apart_by_their_drivers_library)
{
    std::vector<RowRecord> rows(3, skipped_row(""));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].key.device = i;
        rows[i].device.library = fmt::format("/build{}/lib.so", i);
    }
    rows[2].device.name = "another";
    const std::string text = self_test_table(rows).csv();
    EXPECT_TRUE(contains(text, "(/build0/lib.so)") && contains(text, "(/build1/lib.so)")) << text;
    EXPECT_FALSE(contains(text, "/build2")) << text;
}

TEST(Junit, a_wrong_row_is_a_failure_that_shows_the_first_difference)
{
    const Options options = parse_options({"check", "--size", "16", "--views", "0"});
    LoadedScene loaded;
    loaded.scene = make_cubes(4);
    loaded.scene.name = "cubes";
    SceneWork scene(std::move(loaded), options);
    RowRun row = open_row({"cubes", "openmp", {}}, scene, options);
    verify_rows({&row}, scene, options);
    std::vector<RowRecord> rows = {record_of(row)};
    Traced& result = std::get<Traced>(rows[0].outcome);
    result.compared = true;
    result.different = 1;
    result.first_different = DifferingRay{0, 8, 8, {0, 7, 1, 0, 0, 3}, {1, 8, 1, 0, 0, 4}};
    const std::string xml = junit_xml(rows, judge_rows(rows, nullptr, false));
    EXPECT_TRUE(contains(xml, "<failure message=\"wrong: 1 ray: 1 different from openmp&apos;s\">"));
    EXPECT_TRUE(contains(xml, "the first at view 0, pixel (8, 8)"));
    EXPECT_TRUE(contains(xml, "hit_hash: "));
    EXPECT_TRUE(contains(xml, "classname=\"tetrace.openmp."));
    expect_valid(xml);
}

TEST(Junit, a_flaw_of_a_method_on_a_bit_exact_device_passes_and_is_named)
{
    RowRecord row = skipped_row("");
    Traced result;
    result.compared = true;
    result.verdicts.wrong = 3;
    row.outcome = result;
    ASSERT_EQ(status_of(row), Status::flawed);
    EXPECT_FALSE(fails_check(row, false));
    const std::string xml = junit_xml({row}, judge_rows({row}, nullptr, false));
    EXPECT_TRUE(contains(xml, "failures=\"0\" errors=\"0\""));
    EXPECT_TRUE(contains(xml, "conformity: bit-exact\nflawed: 3 wrong")) << xml;

    result.verdicts.lost = 1;
    row.outcome = result;
    EXPECT_FALSE(fails_check(row, false)) << "openmp's is lost, too";
    result.compared = false;
    row.outcome = result;
    EXPECT_FALSE(fails_check(row, false)) << "the reference has the method's flaws";
    result.compared = true;
    result.inexact = 1;
    row.outcome = result;
    EXPECT_TRUE(fails_check(row, false)) << "the device may be at fault";
    result.inexact = 0;
    result.different = 1;
    row.outcome = result;
    EXPECT_TRUE(fails_check(row, false));
}

TEST(CheckVerdict, says_in_a_line_whether_the_devices_conform_and_which_do_not)
{
    const auto text = [](const std::vector<RowRecord>& rows, const std::vector<std::string>& required = {}) {
        const auto verdict = verdict_of(rows, judge_rows(rows, nullptr, false), required);
        return verdict ? verdict->line().text() : "";
    };
    RowRecord good = skipped_row("");
    Traced result;
    result.compared = true;
    good.outcome = result;
    RowRecord other = good, wrong = good, failed = good;
    other.key.backend = "vulkan";
    wrong.key.backend = "vulkan";
    result.different = 1;
    wrong.outcome = result;
    failed.outcome = Failed{ErrorKind::driver, "device lost"};
    const std::string device = device_label(good.key);
    EXPECT_EQ(text({good}), "Conforms  1 row on 1 device.\n");
    EXPECT_EQ(text({good, good, other}), "Conforms  3 rows on 2 devices.\n");
    EXPECT_EQ(text({good, skipped_row("")}), "Conforms  1 row on 1 device; 1 more has no result.\n");
    EXPECT_EQ(text({good, skipped_row("")}, {good.key.backend}),
              fmt::format("FAILED    1 of 2 rows, on {}.\n", device));
    EXPECT_EQ(text({good, wrong, other}), "FAILED    1 of 3 rows, on vulkan.\n");
    EXPECT_EQ(text({good, wrong, wrong}), "FAILED    2 of 3 rows, all on vulkan.\n");
    EXPECT_EQ(text({failed, wrong, good}), fmt::format("FAILED    2 of 3 rows, on {}, vulkan.\n", device));
    EXPECT_EQ(text({skipped_row("")}), "");
}
