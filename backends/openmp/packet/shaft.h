// Where all rays of a square of pixels are, from the planes through the camera and the edges of the domain's outline:
// outside one of them (they miss the domain), inside all of them, or in doubt. In double precision; a square in doubt
// is traced.
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

// What the rays of a square see of the domain: none of them anything, all of them something, or it is in doubt. A wrong
// `all` would cost time only.
enum class Sight { none, all, doubtful };

[[maybe_unused]] Sight sight_of(const PacketJob& job, const Square& square)
{
    Sight sight = Sight::all;
    const double size = size_of(square.centre) + size_of(square.half_x) + size_of(square.half_y); // of any of its rays
    for (uint i = 0; i < job.outline_edges; ++i) {
        const Place normal = {job.outline[i].normal[0], job.outline[i].normal[1], job.outline[i].normal[2]};
        const double side = dot(square.centre, normal);
        const double spread = __builtin_fabs(dot(square.half_x, normal)) + __builtin_fabs(dot(square.half_y, normal)) +
                              job.outline[i].doubt * size;
        if (side < -spread) return Sight::none;
        if (side <= spread) sight = Sight::doubtful;
    }
    return sight;
}
