#pragma once

#include <cmath>

namespace tetrace {

/// A point or direction in domain units, as every backend stores it.
struct Float3 {
    float x = 0, y = 0, z = 0;

    friend bool operator==(const Float3&, const Float3&) = default;
    [[nodiscard]] float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    [[nodiscard]] float& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
};

/// The host's wide counterpart, for set-up work that no backend repeats.
struct Double3 {
    double x = 0, y = 0, z = 0;

    friend bool operator==(const Double3&, const Double3&) = default;
    friend Double3 operator+(Double3 a, Double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Double3 operator*(Double3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

[[nodiscard]] inline Double3 to_double(Float3 a)
{
    return {a.x, a.y, a.z};
}
[[nodiscard]] inline Float3 to_float(Double3 a)
{
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
[[nodiscard]] inline double dot(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Double3 cross(Double3 a, Double3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double length(Double3 a)
{
    return std::sqrt(dot(a, a));
}
[[nodiscard]] inline Double3 normalized(Double3 a)
{
    return a * (1.0 / length(a));
}

} // namespace tetrace
