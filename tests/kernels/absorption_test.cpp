// Task absorb in a uniform medium, whose answers have a closed form, and its exponential, for every argument.
#include "bench/truth/absorption.h"
#include "scenes/procedural.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/domain_chord.h"
#include "tests/support/hard_rays.h"

#include <gtest/gtest.h>

#include <bit>
#include <cassert>
#include <cmath>

namespace {
thread_local std::uint32_t uniform_density; // of the kernel below
constexpr std::uint32_t uniform_value = 200;
} // namespace

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/half32.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
#undef DENSITY_OF // of another kernel in this unity build
#undef VALUE_OF
#define DENSITY_OF(tet) (static_cast<void>(tet), uniform_density)
#define VALUE_OF(tet) uniform_value
namespace tetrace::test::uniform {
namespace {
#include "kernels/kernel_cpp.h"
}
} // namespace tetrace::test::uniform
#undef DENSITY_OF
#undef VALUE_OF
#undef KERNEL_STRUCTURE_HEADER
#undef KERNEL_ARRAYS_HEADER
#undef KERNEL_LAYOUT_HEADER
#undef KERNEL_METHOD_HEADER

using namespace tetrace;
using namespace tetrace::test;

TEST(Absorption, of_every_fraction_is_within_its_bound_and_never_rises)
{
    double low = 0, high = 0;
    std::uint32_t before = NO_ABSORPTION;
    bool is_the_oracles = true, falls = true;
    for (std::uint64_t fraction = 0; fraction <= 0xFFFFFFFF; fraction += 0x100) {
        const std::uint32_t passed = uniform::transmittance_of(0, static_cast<std::uint32_t>(fraction));
        is_the_oracles = is_the_oracles && passed == transmittance_at(fraction);
        falls = falls && passed <= before;
        before = passed;
        const double depth = static_cast<double>(fraction) * 0x1p-32;
        low = std::min(low, passed - std::exp2(24 - depth));
        high = std::max(high, passed - std::exp2(24 - (depth + 0xFFp-32))); // the bits that are left out
    }
    EXPECT_TRUE(is_the_oracles);
    EXPECT_TRUE(falls);
    EXPECT_GT(low, -1.1);
    EXPECT_LT(high, 1.1);
    EXPECT_EQ(uniform::transmittance_of(0, 0), NO_ABSORPTION);
    EXPECT_GE(before, uniform::transmittance_of(1, 0));
    // A whole halving is a bit less, whatever the fraction.
    for (std::uint32_t halvings = 0; halvings < 200; ++halvings)
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const std::uint32_t fraction = i * 0x9E3779B1u;
            const std::uint32_t passed = uniform::transmittance_of(halvings, fraction);
            EXPECT_EQ(passed, halvings < 32 ? uniform::transmittance_of(0, fraction) >> halvings : 0);
            EXPECT_EQ(passed, transmittance_at(std::uint64_t{halvings} << 32 | fraction));
        }
}

TEST(Absorption, of_a_uniform_medium_is_its_closed_form)
{
    const Scene scene = make_cubes(6);
    const PackedScene packed = pack(scene, Layout::half32, TetOrder::chains);
    const RaySet set = hard_ray_set(scene, 0, 3600);
    const auto quads = segment_quads(set, packed);
    uniform::TraceParams params{};
    params.max_steps = packed.tet_count + 1;
    for (const std::uint32_t density : {0u, 9u, 80u, 255u}) {
        uniform_density = density;
        std::size_t compared = 0, ended = 0;
        for (std::size_t i = 0; i < set.rays.size(); ++i) {
            const auto chord = chord_of_domain(scene.domain, set.rays[i]);
            if (!chord) continue;
            ++compared;
            const auto answer = std::bit_cast<Absorbed>(uniform::cross_tets(
                uniform::view_of(packed), params, NO_SUMS, true, quads[i], quads[set.rays.size() + i]));
            EXPECT_EQ(answer.light, uniform_value * (NO_ABSORPTION - answer.transmittance)) << i;
            const double expected = std::exp2(-*chord * density / 16);
            const double bound = std::log(2.0) * density / 16 * 64 * tie_bound(set.rays[i].origin) + 1.1 * 0x1p-24;
            const double passed = share_passed(answer.transmittance);
            if (answer.transmittance < MIN_TRANSMITTANCE) {
                ++ended;
                EXPECT_LT(expected, passed + bound) << i;
            } else {
                EXPECT_NEAR(passed, expected, bound) << i;
                EXPECT_NEAR(share_of_light(answer.light), uniform_value / 256.0 * (1 - expected), bound) << i;
            }
        }
        EXPECT_GT(compared, 500u);
        EXPECT_EQ(ended > 0, density >= 80) << ended;
        EXPECT_LT(ended, compared);
    }
}
