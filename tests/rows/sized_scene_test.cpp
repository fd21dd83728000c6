// Several sizes of images, and several numbers of threads, in the rows of one run.
#include "bench/rows/rows.h"
#include "bench/rows/sized_scene.h"
#include "tests/support/fake_backend.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Options options_of(const std::vector<std::string>& more)
{
    std::vector<std::string> words = {"bench",    "--scene", "cubes",      "--method", "maria",
                                      "--layout", "tet80",   "--schedule", "tiles"};
    words.insert(words.end(), more.begin(), more.end());
    return parse_options(words);
}

std::string refused(const std::vector<std::string>& words)
{
    return error_of([&] { static_cast<void>(parse_options(words)); });
}

} // namespace

TEST(Sizes, are_scenes_of_their_own_in_the_order_of_the_list)
{
    const Options options = options_of({"--size", "512,640x480"});
    EXPECT_EQ(scene_labels(options), (std::vector<std::string>{"cubes/size:512", "cubes/size:640x480"}));
    EXPECT_EQ(scene_labels(options_of({"--size", "512"})), std::vector<std::string>{"cubes"});
    const auto scenes = sized_scenes("cubes", options);
    EXPECT_EQ(at_size(options, scenes[1].size).width, 640u);
    EXPECT_EQ(size_in(scenes[1].label), "/size:640x480");
    EXPECT_EQ(size_in("cubes"), "");
    const auto rows = select_rows(options, scene_labels(options), {&reference_backend()});
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(row_name(rows[0]), "cdt/maria/tet80/cubes/size:512/primary/math:exact/api:openmp");
}

TEST(Threads, are_rows_of_their_own_on_processors_and_the_most_are_those_of_the_run)
{
    const Options options = options_of({"--threads", "4,1,2"});
    EXPECT_EQ(options.threads, 4u);
    std::vector<std::string> labels;
    for (const RowKey& row : select_rows(options, {"cubes"}, {&reference_backend()}))
        labels.push_back(device_label(row));
    EXPECT_EQ(labels, (std::vector<std::string>{"openmp, 1 thread", "openmp, 2 threads", "openmp"}));
    Device device;
    device.usable = true;
    device.kind = DeviceKind::emulated;
    FakeBackend emulated("opencl", device);
    EXPECT_EQ(select_rows(options, {"cubes"}, {&emulated}).size(), 1u);
}

TEST(Axes, refuse_what_no_run_can_have)
{
    EXPECT_TRUE(contains(refused({"bench", "--size", "64,64x64"}), "--size: 64x64 is given twice"));
    EXPECT_TRUE(contains(refused({"bench", "--threads", "1,0"}), "--threads: 0 means all"));
    EXPECT_TRUE(contains(refused({"bench", "--threads", "1,2,1"}), "--threads: 1 is given twice"));
    EXPECT_TRUE(contains(refused({"bench", "--threads", "1,x"}), "'x'"));
    EXPECT_TRUE(contains(refused({"bench", "--workload", "default-2026.11", "--size", "64,128"}),
                         "--size: --workload decides it"));
    EXPECT_TRUE(contains(refused({"bench", "--workload", "default-2026.11", "--task", "trace,segments"}),
                         "--task: --workload decides it"));
    for (const char* const verb : {"check", "reproduce"})
        EXPECT_TRUE(contains(refused({verb, "--size", "64,128"}), "lists are for 'tetrace bench'")) << verb;
}
