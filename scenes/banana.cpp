// A tube along an arc of a circle; its radius tapers towards both ends and closes there with round caps. Only + - * /
// and square roots of doubles, so the same bits come out everywhere: rings and sides turn by steps whose sine and
// cosine are power series, and the arc is the rational one, ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)).
#include "scenes/procedural.h"

#include "core/error.h"
#include "scenes/catalogue.h"

#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr double arc_end = 0.55;      ///< t at a tip: tan of a quarter of the angle of the arc, 115 degrees
constexpr double thickness = 0.26;    ///< the tube's radius in its middle; the arc's is 1
constexpr double taper = 0.4;         ///< share of it that is gone where the caps begin
constexpr double ridge_height = 0.04; ///< of the five soft ridges along the fruit, relative

/// A point of the unit circle; * adds the angles.
struct Turn {
    double cos = 1, sin = 0;

    friend Turn operator*(Turn a, Turn b) { return {a.cos * b.cos - a.sin * b.sin, a.cos * b.sin + a.sin * b.cos}; }
};

/// By an angle of at most 1: the series' next term is below 1e-20.
Turn turn_by(double angle)
{
    const double square = angle * angle;
    double cos = 1, sin = 1;
    for (int i = 20; i > 0; i -= 2) {
        cos = 1 - cos * square / (i * (i - 1));
        sin = 1 - sin * square / (i * (i + 1));
    }
    return {cos, sin * angle};
}

/// A ring has sides triangles towards each of its two neighbours; there are about five rings to four sides.
struct Shape {
    std::uint32_t rings, sides; ///< between the two tips; vertices of a ring
    Turn ring_step, side_step;

    explicit Shape(std::uint32_t triangles)
    {
        constexpr double pi = 3.14159265358979323846;
        sides = static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / 2.5)));
        rings = triangles / (2 * sides);
        ring_step = turn_by(pi / (rings + 1));
        side_step = turn_by(2 * pi / sides);
    }
};

/// The tube's radius at s in [-1, 1] along the arc.
double radius_at(double s)
{
    const double s4 = s * s * s * s;
    return thickness * (1 - taper * s * s) * std::sqrt(1 - s4 * s4);
}

/// 1 plus five ridges: cos 5a as a polynomial of cos a.
double ridges_at(Turn side)
{
    const double c = side.cos, c2 = c * c;
    return 1 + ridge_height * c * (16 * c2 * c2 - 20 * c2 + 5);
}

/// To a multiple of 2^-30: what ought to be 0 is, and no reader has to round it.
double tidy(double coordinate)
{
    return std::round(coordinate * 0x1p30) * 0x1p-30;
}

/// The point of the tube at s along the arc, `distance` from its centre line towards `side`.
Float3 tube_point(double s, double distance, Turn side)
{
    const double t = arc_end * s;
    const double scale = 1 / (1 + t * t);
    const Double3 outwards = {(1 - t * t) * scale, 2 * t * scale, 0};
    const double reach = 1 + distance * side.cos;
    return to_float({tidy(outwards.x * reach), tidy(outwards.y * reach), tidy(distance * side.sin)});
}

std::vector<Float3> make_vertices(const Shape& shape)
{
    std::vector<Float3> vertices;
    Turn ring = shape.ring_step;
    for (std::uint32_t i = 0; i < shape.rings; ++i, ring = ring * shape.ring_step) {
        Turn side;
        for (std::uint32_t j = 0; j < shape.sides; ++j, side = side * shape.side_step)
            vertices.push_back(tube_point(ring.cos, radius_at(ring.cos) * ridges_at(side), side));
    }
    vertices.push_back(tube_point(1, 0, {}));
    vertices.push_back(tube_point(-1, 0, {}));
    return vertices;
}

} // namespace

// Rings lie closer towards the tips, where the caps bend most: they are the projection of a half circle on the arc.
TriangleMesh make_banana(std::uint32_t triangles)
{
    if (triangles < least_banana || triangles > most_banana)
        throw Error(ErrorKind::usage, fmt::format("making scene banana: {} triangles; {} to {} are possible", triangles,
                                                  least_banana, most_banana));
    const Shape shape(triangles);
    const std::uint32_t rings = shape.rings, sides = shape.sides;
    TriangleMesh mesh;
    mesh.vertices = make_vertices(shape);
    const std::uint32_t first_tip = rings * sides, last_tip = first_tip + 1;
    for (std::uint32_t j = 0; j < sides; ++j) {
        const std::uint32_t next = (j + 1) % sides;
        mesh.triangles.push_back({first_tip, next, j});
        for (std::uint32_t i = 0; i + 1 < rings; ++i) {
            const std::uint32_t here = i * sides, there = here + sides;
            mesh.triangles.push_back({here + j, here + next, there + j});
            mesh.triangles.push_back({here + next, there + next, there + j});
        }
        const std::uint32_t last = (rings - 1) * sides;
        mesh.triangles.push_back({last_tip, last + j, last + next});
    }
    return mesh;
}

} // namespace tetrace
