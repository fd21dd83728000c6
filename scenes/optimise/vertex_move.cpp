#include "scenes/optimise/vertex_move.h"

#include "core/base/exact.h"

#include <array>

namespace tetrace {

namespace {

// The faces of a star's tet that have the vertex, each for the one of its two tets with the smaller number.
void add_edges(const EditableMesh& mesh, std::uint32_t vertex, std::uint32_t index, VertexStar& star)
{
    const Tet& tet = mesh.tet(index);
    for (std::uint32_t face = 0; face < 4; ++face) {
        const std::uint32_t half_face = tet.neighbours[face];
        if (tet.vertices[face] == vertex || half_face == NO_HALF_FACE || half_face_tet(half_face) < index) continue;
        VertexStar::LinkEdge edge{NO_TET, NO_TET, tet.vertices[face],
                                  mesh.tet(half_face_tet(half_face)).vertices[half_face_index(half_face)]};
        for (std::uint32_t i = 0; i < 4; ++i)
            if (i != face && tet.vertices[i] != vertex) (edge.p == NO_TET ? edge.p : edge.q) = tet.vertices[i];
        star.edges.push_back(edge);
    }
}

} // namespace

bool find_star(EditableMesh& mesh, std::uint32_t vertex, std::size_t most, VertexStar& star)
{
    star.tets.assign(1, mesh.tet_of(vertex));
    star.edges.clear();
    mesh.unmark_all();
    mesh.mark(star.tets.front());
    for (std::size_t i = 0; i < star.tets.size(); ++i) {
        if (star.tets.size() > most) return false;
        const Tet& tet = mesh.tet(star.tets[i]);
        for (std::uint32_t face = 0; face < 4; ++face)
            if (tet.vertices[face] != vertex && tet.neighbours[face] != NO_HALF_FACE &&
                mesh.mark(half_face_tet(tet.neighbours[face])))
                star.tets.push_back(half_face_tet(tet.neighbours[face]));
        add_edges(mesh, vertex, star.tets[i], star);
    }
    return true;
}

namespace {

constexpr std::size_t max_moved_tets = 400;
constexpr int solving_steps = 3, move_halvings = 6;
constexpr double min_distance = 1e-7; // of a point from a line, in the weights

// A symmetric 3 x 3 matrix, and the right side of the equations.
struct Equations {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    Double3 right;

    // Weighted squared distance from the line through p along the unit vector t.
    void add_line(Double3 p, Double3 t, double weight)
    {
        xx += weight * (1 - t.x * t.x);
        xy -= weight * t.x * t.y;
        xz -= weight * t.x * t.z;
        yy += weight * (1 - t.y * t.y);
        yz -= weight * t.y * t.z;
        zz += weight * (1 - t.z * t.z);
        right = right + (p - t * dot(p, t)) * weight;
    }
    // Keeps a coordinate at `value`.
    void hold(int axis, double value)
    {
        const double scale = xx + yy + zz;
        if (axis == 0) {
            right = {scale * value, right.y - xy * value, right.z - xz * value};
            xx = scale;
            xy = xz = 0;
        } else if (axis == 1) {
            right = {right.x - xy * value, scale * value, right.z - yz * value};
            yy = scale;
            xy = yz = 0;
        } else {
            right = {right.x - xz * value, right.y - yz * value, scale * value};
            zz = scale;
            xz = yz = 0;
        }
    }
    // By Cramer's rule; `otherwise` where the matrix is singular.
    [[nodiscard]] Double3 solve(Double3 otherwise) const
    {
        const Double3 column[3] = {{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
        const double determinant = dot(column[0], cross(column[1], column[2]));
        const double trace = xx + yy + zz;
        if (!(determinant > 1e-12 * trace * trace * trace)) return otherwise;
        return Double3{dot(right, cross(column[1], column[2])), dot(column[0], cross(right, column[2])),
                       dot(column[0], cross(column[1], right))} *
               (1 / determinant);
    }
};

} // namespace

Double3 cheapest_point(const EditableMesh& mesh, std::span<const VertexStar::LinkEdge> edges, BoxSides sides,
                       Double3 from, int steps)
{
    const Double3 begin = from;
    for (int step = 0; step < steps; ++step) {
        Equations equations;
        for (const auto& edge : edges) {
            const Double3 p = mesh.point(edge.p), along = mesh.point(edge.q) - p;
            const double edge_length = length(along);
            const Double3 t = along * (1 / edge_length);
            const Double3 across = (from - p) - t * dot(from - p, t);
            equations.add_line(p, t, edge_length / std::max(length(across), min_distance));
        }
        if (holds_axis(sides, 0)) equations.hold(0, begin.x);
        if (holds_axis(sides, 1)) equations.hold(1, begin.y);
        if (holds_axis(sides, 2)) equations.hold(2, begin.z);
        from = equations.solve(from);
        if (holds_axis(sides, 0)) from.x = begin.x; // without the solution's roundings
        if (holds_axis(sides, 1)) from.y = begin.y;
        if (holds_axis(sides, 2)) from.z = begin.z;
    }
    return from;
}

Double3 rounded_point(Double3 point)
{
    return to_double(snap_to_grid(to_float(point)));
}

double try_move(EditableMesh& mesh, std::uint32_t vertex, double least, VertexStar& scratch)
{
    if (!find_star(mesh, vertex, max_moved_tets, scratch)) return 0;
    const Double3 from = mesh.point(vertex);
    const double before = scratch.cost(mesh, from);
    const Double3 way = cheapest_point(mesh, scratch.edges, mesh.box_sides(vertex), from, solving_steps) - from;
    double part = 1;
    for (int i = 0; i < move_halvings; ++i, part /= 2) {
        const Double3 to = rounded_point(from + way * part);
        const double gain = before - scratch.cost(mesh, to);
        if (gain > least && mesh.move(vertex, scratch.tets, to)) return gain;
    }
    return 0;
}

} // namespace tetrace
