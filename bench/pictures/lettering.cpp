#include "bench/pictures/lettering.h"

#include <array>
#include <cctype>

namespace tetrace {

namespace {

/// Letters side by side, letter_width columns each, so that they can be read and edited here.
struct Strip {
    std::string_view letters;
    std::array<std::string_view, letter_height> rows;
};

constexpr std::array<Strip, 5> strips{{
    {"0123456789",
     {" ###    #    ###   ###     #  #####   ##  #####  ###   ###  ",
      "#   #  ##   #   # #   #   ##  #      #        # #   # #   # ",
      "#  ##   #       #     #  # #  ####  #        #  #   # #   # ",
      "# # #   #      #    ##  #  #      # ####    #    ###   #### ",
      "##  #   #     #       # #####     # #   #   #   #   #     # ",
      "#   #   #    #    #   #    #  #   # #   #   #   #   #    #  ",
      " ###   ###  #####  ###     #   ###   ###    #    ###   ##   ",
      "                                                            ",
      "                                                            "}},
    {"abcdefghijklm",
     {"      #               #         ##        #       #     #   #      ##         ",
      "      #               #        #          #                 #       #         ",
      " ###  # ##   ###   ## #  ###  ####   #### # ##   ##    ##   #  #    #   ## #  ",
      "    # ##  # #     #  ## #   #  #    #   # ##  #   #     #   # #     #   # # # ",
      " #### #   # #     #   # #####  #    #   # #   #   #     #   ##      #   # # # ",
      "#   # #   # #     #   # #      #     #### #   #   #     #   # #     #   # # # ",
      " #### ####   ###   ####  ###   #        # #   #  ###    #   #  #   ###  #   # ",
      "                                    #   #            #  #                     ",
      "                                     ###              ##                      "}},
    {"nopqrstuvwxyz",
     {"                                     #                                        ",
      "                                     #                                        ",
      "# ##   ###  ####   #### # ##   #### ####  #   # #   # #   # #   # #   # ##### ",
      "##  # #   # #   # #   # ##  # #      #    #   # #   # #   #  # #  #   #    #  ",
      "#   # #   # #   # #   # #      ###   #    #   # #   # # # #   #   #   #   #   ",
      "#   # #   # ####   #### #         #  #  # #  ##  # #  # # #  # #   ####  #    ",
      "#   #  ###  #         # #     ####    ##   ## #   #    # #  #   #     # ##### ",
      "            #         #                                           #   #       ",
      "            #         #                                            ###        "}},
    {" .,:;-_+/()%=<>",
     {"                                                    #    #   #    ##                      ",
      "                    ##    ##                #       #   #     #   ##  #          #   #    ",
      "                    ##    ##                #      #    #     #      #  #####   #     #   ",
      "                               ###        #####   #     #     #     #          #       #  ",
      "                                            #    #      #     #    #    #####   #     #   ",
      "        ##    ##    ##    ##                #   #       #     #   #  ##          #   #    ",
      "        ##     #    ##     #        #####       #        #   #       ##                   ",
      "              #           #                                                               ",
      "                                                                                          "}},
    {"?", // the last strip is the box for all others
     {"##### ", "#   # ", "#   # ", "#   # ", "#   # ", "#   # ", "##### ", "      ", "      "}},
}};

/// Whether the dot (column, row) of a letter is set.
bool dot_set(const Strip& strip, std::size_t letter, std::uint32_t column, std::uint32_t row)
{
    return strip.rows[row][letter * letter_width + column] != ' ';
}

void fill_square(Pixmap& pixmap, std::int64_t x, std::int64_t y, std::uint32_t size, Colour colour)
{
    for (std::int64_t row = y; row < y + size; ++row) {
        for (std::int64_t column = x; column < x + size; ++column) {
            if (row >= 0 && row < pixmap.height && column >= 0 && column < pixmap.width) {
                pixmap.at(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)) = colour;
            }
        }
    }
}

void draw_letter(Pixmap& pixmap, std::int64_t x, std::int64_t y, char letter, Colour colour, std::uint32_t scale)
{
    for (const Strip& strip : strips) {
        const std::size_t index = &strip == &strips.back() ? 0 : strip.letters.find(letter);
        if (index == std::string_view::npos) {
            continue;
        }
        for (std::uint32_t row = 0; row < letter_height; ++row) {
            for (std::uint32_t column = 0; column < letter_width; ++column) {
                if (dot_set(strip, index, column, row)) {
                    fill_square(pixmap, x + std::int64_t{column} * scale, y + std::int64_t{row} * scale, scale, colour);
                }
            }
        }
        return;
    }
}

} // namespace

void draw_text(Pixmap& pixmap, std::int64_t x, std::int64_t y, std::string_view text, Colour colour,
               std::uint32_t scale)
{
    for (const char letter : text) {
        const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        draw_letter(pixmap, x, y, lower, colour, scale);
        x += std::int64_t{letter_width} * scale;
    }
}

} // namespace tetrace
