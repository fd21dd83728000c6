#include "bench/pictures/false_colour.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <string>

using namespace tetrace;

namespace {

constexpr Colour ink{1, 1, 1};

std::string drawn(std::string_view text, std::uint32_t scale = 1)
{
    Pixmap pixmap(letter_width * scale, letter_height * scale);
    draw_text(pixmap, 0, 0, text, ink, scale);
    std::string dots;
    for (const Colour& pixel : pixmap.pixels) {
        dots += pixel == ink ? '#' : '.';
    }
    return dots;
}

} // namespace

TEST(DrawText, every_letter_has_its_own_shape)
{
    std::set<std::string> shapes;
    const std::string letters = "0123456789abcdefghijklmnopqrstuvwxyz.,:;-_+/()%=<>";
    for (const char letter : letters) {
        shapes.insert(drawn(std::string(1, letter)));
    }
    EXPECT_EQ(shapes.size(), letters.size());
    EXPECT_FALSE(shapes.contains(drawn("?"))) << "a letter is drawn as the box of unknown ones";
}

TEST(DrawText, capitals_are_drawn_as_lower_case)
{
    EXPECT_EQ(drawn("Q"), drawn("q"));
}

TEST(DrawText, unknown_characters_are_drawn_as_a_box)
{
    EXPECT_EQ(drawn("\xc3"), drawn("?"));
    EXPECT_NE(drawn("?"), drawn(" "));
}

TEST(DrawText, scale_enlarges_each_dot)
{
    const auto count = [](const std::string& dots) { return std::count(dots.begin(), dots.end(), '#'); };
    EXPECT_EQ(count(drawn("k", 3)), 9 * count(drawn("k")));
}

TEST(DrawText, is_cut_off_at_the_edges)
{
    Pixmap pixmap(4, 4);
    draw_text(pixmap, -3, -3, "tetrace", ink, 2);
    draw_text(pixmap, 3, 3, "tetrace", ink, 2);
    draw_text(pixmap, 100, 100, "tetrace", ink);
    EXPECT_EQ(pixmap.pixels.size(), 16u);
}
