#pragma once

namespace tetrace::test {

/// A number that counts what is done with it: the kernels' `real` in tests of their operations. Comparisons and changes
/// of sign are free.
struct Counted {
    float value = 0;
    static inline int operations = 0;

    Counted() = default;
    explicit Counted(float v) : value(v) {}
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

} // namespace tetrace::test
