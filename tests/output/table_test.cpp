#include "bench/terminal/sheet.h"

#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <gtest/gtest.h>
#include <limits>

using namespace tetrace;

namespace {

Table example()
{
    Table table({{"name", "name"}, {"tets", "tets"}, {"build_s", "build", "s", 1}, {"note", "note"}});
    table.add({std::string("bunny"), std::uint64_t{209397}, 4.04, Cell()});
    table.add({std::string("Dürer"), std::uint64_t{12}, Cell(), Cell()});
    return table;
}

} // namespace

TEST(Table, numbers_stand_right_texts_left_and_empty_columns_are_left_out)
{
    EXPECT_EQ(example().text(), "name      tets  build\n"
                                "                    s\n"
                                "bunny  209,397    4.0\n"
                                "Dürer       12      -\n");
}

TEST(Table, a_heading_is_before_its_rows_in_text_and_in_bold_in_markdown)
{
    Table table(std::vector<Column>{{"a", "a"}});
    table.add_heading("first");
    table.add({std::string("x")});
    table.add_heading("second: longer than any cell");
    table.add({std::string("y")});
    EXPECT_EQ(table.text(1), " a\n first\n x\n second: longer than any cell\n y\n");
    EXPECT_EQ(table.csv(), "a\nx\ny\n");
    EXPECT_EQ(table.markdown(), "| a |\n|---|\n| **first** |\n| x |\n| **second: longer than any cell** |\n| y |\n");
}

TEST(Table, on_a_narrow_terminal_goes_without_the_least_important_columns)
{
    Table table({{.key = "a", .title = "a", .rank = 9}, {"b", "b"}, {.key = "c", .title = "c", .rank = 2}, {"d", "d"}});
    table.add({std::string("12345"), std::string("12345"), std::string("12345"), std::string("12345")});
    EXPECT_EQ(table.text(0, 26), table.text()) << "it fits";
    EXPECT_EQ(table.text(0, 25), "a      b      d\n12345  12345  12345\n");
    EXPECT_EQ(table.dropped(0, 25), std::vector<std::string>{"c"});
    EXPECT_EQ(table.text(0, 18), "a      b\n12345  12345\n") << "the rightmost of equal ones first";
    EXPECT_EQ(table.text(0, 3), "a\n12345\n") << "the first stays";
    Table important({{"a", "a"}, {"b", "b"}, {.key = "c", .title = "c", .rank = 0}});
    important.add({std::string("12345"), std::string("12345"), std::string("12345")});
    EXPECT_EQ(important.text(0, 3), "a      c\n12345  12345\n") << "and so do those of rank 0";
    EXPECT_EQ(table.with_columns({"d"}).text(), "a      d\n12345  12345\n");
    EXPECT_EQ(table.with_columns({"e"}).text(), table.text());
}

TEST(Table, folds_titles_and_then_names_that_are_wider_than_the_terminal)
{
    Table table({{"row", "row"}, {.key = "outcome", .title = "outcome_of_this_one", .rank = 0}});
    table.add({std::string("cdt/maria/tet80/cubes/primary"), std::string("SAME")});
    EXPECT_EQ(table.text(2, 51), "  row                            outcome_of_this_\n"
                                 "                                 one\n"
                                 "  cdt/maria/tet80/cubes/primary  SAME\n");
    EXPECT_EQ(table.text(0, 40), "row                     outcome_of_this_\n"
                                 "                        one\n"
                                 "cdt/maria/tet80/cubes/  SAME\n"
                                 "primary\n");
    EXPECT_EQ(table.text(0, 0), "row                            outcome_of_this_one\n"
                                "cdt/maria/tet80/cubes/primary  SAME\n")
        << "files and pipes get whole lines";
}

TEST(Table, columns_that_are_always_there_continue_below)
{
    Table table(
        {{"row", "row"}, {.key = "a", .title = "first", .rank = 0}, {"b", "b"}, {"c", "second", "s", 2, false, 0}});
    table.add({std::string("one"), std::string("bit-exact"), std::string("x"), std::string("wrong")});
    EXPECT_EQ(table.text(2, 20), "  row  first\n"
                                 "  one  bit-exact\n"
                                 "\n"
                                 "  row  second\n"
                                 "       s\n"
                                 "  one  wrong\n");
    EXPECT_EQ(table.dropped(2, 20), std::vector<std::string>{"b"});
    EXPECT_EQ(table.text(2, 60).find("\n\n"), std::string::npos);
}

TEST(Sheet, is_wrapped_to_a_terminal_and_says_what_it_leaves_out)
{
    Table table({{"a", "a"}, {"b", "a title that is long"}, {"c", "another title that is long"}});
    table.add({std::string("x"), std::string("y"), std::string("z")});
    Sheet sheet;
    sheet.line("A line of a few words that is longer than forty columns.");
    sheet.table(table);
    sheet.labelled("Label", "words and words and words and words and words");
    EXPECT_EQ(sheet.text(), "A line of a few words that is longer than forty columns.\n"
                            "  a  a title that is long  another title that is long\n"
                            "  x  y                     z\n"
                            "Label     words and words and words and words and words\n");
    EXPECT_EQ(sheet.text({.width = 40}), "A line of a few words that is longer\n"
                                         "than forty columns.\n"
                                         "  a  a title that is long\n"
                                         "  x  y\n"
                                         "  Left out in 40 columns: another title\n"
                                         "  that is long.\n"
                                         "Label     words and words and words and\n"
                                         "          words and words\n");
    EXPECT_EQ(sheet.text({.width = 40, .columns = {"c"}}).find("Left out"), std::string::npos);
}

TEST(Sheet, is_markdown_to_post)
{
    Sheet sheet;
    sheet.heading("a scene");
    sheet.gap();
    sheet.line("a <line> of cuda_host");
    sheet.verbatim("  as it is\n");
    sheet.labelled("One", "first");
    sheet.labelled("Two", "second");
    EXPECT_EQ(sheet.markdown(), "### a scene\n\na \\<line> of cuda\\_host\n\n```\n  as it is\n```\n\n"
                                "- **One**: first\n- **Two**: second\n");
}

TEST(Table, csv_has_keys_all_digits_and_quotes_where_needed)
{
    Table table({{"a", "a"}, {"b_s", "b", "s", 1}});
    table.add({std::string("x, \"y\""), 0.123456789});
    table.add({Cell(), std::uint64_t{1234567}});
    EXPECT_EQ(table.csv(), "a,b_s\n\"x, \"\"y\"\"\",0.123456789\n,1234567\n");
}

TEST(Table, csv_has_no_cell_that_a_spreadsheet_computes)
{
    Table table({{"a", "a"}, {"b", "b"}});
    table.add({std::string("=1+2"), std::string("@SUM(A1)")});
    table.add({std::string("-2+cmd|' /C'!A0, \"x\""), std::string("+A1")});
    table.add({std::string("-0.5 %"), -0.5});
    table.add({std::string("a=b"), std::string("-")});
    EXPECT_EQ(table.csv(), "a,b\n'=1+2,'@SUM(A1)\n\"'-2+cmd|' /C'!A0, \"\"x\"\"\",'+A1\n-0.5 %,-0.5\na=b,-\n");
}

TEST(Table, markdown_names_units_in_the_header_and_escapes_bars)
{
    Table table({{"a", "a"}, {"b_s", "b", "s", 1}});
    table.add({std::string("x|y"), 0.25});
    EXPECT_EQ(table.markdown(), "| a | b (s) |\n|---|---:|\n| x\\|y | 0.2 |\n");
}

TEST(Table, a_number_that_is_not_finite_is_never_printed)
{
    Table table({Column{"a", "a"}});
    table.add({std::numeric_limits<double>::quiet_NaN()});
    table.add({std::numeric_limits<double>::infinity()});
    EXPECT_EQ(table.csv(), "a\n\n\n");
    EXPECT_EQ(table.text(), "a\n-\n-\n");
}

TEST(Table, a_row_of_another_length_is_rejected)
{
    Table table({Column{"a", "a"}});
    EXPECT_THROW(table.add({}), Error);
}

TEST(Text, paragraphs_are_filled_and_indented)
{
    EXPECT_EQ(wrapped("one two three\n\nfour", 9, 2), "  one two\n  three\n\n  four\n");
}

TEST(Text, numbers_and_sizes_read_well)
{
    EXPECT_EQ(with_commas(0), "0");
    EXPECT_EQ(with_commas(999), "999");
    EXPECT_EQ(with_commas(1000), "1,000");
    EXPECT_EQ(with_commas(1234567), "1,234,567");
    EXPECT_EQ(percent_text(0), "0 %");
    EXPECT_EQ(percent_text(0.001), "<1 %");
    EXPECT_EQ(percent_text(0.455), "46 %");
    EXPECT_EQ(percent_text(0.999), ">99 %");
    EXPECT_EQ(percent_text(1), "100 %");
    EXPECT_EQ(size_text(1500), "1.5 kB");
    EXPECT_EQ(size_text(16'800'000), "16.8 MB");
    EXPECT_EQ(seconds_text(0.84), "0.8 s");
    EXPECT_EQ(seconds_text(12.2), "12 s");
    EXPECT_EQ(seconds_text(59.7), "1 min 00 s");
    EXPECT_EQ(seconds_text(185), "3 min 05 s");
}

TEST(Table, words_that_mean_trouble_are_in_colour_and_columns_stay_aligned)
{
    Table table({{"row", "row"}, {.key = "status", .title = "status", .coloured = true}, {"n", "n"}});
    table.add({"a", "wrong: 1 ray", std::uint64_t{1}});
    table.add({"b", "ok", std::uint64_t{2}});
    const std::string text = table.text();
    EXPECT_EQ(text, "row  status        n\n"
                    "a    \x1b[31mwrong: 1 ray\x1b[0m  1\n"
                    "b    ok            2\n");
    EXPECT_EQ(without_colour(text), "row  status        n\n"
                                    "a    wrong: 1 ray  1\n"
                                    "b    ok            2\n");
    EXPECT_FALSE(table.csv().find('\x1b') != std::string::npos);
    EXPECT_FALSE(table.markdown().find('\x1b') != std::string::npos);
}
