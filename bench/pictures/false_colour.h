#pragma once

#include "bench/options/options.h"
#include "bench/pictures/pixmap.h"
#include "core/rays/hit.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// Pixels from one letter to the next, and from one line to the next, at scale 1.
inline constexpr std::uint32_t letter_width = 6, letter_height = 9;

/// Draws text with its top left corner at (x, y), each dot of a letter scale x scale pixels; what is outside the
/// picture is cut off. Lower-case letters, digits and .,:;-_+/()%=<> are drawn; capitals as lower case, the rest as a
/// box.
void draw_text(Pixmap& pixmap, std::int64_t x, std::int64_t y, std::string_view text, Colour colour,
               std::uint32_t scale = 1);

/// The colour of a value in [0, 1]: from dark violet over teal to light yellow. Lightness rises evenly (in OKLab), so
/// that equal differences look equal, in grey and to colour-blind eyes too. Values outside are clamped.
[[nodiscard]] Colour false_colour(double value);

/// Round numbers from 0 to at most `top`, in steps of 1, 2 or 5 times a power of ten; at most seven. top >= 1.
[[nodiscard]] std::vector<std::uint32_t> scale_ticks(std::uint32_t top);

/// Steps per ray, as written below a picture.
struct StepSummary {
    double mean = 0;        ///< over all rays, also those that never met the domain
    std::uint32_t most = 0; ///< of any ray
    std::uint32_t top = 1;  ///< where the scale ends: all rays but one in a thousand are at or below it
    std::uint64_t lost = 0;
};
[[nodiscard]] StepSummary summarize_steps(std::span<const Hit> hits);

/// The picture of a view in false colour, a pixel per ray, with a title and a scale bar below it. Rays without a step
/// are black, lost rays magenta; rays past the end of the scale have the colour of its end.
/// subject: the scene and view, for the title. hits: width * height, row after row. The picture is `width` wide, or
/// wider where the title needs it.
[[nodiscard]] Pixmap draw_steps(std::span<const Hit> hits, std::uint32_t width, std::uint32_t height,
                                const std::string& subject);

/// One of several pictures of a view: for example of another tetrahedralization.
struct StepsImage {
    std::vector<Hit> hits; ///< width * height, row after row
    std::string subject;
    std::string what = "steps per ray"; ///< or what else is in the place of hits' steps
    bool has_outside = false;           ///< pixels without a tet are no part of the summary
};
/// The same for several of them side by side: each has its own title, and all have one scale.
[[nodiscard]] Pixmap draw_steps(std::span<const StepsImage> images, std::uint32_t width, std::uint32_t height);

/// What a picture of all tets shows of a ray, as a whole number.
struct CrossedPicture {
    Task task;
    const char* what;
    std::uint32_t (*value)(const Hit& answer);
};

/// Null for pictures of hits, and of a tally.
[[nodiscard]] const CrossedPicture* crossed_picture(Picture picture);

} // namespace tetrace
