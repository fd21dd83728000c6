#pragma once

#include <cstdint>

namespace tetrace {

/// A number that counts what is done with it: the kernels' `real` where their operations are counted. Comparisons and
/// changes of sign are free.
struct Counted {
    float value = 0;
    static inline int operations = 0;

    Counted() = default;
    explicit Counted(float v) : value(v) {}
    explicit operator std::uint32_t() const { return static_cast<std::uint32_t>(value); }
    friend Counted operator+(Counted a, Counted b) { return ++operations, Counted(a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return ++operations, Counted(a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return ++operations, Counted(a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return ++operations, Counted(a.value / b.value); }
    friend Counted operator-(Counted a) { return Counted(-a.value); }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
    friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
    friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
    friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
    friend bool operator>=(Counted a, Counted b) { return a.value >= b.value; }
};

} // namespace tetrace
