// Each field of RowKey and of KernelId in turn: which rows are the same work, and which names distinguish them.
#include "bench/rows/rows.h"

#include <gtest/gtest.h>
#include <ostream>

using namespace tetrace;

namespace {

/// A row that differs from plain_row() in one field, and what holds for the two.
struct Difference {
    const char* field;
    void (*change)(RowKey& key);
    bool same_work = false, same_rays = false, same_place = true;
    bool is_in_title = false; ///< kernel_title() distinguishes them
    bool is_in_label = false; ///< device_label() distinguishes them
};
std::ostream& operator<<(std::ostream& out, const Difference& difference)
{
    return out << difference.field;
}

/// Of given rays, and not the reference's, so that every field can be changed.
RowKey plain_row()
{
    return {"bunny", "vulkan", {.task = Task::rays}, RayKind::diffuse};
}

class RowKeys : public testing::TestWithParam<Difference> {
protected:
    RowKeys() { GetParam().change(other); }
    RowKey row = plain_row(), other = row;
};

// A new field of either struct does not compile here: it needs its line in the list below.
[[maybe_unused]] void knows_every_field(const RowKey& key)
{
    [[maybe_unused]] const auto& [scene, backend, kernel, rays, order, device, threads, ray_order, in_flight] = key;
    [[maybe_unused]] const auto& [structure, method, layout, math, schedule, task] = kernel;
}

} // namespace

TEST_P(RowKeys, are_the_same_work_where_only_the_place_and_the_schedule_differ)
{
    ASSERT_NE(row, other);
    EXPECT_EQ(same_work(row, other), GetParam().same_work);
    EXPECT_EQ(same_work(other, row), GetParam().same_work);
}

TEST_P(RowKeys, have_the_same_rays_where_scene_kind_and_order_of_the_rays_agree)
{
    EXPECT_EQ(same_rays(row, other), GetParam().same_rays);
    EXPECT_EQ(same_rays(other, row), GetParam().same_rays);
}

TEST_P(RowKeys, are_in_the_same_place_where_backend_device_and_load_agree)
{
    EXPECT_EQ(same_place(row, other), GetParam().same_place);
    EXPECT_EQ(same_place(other, row), GetParam().same_place);
}

TEST_P(RowKeys, have_names_that_tell_them_apart)
{
    EXPECT_EQ(row_name(row) != row_name(other), std::string(GetParam().field) != "task");
    EXPECT_EQ(kernel_title(row) != kernel_title(other), GetParam().is_in_title);
    EXPECT_EQ(device_label(row) != device_label(other), GetParam().is_in_label);
}

INSTANTIATE_TEST_SUITE_P(
    each, RowKeys,
    testing::Values(
        Difference{.field = "scene", .change = [](RowKey& key) { key.scene = "armadillo"; }},
        Difference{.field = "rays", .change = [](RowKey& key) { key.rays = RayKind::ao; }, .is_in_title = true},
        Difference{
            .field = "ray_order", .change = [](RowKey& key) { key.ray_order = RayOrder::morton; }, .is_in_title = true},
        Difference{.field = "order",
                   .change = [](RowKey& key) { key.order = TetOrder::input; },
                   .same_rays = true,
                   .is_in_title = true},
        Difference{.field = "backend",
                   .change = [](RowKey& key) { key.backend = "opencl"; },
                   .same_work = true,
                   .same_rays = true,
                   .same_place = false,
                   .is_in_label = true},
        Difference{.field = "device",
                   .change = [](RowKey& key) { key.device = 1; },
                   .same_work = true,
                   .same_rays = true,
                   .same_place = false,
                   .is_in_label = true},
        Difference{.field = "threads",
                   .change = [](RowKey& key) { key.threads = 1; },
                   .same_work = true,
                   .same_rays = true,
                   .same_place = false,
                   .is_in_label = true},
        Difference{.field = "in_flight",
                   .change = [](RowKey& key) { key.in_flight = 2; },
                   .same_work = true,
                   .same_rays = true,
                   .same_place = false,
                   .is_in_label = true},
        Difference{.field = "structure",
                   .change = [](RowKey& key) { key.kernel.structure = Structure::bvh; },
                   .same_rays = true,
                   .is_in_title = true},
        Difference{.field = "method",
                   .change = [](RowKey& key) { key.kernel.method = Method::project; },
                   .same_rays = true,
                   .is_in_title = true},
        Difference{.field = "layout",
                   .change = [](RowKey& key) { key.kernel.layout = Layout::tet96; },
                   .same_rays = true,
                   .is_in_title = true},
        Difference{.field = "math",
                   .change = [](RowKey& key) { key.kernel.math = MathMode::fast; },
                   .same_rays = true,
                   .is_in_title = true},
        Difference{.field = "schedule",
                   .change = [](RowKey& key) { key.kernel.schedule = Schedule::packets; },
                   .same_work = true,
                   .same_rays = true,
                   .is_in_title = true},
        // The kind of rays decides the task, and the names have the kind.
        Difference{.field = "task", .change = [](RowKey& key) { key.kernel.task = Task::trace; }, .same_rays = true},
        Difference{
            .field = "segments", .change = [](RowKey& key) { key.kernel.task = Task::segments; }, .is_in_title = true}),
    [](const auto& test) { return std::string(test.param.field); });

TEST(ReferenceRow, is_the_references_own_row_of_the_same_work)
{
    RowKey key = plain_row();
    key.device = 2;
    key.kernel.schedule = Schedule::persistent;
    key.in_flight = 2;
    const RowKey reference = reference_row(key);
    EXPECT_TRUE(on_reference(reference));
    EXPECT_FALSE(on_reference(key));
    EXPECT_TRUE(same_work(key, reference));
    EXPECT_EQ(reference.kernel.schedule, Schedule::tiles);
    EXPECT_EQ(reference.device, 0u);
    EXPECT_EQ(reference_row(reference), reference);
}
