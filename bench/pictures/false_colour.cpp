#include "bench/pictures/false_colour.h"

#include "core/rays/absorbed.h"
#include "core/rays/segments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

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

namespace {

/// OKLab to linear sRGB: Ottosson, "A perceptual color space for image processing", 2020.
Colour from_oklab(double lightness, double a, double b)
{
    const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    return {static_cast<float>(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            static_cast<float>(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            static_cast<float>(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

constexpr std::uint32_t margin = 10; ///< of title and scale bar, at lettering scale 1
constexpr std::uint32_t footer_height = 58;
constexpr std::uint32_t gap_between = 4; // between pictures side by side

/// The position of a picture's scale bar, and its meaning.
struct ScaleBar {
    std::uint32_t scale; ///< of the lettering
    std::uint32_t left, top, width, height;
    std::uint32_t end; ///< steps at the right end

    [[nodiscard]] std::uint32_t column_of(std::uint32_t steps) const
    {
        return left + static_cast<std::uint32_t>(std::lround(static_cast<double>(steps) * (width - 1) / end));
    }
};

Colour colour_of(const Hit& hit, std::uint32_t end)
{
    if (hit.face_id == LOST) {
        return lost_colour();
    }
    return hit.steps == 0 ? Colour{} : false_colour(static_cast<double>(hit.steps) / end);
}

std::string title_of(const StepsImage& image, const StepSummary& summary)
{
    std::string title =
        fmt::format("{}, {}, mean {:.1f}, max {}", image.what, image.subject, summary.mean, summary.most);
    if (summary.lost > 0) {
        title += fmt::format(", lost {} (magenta)", summary.lost);
    }
    return title;
}

std::uint32_t text_width(const std::string& text, std::uint32_t scale)
{
    return static_cast<std::uint32_t>(text.size()) * letter_width * scale;
}

void draw_bar(Pixmap& pixmap, const ScaleBar& bar)
{
    for (std::uint32_t x = 0; x < bar.width; ++x) {
        for (std::uint32_t y = 0; y < bar.height; ++y) {
            pixmap.at(bar.left + x, bar.top + y) = false_colour(x / (bar.width - 1.0));
        }
    }
}

void draw_ticks(Pixmap& pixmap, const ScaleBar& bar, Colour ink)
{
    const std::uint32_t below = bar.top + bar.height;
    for (const std::uint32_t tick : scale_ticks(bar.end)) {
        for (std::uint32_t y = 0; y < 3 * bar.scale; ++y) {
            pixmap.at(bar.column_of(tick), below + y) = ink;
        }
        const std::string label = std::to_string(tick);
        draw_text(pixmap, std::int64_t{bar.column_of(tick)} - text_width(label, bar.scale) / 2, below + 4 * bar.scale,
                  label, ink, bar.scale);
    }
}

} // namespace

// A path of nearly constant speed in OKLab, from violet to yellow; chroma dips where sRGB has little of it (teal).
Colour false_colour(double value)
{
    const double t = std::clamp(value, 0.0, 1.0);
    const double hue = (305.0 - 200.0 * t) * std::numbers::pi / 180.0;
    const double chroma = 0.10 + 0.03 * t - 0.10 * t * (1.0 - t);
    const Colour colour = from_oklab(0.22 + 0.70 * t, chroma * std::cos(hue), chroma * std::sin(hue));
    return {std::clamp(colour.r, 0.0f, 1.0f), std::clamp(colour.g, 0.0f, 1.0f), std::clamp(colour.b, 0.0f, 1.0f)};
}

std::vector<std::uint32_t> scale_ticks(std::uint32_t top)
{
    std::uint64_t step = 1;
    for (unsigned i = 0; top / step > 6; ++i) {
        step = i % 3 == 1 ? step / 2 * 5 : step * 2; // 1, 2, 5, 10, ...
    }
    std::vector<std::uint32_t> ticks;
    for (std::uint64_t tick = 0; tick <= top; tick += step) {
        ticks.push_back(static_cast<std::uint32_t>(tick));
    }
    return ticks;
}

StepSummary summarize_steps(std::span<const Hit> hits)
{
    std::vector<std::uint32_t> steps;
    StepSummary summary;
    for (const Hit& hit : hits) {
        if (hit.face_id == LOST) {
            ++summary.lost;
        } else {
            steps.push_back(hit.steps);
        }
    }
    if (steps.empty()) {
        return summary;
    }
    std::ranges::sort(steps);
    double sum = 0;
    for (const std::uint32_t count : steps) {
        sum += count;
    }
    summary.mean = sum / static_cast<double>(steps.size());
    summary.most = steps.back();
    summary.top = std::max(1u, steps[(steps.size() - 1) * 999 / 1000]);
    return summary;
}

Pixmap draw_steps(std::span<const Hit> hits, std::uint32_t width, std::uint32_t height, const std::string& subject)
{
    const StepsImage image{{hits.begin(), hits.end()}, subject};
    return draw_steps(std::span(&image, 1), width, height);
}

Pixmap draw_steps(std::span<const StepsImage> images, std::uint32_t width, std::uint32_t height)
{
    const std::uint32_t scale = std::max(1u, width / 448);
    const Colour paper = from_srgb(0x16181C), ink = from_srgb(0xE8EAED);
    std::vector<std::string> titles;
    std::uint32_t column = width, end = 1; // of the scale
    for (const StepsImage& image : images) {
        std::vector<Hit> counted = image.hits;
        if (image.has_outside) std::erase_if(counted, [](const Hit& pixel) { return pixel.tet == NO_TET; });
        const StepSummary summary = summarize_steps(counted);
        titles.push_back(title_of(image, summary));
        column = std::max(column, text_width(titles.back(), scale) + 2 * margin * scale);
        end = std::max(end, summary.top);
    }
    if (images.size() > 1) column += gap_between * scale;
    Pixmap pixmap(column * static_cast<std::uint32_t>(images.size()), height + footer_height * scale, paper);
    for (std::uint32_t i = 0; i < images.size(); ++i) {
        const std::uint32_t left = i * column;
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                pixmap.at(left + x, y) = colour_of(images[i].hits[std::size_t{y} * width + x], end);
        draw_text(pixmap, std::int64_t{left} + margin * scale, std::int64_t{height} + std::int64_t{margin} * scale,
                  titles[i], ink, scale);
    }
    const ScaleBar bar{scale, margin * scale, height + 24 * scale, pixmap.width - 2 * margin * scale, 14 * scale, end};
    draw_bar(pixmap, bar);
    draw_ticks(pixmap, bar, ink);
    return pixmap;
}

const CrossedPicture* crossed_picture(Picture picture)
{
    static constexpr CrossedPicture crossings{Task::segments, "tets that a ray crosses",
                                              [](const Hit& answer) { return segments_of(answer).crossings; }};
    static constexpr CrossedPicture depth{Task::absorb, "optical depth, in tenths of a halving", [](const Hit& answer) {
                                              const double passed =
                                                  share_passed(std::max(1u, absorbed_of(answer).transmittance));
                                              return static_cast<std::uint32_t>(std::lround(-10 * std::log2(passed)));
                                          }};
    static constexpr CrossedPicture light{Task::absorb, "light, in percent", [](const Hit& answer) {
                                              return static_cast<std::uint32_t>(
                                                  std::lround(100 * share_of_light(absorbed_of(answer).light)));
                                          }};
    switch (picture) {
    case Picture::crossings: return &crossings;
    case Picture::depth: return &depth;
    case Picture::light: return &light;
    case Picture::normals:
    case Picture::steps:
    case Picture::hits:
    case Picture::tally: break;
    }
    return nullptr;
}

} // namespace tetrace
