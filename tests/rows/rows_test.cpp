#include "backends/embree/backend.h"
#include "backends/openmp/backend.h"
#include "bench/options/benchmark_flags.h"
#include "bench/options/name_filter.h"
#include "bench/rows/rows.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace tetrace;
using tetrace::test::contains;
using tetrace::test::error_of;

namespace {

std::vector<std::string> names(const std::vector<std::string>& arguments, const std::vector<std::string>& scenes)
{
    std::vector<std::string> list;
    // Not those of this machine's GPU interfaces.
    for (const RowKey& key : select_rows(parse_options(arguments), scenes, {&openmp_backend(), &embree_backend()}))
        list.push_back(row_name(key));
    return list;
}

/// A backend that has every kernel of structure cdt, on hosts that run none of math mode fast.
class OldHost : public Backend {
public:
    explicit OldHost(std::vector<Device> devices = {Device{}}) : devices_(std::move(devices)) {}
    [[nodiscard]] std::string name() const override { return "old"; }
    [[nodiscard]] std::string clock() const override { return "none"; }
    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return kernel.structure == Structure::cdt; }
    [[nodiscard]] std::string why_not(std::size_t, const KernelId& kernel) const override
    {
        return kernel.math == MathMode::fast ? "no fused multiply-add" : "";
    }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData&,
                                                const SessionOptions&) override
    {
        throw Error(ErrorKind::unsupported, why_not(0, kernel));
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode, std::span<const Quad>) override { return {}; }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    std::vector<Device> devices_;
};

Device device_named(const char* name, DeviceKind kind, bool usable = true)
{
    Device device;
    device.name = name;
    device.kind = kind;
    device.usable = usable;
    if (!usable) device.reason = "no driver; install one";
    return device;
}

/// A backend whose kernels trace by the driver's own BVH: on device 1 by each schedule, on device 2 through a pipeline
/// only there, on device 0 not at all.
class Drivers : public OldHost {
public:
    explicit Drivers(DeviceKind kind = DeviceKind::gpu)
        : OldHost({device_named("a", kind), device_named("b", kind), device_named("c", kind)})
    {
    }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return kernel.layout == Layout::rt; }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        const bool has_it = device == 1 || (device == 2 && kernel.schedule == Schedule::pipeline);
        return has_it ? "" : "no extension";
    }
};

const std::string by_queries = "bvh/single/rt/s/primary/math:fast/api:old",
                  by_pipeline = "bvh/single/rt/s/primary/math:fast/schedule:pipeline/api:old";

Options with_required(const char* backend)
{
    Options options = parse_options({"bench"});
    options.required = {backend};
    return options;
}

std::vector<std::string> names_on(Backend& backend, std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), "bench");
    std::vector<std::string> list;
    for (const RowKey& key : select_rows(parse_options(arguments), {"s"}, {&backend}))
        list.push_back(row_name(key));
    return list;
}

} // namespace

TEST(Rows, a_kernel_that_the_host_cannot_run_is_a_row_and_one_that_the_backend_lacks_is_none)
{
    OldHost old;
    const auto rows = select_rows(parse_options({"bench", "--math", "exact,fast"}), {"a"}, {&old});
    EXPECT_EQ(rows.size(), 9u);
    EXPECT_EQ(
        std::count_if(rows.begin(), rows.end(), [](const RowKey& key) { return key.kernel.math == MathMode::fast; }),
        4);
    EXPECT_TRUE(std::none_of(rows.begin(), rows.end(),
                             [](const RowKey& key) { return key.kernel.structure == Structure::bvh; }));
}

TEST(Rows, have_several_launches_in_flight_if_their_device_can)
{
    const std::vector<std::string> arguments = {"bench", "--layout", "tet80",      "--launches-in-flight",
                                                "2",     "--task",   "trace,tally"};
    const Options options = parse_options(arguments);
    OldHost both({device_named("a", DeviceKind::gpu), device_named("b", DeviceKind::cpu)});
    std::vector<std::string> list;
    for (const RowKey& key : select_rows(options, {"s"}, {&both}))
        list.push_back(row_name(key));
    EXPECT_EQ(list, (std::vector<std::string>{"cdt/maria/tet80/s/primary/math:exact/api:old/in_flight:2",
                                              "cdt/maria/tet80/s/primary/math:exact/api:old:1",
                                              "tally/maria/tet80/s/primary/math:exact/api:old",
                                              "tally/maria/tet80/s/primary/math:exact/api:old:1"}));
    const std::string error = error_of([&] { (void)select_rows(options, {"s"}, {&openmp_backend()}); });
    EXPECT_TRUE(contains(error, "--launches-in-flight 2: no selected row can have several")) << error;
}

TEST(Rows, every_usable_device_has_rows_named_by_its_index)
{
    OldHost old({device_named("a", DeviceKind::gpu), device_named("b", DeviceKind::gpu, false),
                 device_named("c", DeviceKind::cpu)});
    const auto rows = select_rows(parse_options({"bench", "--layout", "tet80"}), {"s"}, {&old});
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(row_name(rows[0]), "cdt/maria/tet80/s/primary/math:exact/api:old");
    EXPECT_EQ(row_name(rows[1]), "cdt/maria/tet80/s/primary/math:exact/api:old:2");
    EXPECT_EQ(device_label(rows[1]), "old:2");
    EXPECT_TRUE(missing_devices(parse_options({"bench"}), {&old}).empty());
}

TEST(Rows, devices_are_chosen_by_a_part_of_what_describes_them_in_any_case)
{
    std::vector<Device> devices = {device_named("Radeon", DeviceKind::gpu),
                                   device_named("llvmpipe", DeviceKind::emulated)};
    devices[1].library = "/opt/mesa/libvulkan_lvp.so";
    OldHost old(devices);
    const auto indices = [&](const char* text) {
        std::vector<std::size_t> found;
        for (const RowKey& key :
             select_rows(parse_options({"bench", "--layout", "tet80", "--device", text}), {"s"}, {&old}))
            found.push_back(key.device);
        return found;
    };
    EXPECT_EQ(indices("radeON"), std::vector<std::size_t>{0});
    EXPECT_EQ(indices("EMULATED"), std::vector<std::size_t>{1});
    EXPECT_EQ(indices("/opt/mesa/"), std::vector<std::size_t>{1});
    EXPECT_EQ(indices("radeon,pipe"), (std::vector<std::size_t>{0, 1}));
    for (const char* const text : {"geforce", "radeon,geforce"})
        EXPECT_EQ(error_of([&] { static_cast<void>(indices(text)); }),
                  "missing: --device: no device's name contains geforce (nor its driver, library, type, id or number); "
                  "there are: "
                  "Radeon (old), llvmpipe (old:1)");
}

TEST(Rows, an_api_without_a_device_has_rows_only_where_it_is_asked_for)
{
    OldHost old({device_named("none", DeviceKind::gpu, false)});
    OldHost usable;
    EXPECT_EQ(select_rows(parse_options({"bench"}), {"s"}, {&old, &usable}).size(), 5u);
    EXPECT_THROW(static_cast<void>(select_rows(parse_options({"bench"}), {"s"}, {&old})), Error);
    EXPECT_EQ(missing_devices(parse_options({"bench"}), {&old}),
              std::vector<std::string>{"old: no device: no driver; install one"});
    EXPECT_EQ(select_rows(with_required("old"), {"s"}, {&old}).size(), 5u);
    EXPECT_TRUE(missing_devices(with_required("old"), {&old}).empty());
}

TEST(Rows, of_a_drivers_bvh_are_those_of_devices_that_have_it_unless_they_are_asked_for)
{
    Drivers drivers;
    const auto names_with = [&](const std::vector<std::string>& arguments) { return names_on(drivers, arguments); };
    const std::vector with = {by_queries + ":1", by_pipeline + ":2"};
    const std::vector all = {by_queries, by_queries + ":1", by_pipeline + ":2"};
    EXPECT_EQ(names_with({}), with);
    EXPECT_EQ(names_with({"--math", "exact", "--schedule", "persistent"}), with);
    EXPECT_EQ(names_with({"--layout", "bvh2,rt"}), all);
    EXPECT_EQ(names_with({"--filter", "/rt/"}), all);
    EXPECT_THROW((void)names_with({"--layout", "bvh2"}), Error);
    KernelId kernel{.structure = Structure::bvh, .method = Method::single, .layout = Layout::rt};
    EXPECT_EQ(kernel_title({"s", "old", kernel}), "bvh rt");
    kernel.schedule = Schedule::pipeline;
    EXPECT_EQ(kernel_title({"s", "old", kernel}), "bvh rt pipeline");
}

TEST(Rows, of_a_drivers_bvh_are_traced_by_ray_queries_unless_the_schedule_says_or_the_driver_has_only_a_pipeline)
{
    Drivers drivers;
    const std::vector queries = {by_queries, by_queries + ":1", by_queries + ":2"};
    const std::vector pipelines = {by_pipeline, by_pipeline + ":1", by_pipeline + ":2"};
    EXPECT_EQ(names_on(drivers, {"--schedule", "tiles", "--layout", "rt"}), queries) << "asked for, and refused where";
    EXPECT_EQ(names_on(drivers, {"--schedule", "pipeline"}), pipelines) << "no other layout has it";
    std::vector both = queries;
    both.insert(both.end(), pipelines.begin(), pipelines.end());
    EXPECT_EQ(names_on(drivers, {"--schedule", "tiles,pipeline"}), both);
    EXPECT_EQ(names_on(drivers, {"--schedule", "packets", "--layout", "rt"}),
              (std::vector{by_queries, by_queries + ":1", by_pipeline + ":2"}))
        << "no schedule of rt";
    EXPECT_EQ(names_on(drivers, {"--schedule", "tiles"}), std::vector{by_queries + ":1"}) << "by default, what runs";
}

TEST(Rows, of_an_emulated_drivers_bvh_are_those_that_are_asked_for_by_name)
{
    Drivers drivers(DeviceKind::emulated);
    for (const auto& unnamed : {std::vector<std::string>{}, {"--filter", "api:old"}, {"--filter", "start|/s/"}})
        EXPECT_THROW((void)names_on(drivers, unnamed), Error);
    for (const auto& named : {std::vector<std::string>{"--layout", "rt"},
                              {"--layout", "bvh2,rt"},
                              {"--filter", "bvh/single/(rt|bvh2)/"},
                              {"--benchmark_filter=rt/"}})
        EXPECT_EQ(names_on(drivers, named), (std::vector{by_queries, by_queries + ":1", by_pipeline + ":2"}));
    EXPECT_EQ(names_on(drivers, {"--schedule", "pipeline", "--device", "old:1"}), std::vector{by_pipeline + ":1"});
}

TEST(Rows, persistent_threads_are_rows_where_they_are_asked_for)
{
    OldHost old;
    const auto rows = select_rows(parse_options({"bench", "--schedule", "tiles,persistent"}), {"s"}, {&old});
    EXPECT_EQ(rows.size(), 8u);
    EXPECT_EQ(row_name(rows[4]), "cdt/maria/tet80/s/primary/math:exact/schedule:persistent/api:old");
}

TEST(Rows, the_default_is_maria_and_projects_records_and_bvhs_and_embree)
{
    EXPECT_EQ(names({"bench"}, {"bunny"}),
              (std::vector<std::string>{"cdt/maria/tet80/bunny/primary/math:exact/api:openmp",
                                        "cdt/maria/tet96/bunny/primary/math:exact/api:openmp",
                                        "cdt/project/half32/bunny/primary/math:exact/api:openmp",
                                        "cdt/project/tet64/bunny/primary/math:exact/api:openmp",
                                        "cdt/project/half32/bunny/primary/math:exact/schedule:packets/api:openmp",
                                        "bvh/single/bvh2/bunny/primary/math:exact/api:openmp",
                                        "bvh/single/bvh4/bunny/primary/math:exact/api:openmp",
                                        "bvh/single/cwbvh/bunny/primary/math:exact/api:openmp",
                                        "bvh/single/embree/bunny/primary/math:fast/api:embree",
                                        "bvh/packet8/embree/bunny/primary/math:fast/api:embree",
                                        "bvh/packet16/embree/bunny/primary/math:fast/api:embree",
                                        "bvh/stream/embree/bunny/primary/math:fast/api:embree",
                                        "bvh/single/embree_medium/bunny/primary/math:fast/api:embree",
                                        "bvh/packet8/embree_medium/bunny/primary/math:fast/api:embree",
                                        "bvh/packet16/embree_medium/bunny/primary/math:fast/api:embree",
                                        "bvh/stream/embree_medium/bunny/primary/math:fast/api:embree",
                                        "bvh/packet8/embree_robust/bunny/primary/math:fast/api:embree",
                                        "bvh/packet16/embree_robust/bunny/primary/math:fast/api:embree",
                                        "bvh/stream/embree_robust/bunny/primary/math:fast/api:embree"}));
}

TEST(Rows, the_papers_tables_have_no_packets)
{
    const auto list = names({"reproduce", "table4", "--method", "project", "--layout", "half32"}, {"a"});
    EXPECT_EQ(list, std::vector<std::string>{"cdt/project/half32/a/primary/math:exact/api:openmp"});
}

TEST(Rows, every_method_has_rows_where_all_are_asked_for)
{
    std::vector<std::string> all;
    for (const KernelId& kernel : all_kernels())
        if (kernel.layout == Layout::tet80 && kernel.schedule == Schedule::tiles && kernel.math == MathMode::exact)
            all.push_back(name_of(kernel) + "/a/primary/math:exact/api:openmp");
    EXPECT_EQ(all.front(), "cdt/plane/tet80/a/primary/math:exact/api:openmp");
    EXPECT_EQ(all.back(), "cdt/project/tet80/a/primary/math:exact/api:openmp");
    for (const char* const method : {"single", "packet8", "packet16", "stream"})
        all.push_back(std::string("bvh/") + method + "/embree/a/primary/math:fast/api:embree");
    EXPECT_EQ(names({"bench", "--method", "all", "--layout", "tet80,embree"}, {"a"}), all);
    EXPECT_EQ(names({"check", "--method", "plucker"}, {"a"}).size(), 2u);
}

TEST(Rows, methods_in_double_have_task_segments_alone)
{
    EXPECT_EQ(names({"check", "--task", "segments", "--method", "plucker64,barycentric"}, {"a"}),
              (std::vector<std::string>{"segments/plucker64/tet80/a/primary/math:exact/api:openmp",
                                        "segments/barycentric/tet80/a/primary/math:exact/api:openmp"}));
    EXPECT_TRUE(contains(error_of([] {
                             (void)names({"bench", "--method", "plucker64"}, {"a"});
                         }),
                         "and on openmp of plucker64 and barycentric"));
}

TEST(Rows, options_select_and_rows_go_scene_after_scene)
{
    EXPECT_EQ(names({"bench", "--layout", "tet96"}, {"a", "b"}),
              (std::vector<std::string>{"cdt/maria/tet96/a/primary/math:exact/api:openmp",
                                        "cdt/maria/tet96/b/primary/math:exact/api:openmp"}));
    EXPECT_EQ(names({"bench", "--backend", "embree", "--method", "packet16"}, {"a"}),
              (std::vector<std::string>{"bvh/packet16/embree/a/primary/math:fast/api:embree",
                                        "bvh/packet16/embree_medium/a/primary/math:fast/api:embree",
                                        "bvh/packet16/embree_robust/a/primary/math:fast/api:embree"}));
}

TEST(Rows, embree_has_one_row_whatever_the_math_modes_and_orders)
{
    const auto list =
        names({"bench", "--math", "exact,fast", "--order", "input,chains", "--layout", "tet80,embree"}, {"a"});
    EXPECT_EQ(std::count_if(list.begin(), list.end(),
                            [](const auto& name) { return name.find("api:embree") + 10 == name.size(); }),
              4);
    EXPECT_NE(std::find(list.begin(), list.end(), "cdt/maria/tet80/a/primary/math:exact/order:input/api:openmp"),
              list.end());
    EXPECT_NE(std::find(list.begin(), list.end(), "cdt/maria/tet80/a/primary/math:exact/api:openmp"), list.end());
}

TEST(Rows, values_given_twice_give_a_row_once)
{
    EXPECT_EQ(names({"bench", "--layout", "tet80,tet80", "--order", "input,input"}, {"a"}).size(), 1u);
}

TEST(Rows, the_filter_is_a_search_in_names)
{
    EXPECT_EQ(names({"bench", "--filter", "tet80|packet16/embree/"}, {"a"}).size(), 2u);
    EXPECT_EQ(names({"bench", "--filter", "/b/.*openmp$"}, {"a", "b"}).size(), 8u);
}

TEST(Rows, an_empty_selection_is_an_error_that_says_so)
{
    try {
        static_cast<void>(names({"bench", "--filter", "tet97"}, {"a"}));
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("matches none of the 19 rows"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("cdt/maria/tet96/a"), std::string::npos) << error.what();
    }
    try {
        static_cast<void>(names({"bench", "--backend", "embree", "--method", "maria"}, {"a"}));
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("Embree traces its own BVH only"), std::string::npos) << error.what();
    }
}

TEST(Rows, no_filter_takes_the_stack_or_for_ever)
{
    std::string nested(12'000, '('), evil = "(x+x+)+y", many = std::string(5000, 'x');
    nested += "tet80" + std::string(12'000, ')');
    for (const std::string& filter : {nested, evil, many, std::string("((a{1000}){1000}){1000}")}) {
        try {
            EXPECT_FALSE(NameFilter("--filter", filter).keeps(std::string(1000, 'x')));
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            EXPECT_LT(std::string(error.what()).size(), 600u) << "the message is short, however long the filter";
        }
    }
    EXPECT_TRUE(NameFilter("--filter", "").keeps("anything"));
    EXPECT_TRUE(contains(error_of([] { NameFilter("--filter", "(?=a)"); }), "usage: --filter: '(?=a)' is not"));
}

TEST(Rows, google_benchmarks_filter_negates_with_a_minus)
{
    EXPECT_TRUE(benchmark_filter_keeps("", "x"));
    EXPECT_TRUE(benchmark_filter_keeps("all", "x"));
    EXPECT_TRUE(benchmark_filter_keeps("maria.*openmp$", "cdt/maria/api:openmp"));
    EXPECT_FALSE(benchmark_filter_keeps("-maria", "cdt/maria/api:openmp"));
    EXPECT_THROW(static_cast<void>(benchmark_filter_keeps("(", "x")), Error);
}

TEST(Rows, kinds_and_orders_of_given_rays_are_rows_of_the_kernels_that_take_rays)
{
    OldHost old;
    const auto rows = select_rows(parse_options({"bench", "--method", "ms06,maria,project", "--layout", "tet80",
                                                 "--rays", "primary,ao,diffuse", "--ray-order", "tiles,shuffled"}),
                                  {"s"}, {&old});
    ASSERT_EQ(rows.size(), 3u + 8u) << "three methods trace primary rays, maria and project are given others";
    EXPECT_EQ(row_name(rows[3]), "cdt/maria/tet80/s/ao/math:exact/api:old");
    EXPECT_EQ(row_name(rows[4]), "cdt/project/tet80/s/ao/math:exact/api:old");
    EXPECT_EQ(row_name(rows[5]), "cdt/maria/tet80/s/ao/math:exact/rays:shuffled/api:old");
    EXPECT_EQ(kernel_title(rows[5]), "cdt maria tet80, ao shuffled");
    EXPECT_EQ(rows[5].kernel.task, Task::rays);
    EXPECT_EQ(rows[0].kernel.task, Task::trace);
}

TEST(Rows, segments_are_rows_of_their_own_on_given_rays_without_an_end)
{
    const auto rows = names({"bench", "--task", "trace,segments", "--layout", "tet80,half32,tet64,bvh2", "--backend",
                             "openmp", "--schedule", "tiles", "--rays", "primary,ao,random", "--filter", "segments"},
                            {"s"});
    EXPECT_EQ(rows, (std::vector<std::string>{"segments/maria/tet80/s/primary/math:exact/api:openmp",
                                              "segments/project/half32/s/primary/math:exact/api:openmp",
                                              "segments/project/tet64/s/primary/math:exact/api:openmp",
                                              "segments/maria/tet80/s/random/math:exact/api:openmp",
                                              "segments/project/half32/s/random/math:exact/api:openmp",
                                              "segments/project/tet64/s/random/math:exact/api:openmp"}));
    for (const char* const rays : {"ao", "shadow"})
        EXPECT_THROW(static_cast<void>(names({"bench", "--task", "segments", "--rays", rays}, {"s"})), Error) << rays;
    EXPECT_THROW(static_cast<void>(parse_options({"bench", "--task", "search"})), Error);
}

TEST(Rows, bvhs_of_ours_have_math_modes_and_schedules_and_embrees_do_not)
{
    const auto bvhs =
        names({"bench", "--structure", "bvh", "--layout", "bvh2,cwbvh,embree", "--math", "exact,fast"}, {"s"});
    EXPECT_EQ(
        bvhs,
        (std::vector<std::string>{
            "bvh/single/bvh2/s/primary/math:exact/api:openmp", "bvh/single/cwbvh/s/primary/math:exact/api:openmp",
            "bvh/single/bvh2/s/primary/math:fast/api:openmp", "bvh/single/cwbvh/s/primary/math:fast/api:openmp",
            "bvh/single/embree/s/primary/math:fast/api:embree", "bvh/packet8/embree/s/primary/math:fast/api:embree",
            "bvh/packet16/embree/s/primary/math:fast/api:embree", "bvh/stream/embree/s/primary/math:fast/api:embree"}));
}
