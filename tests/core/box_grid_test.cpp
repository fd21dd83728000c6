#include "core/pack/pack_cwbvh.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Box random_box(Random& random, float size)
{
    const Float3 a = random.point(-size, size);
    const Float3 b = random.point(-size, size);
    return merged({a, a}, {b, b});
}

Float3 between(const Box& box, Random& random)
{
    Float3 point;
    for (int axis = 0; axis < 3; ++axis)
        point[axis] = std::clamp(random.between(box.low[axis], box.high[axis]), box.low[axis], box.high[axis]);
    return point;
}

} // namespace

TEST(BoxGrid, boxes_on_the_grid_hold_those_they_came_from_and_are_less_than_a_cell_larger)
{
    Random random(3);
    for (int i = 0; i < 5000; ++i) {
        const Box outer = random_box(random, i % 2 == 0 ? 1 : 0x1p-12f);
        const Float3 a = between(outer, random);
        const Float3 b = between(outer, random);
        const Box box = i % 7 == 0 ? outer : merged({a, a}, {b, b});
        const BoxGrid grid = make_box_grid(outer);
        const GridBox lines = to_grid(grid, box);
        for (int axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<std::size_t>(axis);
            const double low = line_at(grid, axis, lines.low[k]);
            const double high = line_at(grid, axis, lines.high[k]);
            ASSERT_LE(low, box.low[axis]) << "case " << i;
            ASSERT_GE(high, box.high[axis]) << "case " << i;
            ASSERT_GT(low + grid.width(axis), box.low[axis]) << "case " << i;
            ASSERT_LT(high - grid.width(axis), box.high[axis]) << "case " << i;
        }
    }
}

TEST(BoxGrid, cells_are_the_smallest_power_of_two_that_covers_the_box)
{
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Box box = random_box(random, 1);
        const BoxGrid grid = make_box_grid(box);
        for (int axis = 0; axis < 3; ++axis) {
            const double size = double{box.high[axis]} - box.low[axis];
            EXPECT_GE(255 * grid.width(axis), size);
            EXPECT_LT(127.5 * grid.width(axis), size);
        }
    }
}

TEST(BoxGrid, sizes_of_255_cells_need_no_larger_ones)
{
    const BoxGrid exact = make_box_grid({{0, 0, 0}, {255, 255.00002f, 510}});
    EXPECT_EQ(exact.width(0), 1);
    EXPECT_EQ(exact.width(1), 2);
    EXPECT_EQ(exact.width(2), 2);
    EXPECT_EQ(to_grid(exact, {{0, 0, 0}, {255, 255.00002f, 510}}).high, (std::array<std::uint8_t, 3>{255, 128, 255}));
}

TEST(BoxGrid, a_box_without_size_has_a_grid)
{
    const Box flat = {{1, 2, 3}, {1, 2, 4}};
    const BoxGrid grid = make_box_grid(flat);
    EXPECT_GT(grid.width(0), 0);
    EXPECT_EQ(to_grid(grid, flat).high[0], 0);
}

TEST(BoxGrid, far_from_the_origin_lines_still_enclose)
{
    const Box box = {{63.99999f, -64, 1e-30f}, {64, -63.99999f, 2e-30f}};
    const BoxGrid grid = make_box_grid(box);
    const GridBox lines = to_grid(grid, box);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(line_at(grid, axis, lines.low[static_cast<std::size_t>(axis)]), box.low[axis]);
        EXPECT_GE(line_at(grid, axis, lines.high[static_cast<std::size_t>(axis)]), box.high[axis]);
    }
}
