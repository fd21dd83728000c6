#include "core/base/printable.h"

#include <gtest/gtest.h>

using namespace tetrace;

TEST(Printable, leaves_what_can_be_shown)
{
    for (const std::string text : {"", "bunny", "a b=c,d;e", "\u00e9 \u00a0 \u4e2d \ufffd \U0001F600"})
        EXPECT_EQ(printable_line(text), text);
    EXPECT_EQ(printable_text("two\nlines\tof text"), "two\nlines\tof text");
}

TEST(Printable, replaces_what_acts_on_a_terminal)
{
    EXPECT_EQ(printable_line("a\x1b[31mred\x07\x7f"), "a?[31mred??");
    EXPECT_EQ(printable_line("two\nlines\tand\rone"), "two?lines?and?one");
    EXPECT_EQ(printable_text("two\nlines\r"), "two\nlines?");
    EXPECT_EQ(printable_line(std::string_view("nul\0here", 8)), "nul?here");
    EXPECT_EQ(printable_line("\u009b31m \u0085 \u2028 \u2029 \u202e \u2066"), "?31m ? ? ? ? ?");
}

TEST(Printable, replaces_bytes_that_are_not_utf_8)
{
    EXPECT_EQ(printable_line("caf\xe9"), "caf?");
    EXPECT_EQ(printable_line("\xff\xfe"), "??");
    EXPECT_EQ(printable_line("\xc0\xaf"), "??") << "overlong";
    EXPECT_EQ(printable_line("\xe0\x80\xaf"), "???") << "overlong";
    EXPECT_EQ(printable_line("\xed\xa0\x80"), "???") << "a surrogate";
    EXPECT_EQ(printable_line("\xf4\x90\x80\x80"), "????") << "past the end of Unicode";
    EXPECT_EQ(printable_line("cut \xe4\xb8"), "cut ??");
    EXPECT_EQ(printable_line("\xef\xbf\xbe|\xef\xbf\xbf"), "?|?") << "no characters";
}
