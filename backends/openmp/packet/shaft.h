// Finds squares of pixels whose rays all miss the domain: an edge of the domain's outline has all of them on its outer
// side. In double precision; a square in doubt is traced.
struct Place {
    double x, y, z;
};
LANE_FN Place place_of(const float* a)
{
    return {a[0], a[1], a[2]};
}
LANE_FN Place sum(Place a, Place b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
LANE_FN Place scaled(Place a, double factor)
{
    return {a.x * factor, a.y * factor, a.z * factor};
}
LANE_FN double dot(Place a, Place b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LANE_FN Place cross(Place a, Place b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LANE_FN double size_of(Place a)
{
    return __builtin_fabs(a.x) + __builtin_fabs(a.y) + __builtin_fabs(a.z);
}

// Pixels [x, x_end) x [y, y_end), and their directions: a parallelogram around `centre`.
struct Square {
    uint x, y, x_end, y_end;
    Place centre, half_x, half_y;
};
LANE_FN Square square_at(const PacketJob& job, uint x, uint y, uint size)
{
    Square square;
    square.x = x;
    square.y = y;
    square.x_end = x + size < job.width ? x + size : job.width;
    square.y_end = y + size < job.height ? y + size : job.height;
    const Place step_x = place_of(job.step_x), step_y = place_of(job.step_y);
    square.centre = sum(place_of(job.corner), sum(scaled(step_x, 0.5 * (square.x + square.x_end - 1)),
                                                  scaled(step_y, 0.5 * (square.y + square.y_end - 1))));
    square.half_x = scaled(step_x, 0.5 * (square.x_end - square.x - 1));
    square.half_y = scaled(step_y, 0.5 * (square.y_end - square.y - 1));
    return square;
}

// Far more than rounding can move a ray, or the place where it meets a side of the domain (docs/spec/packets.md, K11).
constexpr double doubt = 0x1p-14;

// The side of all rays of the square at the line from p to q, both seen from the origin: 1, -1, or 0 if in doubt.
LANE_FN int side_of_all(const Square& square, Place p, Place q)
{
    const Place normal = cross(p, q);
    const double side = dot(square.centre, normal);
    const double spread = __builtin_fabs(dot(square.half_x, normal)) + __builtin_fabs(dot(square.half_y, normal)) +
                          doubt * size_of(square.centre) * size_of(p) * size_of(q);
    return side > spread ? 1 : side < -spread ? -1 : 0;
}

[[maybe_unused]] bool misses_domain(const PacketJob& job, const Square& square)
{
    const uint n = job.divisions;
    const auto edge = [&](uint axis, uint end) { return job.lines[axis * (n + 1) + (end != 0 ? n : 0)]; };
    for (uint axis = 0; axis < 3; ++axis)
        for (uint which = 0; which < 4; ++which) { // an edge along `axis`, at these ends of the two other axes
            const uint a = axis == 2 ? 0 : axis + 1, b = axis == 0 ? 2 : axis - 1;
            const uint end_a = which & 1u, end_b = which >> 1;
            const auto is_seen = [&](uint of, uint end) {
                return end != 0 ? job.origin[of] > edge(of, end) : job.origin[of] < edge(of, end);
            };
            if (is_seen(a, end_a) == is_seen(b, end_b)) continue; // not part of the outline
            float from[3], to[3], opposite[3];
            from[axis] = opposite[axis] = edge(axis, 0) - job.origin[axis];
            to[axis] = edge(axis, 1) - job.origin[axis];
            from[a] = to[a] = edge(a, end_a) - job.origin[a];
            from[b] = to[b] = edge(b, end_b) - job.origin[b];
            opposite[a] = edge(a, 1 - end_a) - job.origin[a];
            opposite[b] = edge(b, 1 - end_b) - job.origin[b];
            const Place p = place_of(from), q = place_of(to);
            const int side = side_of_all(square, p, q);
            const double inner = dot(place_of(opposite), cross(p, q));
            if ((side > 0 && inner < 0) || (side < 0 && inner > 0)) return true;
        }
    return false;
}
