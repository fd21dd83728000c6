#include "scenes/procedural/mesh_builder.h"

#include "scenes/scramble.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

std::size_t MeshBuilder::HashPlace::operator()(const std::array<std::int32_t, 3>& place) const
{
    std::uint32_t hash = 0;
    for (const std::int32_t coordinate : place)
        hash = scramble(hash + static_cast<std::uint32_t>(coordinate));
    return hash;
}

std::uint32_t MeshBuilder::vertex(Double3 point)
{
    const auto grid = [](double coordinate) { return static_cast<std::int32_t>(std::lround(coordinate * 0x1p16)); };
    const std::array<std::int32_t, 3> place = {grid(point.x), grid(point.y), grid(point.z)};
    const auto [found, is_new] = index_.try_emplace(place, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(to_float(Double3{place[0] * 0x1p-16, place[1] * 0x1p-16, place[2] * 0x1p-16}));
    return found->second;
}

void MeshBuilder::quad(const std::array<Double3, 4>& corners)
{
    quad(vertex(corners[0]), vertex(corners[1]), vertex(corners[2]), vertex(corners[3]));
}

void MeshBuilder::strip(std::span<const std::uint32_t> from, std::span<const std::uint32_t> to, bool closed)
{
    for (std::size_t i = 0; i + (closed ? 0 : 1) < from.size(); ++i) {
        const std::size_t next = (i + 1) % from.size();
        quad(from[i], from[next], to[next], to[i]);
    }
}

void MeshBuilder::box(Double3 low, Double3 high)
{
    std::array<std::uint32_t, 8> at{};
    for (std::size_t i = 0; i < 8; ++i)
        at[i] = vertex({(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
    for (const auto& [a, b, c, d] :
         {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
        quad(at[static_cast<std::size_t>(a)], at[static_cast<std::size_t>(b)], at[static_cast<std::size_t>(c)],
             at[static_cast<std::size_t>(d)]);
}

void MeshBuilder::sphere(Double3 centre, double radius, std::uint32_t n, const std::function<double(Double3)>& height)
{
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        const Double3 sign = {(octant & 1) != 0 ? -1.0 : 1.0, (octant & 2) != 0 ? -1.0 : 1.0,
                              (octant & 4) != 0 ? -1.0 : 1.0};
        const bool mirrored = sign.x * sign.y * sign.z < 0;
        const auto at = [&](std::uint32_t i, std::uint32_t j) {
            const Double3 direction = normalized({sign.x * i, sign.y * j, sign.z * (n - i - j)});
            return vertex(centre + direction * (radius * height(direction)));
        };
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            if (mirrored) std::swap(b, c);
            triangle(a, b, c);
        };
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; i + j < n; ++j) {
                add(at(i, j), at(i + 1, j), at(i, j + 1));
                if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            }
    }
}

std::uint32_t sphere_edges(double triangles)
{
    return static_cast<std::uint32_t>(std::max(1L, std::lround(std::sqrt(std::max(triangles, 0.0) / 8))));
}

double fractal_noise(Double3 point, std::uint32_t octaves)
{
    double sum = 0, weight = 0.5;
    for (std::uint32_t octave = 0; octave < octaves; ++octave, weight *= 0.5, point = point * 2) {
        const Double3 low = {std::floor(point.x), std::floor(point.y), std::floor(point.z)}, in = point - low;
        const auto smooth = [](double s) { return s * s * (3 - 2 * s); };
        const Double3 share = {smooth(in.x), smooth(in.y), smooth(in.z)};
        for (int corner = 0; corner < 8; ++corner) {
            const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
            const auto place = [](double from, int step) {
                return static_cast<std::uint32_t>(std::lround(from) + step);
            };
            const std::uint32_t hash =
                scramble(place(low.x, x) + scramble(place(low.y, y) + scramble(place(low.z, z) + scramble(octave))));
            sum += weight * (x != 0 ? share.x : 1 - share.x) * (y != 0 ? share.y : 1 - share.y) *
                   (z != 0 ? share.z : 1 - share.z) * (hash >> 8) * 0x1p-24;
        }
    }
    return sum / (1 - 2 * weight); // the weights add up to this
}

double random_unit(std::uint32_t stream, std::uint32_t counter)
{
    return (scramble(counter + scramble(stream + 1)) >> 8) * 0x1p-24;
}

} // namespace tetrace
