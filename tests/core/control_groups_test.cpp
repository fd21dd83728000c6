#include "core/base/control_groups.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

/// A made-up machine's /proc and /sys.
class ControlGroupsOf : public testing::Test {
protected:
    void write(const std::string& path, const std::string& text)
    {
        fs::create_directories((root_ / path).parent_path());
        write_file(root_ / path, text);
    }
    /// Version 2 as systemd mounts it.
    void have_unified(const std::string& group)
    {
        write("proc/self/cgroup", "0::" + group + "\n");
        write("proc/self/mountinfo",
              "22 1 8:1 / / rw - ext4 /dev/vda rw\n"
              "30 22 0:26 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n");
    }
    /// Version 1 as Docker mounts it, on a host whose names for groups the container sees.
    void have_split(const std::string& group, const std::string& top)
    {
        write("proc/self/cgroup",
              "11:memory:" + group + "\n4:cpu,cpuacct:" + group + "\n1:name=systemd:" + group + "\n");
        write("proc/self/mountinfo",
              "41 40 0:31 " + top + " /sys/fs/cgroup/cpu,cpuacct ro - cgroup cgroup rw,cpu,cpuacct\n" + "42 40 0:32 " +
                  top + " /sys/fs/cgroup/memory ro master:17 - cgroup cgroup rw,memory\n" + "43 40 0:33 " + top +
                  " /sys/fs/cgroup/systemd ro - cgroup cgroup rw,name=systemd\n");
    }
    [[nodiscard]] ControlGroups groups() const { return ControlGroups(root_.path()); }

    TemporaryFolder root_;
    const std::string sys_ = "sys/fs/cgroup/";
};

} // namespace

TEST_F(ControlGroupsOf, machine_without_groups_has_no_limits)
{
    for (const bool has_files : {false, true}) {
        if (has_files) {
            have_unified("/");
            write(sys_ + "cgroup.procs", "1\n");
        }
        EXPECT_FALSE(groups().cpus());
        EXPECT_FALSE(groups().threads());
        EXPECT_FALSE(groups().memory_bytes());
        EXPECT_FALSE(groups().free_memory_bytes());
        EXPECT_FALSE(groups().throttling());
    }
}

TEST_F(ControlGroupsOf, strictest_limit_up_the_path_counts_in_version_2)
{
    have_unified("/kube/pod/box");
    write(sys_ + "kube/cpu.max", "150000 100000\n");
    write(sys_ + "kube/pod/cpu.max", "max 100000\n");
    write(sys_ + "kube/pod/box/cpu.max", "400000 100000\n");
    write(sys_ + "kube/memory.max", "max\n");
    write(sys_ + "kube/pod/memory.max", "1000\n");
    write(sys_ + "kube/pod/memory.current", "900\n");
    write(sys_ + "kube/pod/memory.stat", "anon 500\ninactive_file 250\nactive_file 50\nslab 9\n");
    write(sys_ + "kube/pod/box/memory.max", "2000\n");
    write(sys_ + "kube/pod/box/memory.current", "100\n");
    write(sys_ + "kube/cpu.stat", "usage_usec 5\nnr_periods 40\nnr_throttled 7\nthrottled_usec 1500000\n");
    write(sys_ + "kube/pod/cpu.stat", "nr_throttled 100\n");
    EXPECT_DOUBLE_EQ(groups().cpus().value(), 1.5);
    EXPECT_EQ(groups().threads(), 1u);
    EXPECT_EQ(groups().memory_bytes(), 1000u);
    EXPECT_EQ(groups().free_memory_bytes(), 400u) << "file caches are not counted as used";
    EXPECT_EQ(groups().throttling().value().periods, 7u) << "pod lacks a quota";
    EXPECT_DOUBLE_EQ(groups().throttling().value().seconds, 1.5);
    write(sys_ + "kube/pod/box/cpu.max", "50000 100000\n");
    EXPECT_DOUBLE_EQ(groups().cpus().value(), 0.5);
}

TEST_F(ControlGroupsOf, container_with_a_namespace_of_its_own_has_its_limits_at_the_root)
{
    for (const char* const group : {"/", "/../../outside"}) {
        have_unified(group);
        write(sys_ + "cpu.max", "320000 100000\n");
        write("sys/outside/cpu.max", "100000 100000\n"); // no group
        write(sys_ + "memory.max", "536870912\n");
        EXPECT_EQ(groups().threads(), 3u) << group;
        EXPECT_EQ(groups().memory_bytes(), 536870912u) << group;
        EXPECT_EQ(groups().free_memory_bytes(), 536870912u) << group;
    }
}

TEST_F(ControlGroupsOf, container_of_version_1_sees_its_group_at_the_mount)
{
    have_split("/docker/abc/inner", "/docker/abc");
    write(sys_ + "cpu,cpuacct/cpu.cfs_quota_us", "250000\n");
    write(sys_ + "cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    write(sys_ + "cpu,cpuacct/cpu.stat", "nr_periods 10\nnr_throttled 3\nthrottled_time 2000000000\n");
    write(sys_ + "cpu,cpuacct/inner/cpu.cfs_quota_us", "-1\n");
    write(sys_ + "cpu,cpuacct/inner/cpu.cfs_period_us", "100000\n");
    write(sys_ + "memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_FALSE(groups().memory_bytes()) << "how version 1 writes no limit";
    write(sys_ + "memory/inner/memory.limit_in_bytes", "3000\n");
    write(sys_ + "memory/inner/memory.usage_in_bytes", "2500\n");
    write(sys_ + "memory/inner/memory.stat", "inactive_file 1\ntotal_inactive_file 1000\ntotal_active_file 500\n");
    EXPECT_DOUBLE_EQ(groups().cpus().value(), 2.5);
    EXPECT_EQ(groups().threads(), 2u);
    EXPECT_EQ(groups().memory_bytes(), 3000u);
    EXPECT_EQ(groups().free_memory_bytes(), 2000u);
    EXPECT_EQ(groups().throttling().value().periods, 3u);
    EXPECT_DOUBLE_EQ(groups().throttling().value().seconds, 2);
    have_split("/docker/elsewhere", "/docker/abc");
    EXPECT_EQ(groups().threads(), 2u) << "a group that the mount does not show: its top is ours";
}

TEST_F(ControlGroupsOf, both_versions_side_by_side_are_read)
{
    have_split("/slice", "/");
    write("proc/self/cgroup", "11:memory:/slice\n4:cpu,cpuacct:/slice\n0::/slice\n");
    write("proc/self/mountinfo", "41 40 0:31 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
                                 "42 40 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
                                 "44 40 0:34 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
    write(sys_ + "unified/slice/cgroup.procs", "1\n");
    write(sys_ + "cpu,cpuacct/slice/cpu.cfs_quota_us", "50000\n");
    write(sys_ + "cpu,cpuacct/slice/cpu.cfs_period_us", "100000\n");
    write(sys_ + "memory/slice/memory.limit_in_bytes", "4096\n");
    EXPECT_DOUBLE_EQ(groups().cpus().value(), 0.5);
    EXPECT_EQ(groups().threads(), 1u) << "less than one CPU is one thread";
    EXPECT_EQ(groups().memory_bytes(), 4096u);
}

TEST_F(ControlGroupsOf, damaged_files_are_no_limits)
{
    have_unified("/box");
    for (const char* const text : {"", "0 100000", "100000", "-5 100000", "1 0", "quota period", "\xff\xfe"}) {
        write(sys_ + "box/cpu.max", text);
        write(sys_ + "box/memory.max", text == std::string("0 100000") ? "no" : "-7");
        EXPECT_FALSE(groups().cpus()) << text;
        EXPECT_FALSE(groups().memory_bytes()) << text;
    }
}
