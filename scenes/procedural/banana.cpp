// A tube along an arc of a circle; its radius tapers towards both ends and closes there with round caps. Only + - * /
// and square roots of doubles, so the bits are the same everywhere: rings and sides rotate by constants, and the arc
// is the rational one, ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)).
#include "scenes/procedural.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

/// A point of the unit circle; * adds the angles.
struct Turn {
    double cos = 1, sin = 0;

    friend Turn operator*(Turn a, Turn b) { return {a.cos * b.cos - a.sin * b.sin, a.cos * b.sin + a.sin * b.cos}; }
};

/// By an angle of at most 1.6: the series' next term is below 1e-16. The same bits everywhere, unlike std::cos.
[[nodiscard]] inline Turn turn_by(double angle)
{
    const double square = angle * angle;
    double cos = 1, sin = 1;
    for (int i = 20; i > 0; i -= 2) {
        cos = 1 - cos * square / (i * (i - 1));
        sin = 1 - sin * square / (i * (i + 1));
    }
    return {cos, sin * angle};
}

constexpr std::uint32_t rings = 125;  ///< between the two tips
constexpr std::uint32_t sides = 100;  ///< vertices of a ring
constexpr double arc_end = 0.55;      ///< t at a tip: tan of a quarter of the angle of the arc, 115 degrees
constexpr double thickness = 0.26;    ///< the tube's radius in its middle; the arc's is 1
constexpr double taper = 0.4;         ///< share of it that has tapered away where the caps begin
constexpr double ridge_height = 0.04; ///< of the five soft ridges along the fruit, relative

constexpr Turn side_step = {0.9980267284282716, 0.06279051952931337};  ///< 2 pi / sides
constexpr Turn ring_step = {0.9996891820008162, 0.024930691738072875}; ///< pi / (rings + 1)

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

/// The point of the tube at s along the arc, `distance` from its centre line towards `side`. Coordinates are multiples
/// of 2^-30: exact zeros stay zero, and no reader has to round.
Float3 tube_point(double s, double distance, Turn side)
{
    const double t = arc_end * s;
    const double scale = 1 / (1 + t * t);
    const Double3 outwards = {(1 - t * t) * scale, 2 * t * scale, 0};
    const double reach = 1 + distance * side.cos;
    const auto tidy = [](double coordinate) { return std::round(coordinate * 0x1p30) * 0x1p-30; };
    return to_float({tidy(outwards.x * reach), tidy(outwards.y * reach), tidy(distance * side.sin)});
}

std::vector<Float3> make_vertices()
{
    std::vector<Float3> vertices;
    Turn ring = ring_step;
    for (std::uint32_t i = 0; i < rings; ++i, ring = ring * ring_step) {
        Turn side;
        for (std::uint32_t j = 0; j < sides; ++j, side = side * side_step)
            vertices.push_back(tube_point(ring.cos, radius_at(ring.cos) * ridges_at(side), side));
    }
    vertices.push_back(tube_point(1, 0, {}));
    vertices.push_back(tube_point(-1, 0, {}));
    return vertices;
}

/// The tube in triangles of about one size: an octahedron with a long waist. From either tip on, `levels` rings have 4
/// vertices more each, and three times as many lie between those; neighbours are as far apart as their sides are long.
class EvenBanana {
public:
    explicit EvenBanana(std::uint32_t levels) : levels_(levels)
    {
        for (std::uint32_t ring = 0; ring <= last_ring(); ++ring)
            add_ring(ring);
        for (std::uint32_t ring = 0; ring < last_ring(); ++ring)
            connect(ring);
    }

    TriangleMesh mesh;

private:
    [[nodiscard]] std::uint32_t last_ring() const { return 5 * levels_; }
    /// Vertices of a ring in a quarter turn; a tip has none.
    [[nodiscard]] std::uint32_t quarter(std::uint32_t ring) const
    {
        return std::min({ring, last_ring() - ring, levels_});
    }

    void add_ring(std::uint32_t ring)
    {
        constexpr double pi = 3.14159265358979323846;
        first_.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
        const std::uint32_t count = 4 * quarter(ring);
        if (count == 0) {
            mesh.vertices.push_back(tube_point(ring == 0 ? 1 : -1, 0, {}));
            return;
        }
        const Turn step = turn_by(2 * pi / count);
        along_ = along_ * turn_by(pi / last_ring());
        Turn side;
        for (std::uint32_t i = 0; i < count; ++i, side = side * step)
            mesh.vertices.push_back(tube_point(along_.cos, radius_at(along_.cos) * ridges_at(side), side));
    }

    [[nodiscard]] std::uint32_t vertex(std::uint32_t ring, std::uint32_t quadrant, std::uint32_t i) const
    {
        const std::uint32_t count = quarter(ring);
        return count == 0 ? first_[ring] : first_[ring] + (quadrant * count + i) % (4 * count);
    }

    /// A triangle for each side of this ring, and for each of the next.
    void connect(std::uint32_t ring)
    {
        const std::uint32_t here = quarter(ring), there = quarter(ring + 1);
        for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
            for (std::uint32_t i = 0; i < here; ++i)
                mesh.triangles.push_back({vertex(ring, quadrant, i), vertex(ring, quadrant, i + 1),
                                          vertex(ring + 1, quadrant, i + (here >= there ? 0 : 1))});
            for (std::uint32_t i = 0; i < there; ++i)
                mesh.triangles.push_back({vertex(ring, quadrant, i + (here < there ? 0 : 1)),
                                          vertex(ring + 1, quadrant, i + 1), vertex(ring + 1, quadrant, i)});
        }
    }

    std::uint32_t levels_;
    std::vector<std::uint32_t> first_; ///< vertex of each ring
    Turn along_;                       ///< of the half circle whose projection has the rings
};

} // namespace

TriangleMesh make_banana(std::uint32_t triangles)
{
    constexpr double triangles_of_one_level = 32;
    return EvenBanana(static_cast<std::uint32_t>(std::lround(std::sqrt(triangles / triangles_of_one_level)))).mesh;
}

// Rings are closer towards the tips, where the caps bend most: they are the projection of a half circle on the arc.
TriangleMesh make_banana()
{
    TriangleMesh mesh;
    mesh.vertices = make_vertices();
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
