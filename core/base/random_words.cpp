#include "core/base/random_words.h"

#include <Random123/philox.h>

namespace tetrace {
namespace {

// In (-1, 1), a multiple of 2^-32 that is never 0.
double signed_unit(std::uint32_t word)
{
    return (2.0 * static_cast<double>(word) + 1) * 0x1p-32 - 1;
}

} // namespace

RandomWords random_words(const RandomWords& place, std::uint32_t stream)
{
    r123::Philox4x32 generator;
    const auto words = generator({{place[0], place[1], place[2], place[3]}}, {{stream, 0}});
    return {words[0], words[1], words[2], words[3]};
}

Double3 random_direction(const RandomPlace& place)
{
    for (std::uint32_t attempt = 0;; ++attempt) {
        const RandomWords words = random_words({place.view, place.pixel, place.dimension, attempt}, place.stream);
        const Double3 point{signed_unit(words[0]), signed_unit(words[1]), signed_unit(words[2])};
        const double square = dot(point, point);
        if (square <= 1 && square >= 0x1p-8) return normalized(point);
    }
}

} // namespace tetrace
