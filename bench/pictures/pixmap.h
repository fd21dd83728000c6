#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetrace {

/// A colour in linear light, sRGB primaries; 0 to 1 is what a screen shows.
struct Colour {
    float r = 0, g = 0, b = 0;

    friend bool operator==(const Colour&, const Colour&) = default;
    friend Colour operator+(Colour a, Colour b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
    friend Colour operator*(Colour a, float s) { return {a.r * s, a.g * s, a.b * s}; }
};
static_assert(sizeof(Colour) == 12, "pictures cross to the images module as three floats a pixel");

/// The mixture of two colours: a where weight is 0, b where it is 1.
[[nodiscard]] inline Colour mix(Colour a, Colour b, float weight)
{
    return a * (1.0f - weight) + b * weight;
}

/// Pixels in linear light, row after row from the top left.
struct Pixmap {
    std::uint32_t width = 0, height = 0;
    std::vector<Colour> pixels;

    Pixmap() = default;
    Pixmap(std::uint32_t w, std::uint32_t h, Colour fill = {}) : width(w), height(h), pixels(std::size_t{w} * h, fill)
    {
    }
    [[nodiscard]] Colour& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    [[nodiscard]] const Colour& at(std::uint32_t x, std::uint32_t y) const
    {
        return pixels[std::size_t{y} * width + x];
    }
};

/// A colour given as sRGB bytes, as colour pickers show it: 0xRRGGBB.
[[nodiscard]] Colour from_srgb(std::uint32_t bytes);

/// A channel of linear light as a byte of sRGB; values outside 0 to 1 are clamped, NaN becomes 0.
[[nodiscard]] std::uint8_t to_srgb(float linear);

/// The colour of lost rays in every picture: pure magenta, which nothing else has.
[[nodiscard]] Colour lost_colour();

} // namespace tetrace
