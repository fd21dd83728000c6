// Random points of which many are in blobs, as those of a radiance field are where there is something to see.
#include "scenes/procedural.h"
#include "scenes/procedural/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

constexpr std::uint32_t blob_count = 24, corner_count = 8;
constexpr int densest = 3;

struct Blob {
    Double3 centre;
    double radius;
};

std::array<Blob, blob_count> place_blobs()
{
    std::array<Blob, blob_count> blobs{};
    for (std::uint32_t i = 0; i < blob_count; ++i) {
        const auto coordinate = [&](std::uint32_t axis) { return 1.4 * random_unit(axis, i) - 0.7; };
        blobs[i] = {{coordinate(0), coordinate(1), coordinate(2)}, 0.12 + 0.23 * random_unit(3, i)};
    }
    return blobs;
}

/// The corners of the cube first, then points between them: every second one is in a blob, densest in its middle.
Double3 place_point(std::uint32_t number, const std::array<Blob, blob_count>& blobs)
{
    if (number < corner_count)
        return {number % 2 == 0 ? -1.0 : 1.0, number / 2 % 2 == 0 ? -1.0 : 1.0, number / 4 == 0 ? -1.0 : 1.0};
    const auto draw = [&](std::uint32_t stream) { return 2 * random_unit(stream, number) - 1; };
    if (number % 2 != 0) {
        const auto& [centre, radius] = blobs[number / 2 % blob_count];
        const auto coordinate = [&](double middle, std::uint32_t stream) {
            const double offset = (draw(stream) + draw(stream + 1) + draw(stream + 2)) / 3;
            return std::floor((middle + radius * offset) * 0x1p20) * 0x1p-20; // a float
        };
        const Double3 point{coordinate(centre.x, 10), coordinate(centre.y, 20), coordinate(centre.z, 30)};
        if (std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) < 1) return point;
    }
    return {draw(40), draw(41), draw(42)};
}

/// 0 outside all blobs, densest in the middle of one.
int density_at(Double3 point, const std::array<Blob, blob_count>& blobs)
{
    int density = 0;
    for (const auto& [centre, radius] : blobs) {
        const Double3 offset = point - centre;
        const double share = 1 - dot(offset, offset) / (radius * radius);
        density = std::max(density, static_cast<int>(std::ceil(share * densest)));
    }
    return density;
}

} // namespace

std::string make_field(std::uint32_t points)
{
    const auto blobs = place_blobs();
    std::string text = fmt::format("{} 3 0 1\n", points);
    for (std::uint32_t number = 0; number < points; ++number) {
        const Double3 point = place_point(number, blobs);
        fmt::format_to(std::back_inserter(text), "{} {} {} {} {}\n", number, static_cast<float>(point.x),
                       static_cast<float>(point.y), static_cast<float>(point.z), density_at(point, blobs));
    }
    return text;
}

} // namespace tetrace
