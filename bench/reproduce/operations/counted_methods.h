#pragma once

// The exit-face methods on layout tet96, compiled as host C++ with numbers that count their operations; a namespace
// each.

#include "core/device/backend.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
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

#define KERNEL_REAL tetrace::Counted
#define KERNEL_REAL_HAS_NO_BITS
#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet96.h"

namespace tetrace::counted {

#define KERNEL_METHOD_HEADER "kernels/methods/plane.h"
namespace plane {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER

#define KERNEL_METHOD_HEADER "kernels/methods/plucker.h"
namespace plucker {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER

#define KERNEL_METHOD_HEADER "kernels/methods/stp.h"
namespace stp {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER

#define KERNEL_METHOD_HEADER "kernels/methods/ms06.h"
namespace ms06 {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER

#define KERNEL_METHOD_HEADER "kernels/methods/maria.h"
namespace maria {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER

#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
namespace project {
#include "kernels/kernel_cpp.h"
}
#undef KERNEL_METHOD_HEADER

} // namespace tetrace::counted

#undef KERNEL_REAL
#undef KERNEL_REAL_HAS_NO_BITS
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER
#undef KERNEL_LAYOUT_HEADER
