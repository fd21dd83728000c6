#include "bench/rows.h"
#include "core/error.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace tetrace;

namespace {

std::vector<std::string> names(const std::vector<std::string>& arguments, const std::vector<std::string>& scenes)
{
    std::vector<std::string> list;
    for (const RowKey& key : select_rows(parse_options(arguments), scenes))
        list.push_back(row_name(key));
    return list;
}

/// A backend that has every kernel of structure cdt, on a host that runs none of math mode fast.
class OldHost : public Backend {
public:
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
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode, std::span<const Row>) override { return {}; }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    std::vector<Device> devices_ = {Device{}};
};

} // namespace

TEST(rows, a_kernel_that_the_host_cannot_run_is_a_row_and_one_that_the_backend_lacks_is_none)
{
    OldHost old;
    const auto rows = select_rows(parse_options({"bench", "--math", "exact,fast"}), {"a"}, {&old});
    EXPECT_EQ(rows.size(), 4u);
    EXPECT_EQ(
        std::count_if(rows.begin(), rows.end(), [](const RowKey& key) { return key.kernel.math == MathMode::fast; }),
        2);
    EXPECT_TRUE(std::none_of(rows.begin(), rows.end(),
                             [](const RowKey& key) { return key.kernel.structure == Structure::bvh; }));
}

TEST(rows, the_default_is_maria_on_both_layouts_beside_embree)
{
    EXPECT_EQ(names({"bench"}, {"bunny"}),
              (std::vector<std::string>{"cdt/maria/tet80/bunny/primary/math:exact/api:openmp",
                                        "cdt/maria/tet96/bunny/primary/math:exact/api:openmp",
                                        "bvh/single/embree/bunny/primary/math:fast/api:embree",
                                        "bvh/packet16/embree/bunny/primary/math:fast/api:embree"}));
}

TEST(rows, options_select_and_rows_go_scene_after_scene)
{
    EXPECT_EQ(names({"bench", "--layout", "tet96"}, {"a", "b"}),
              (std::vector<std::string>{"cdt/maria/tet96/a/primary/math:exact/api:openmp",
                                        "cdt/maria/tet96/b/primary/math:exact/api:openmp"}));
    EXPECT_EQ(names({"bench", "--backend", "embree", "--method", "packet16"}, {"a"}),
              std::vector<std::string>{"bvh/packet16/embree/a/primary/math:fast/api:embree"});
}

TEST(rows, embree_has_one_row_whatever_the_math_modes_and_orders)
{
    const auto list =
        names({"bench", "--math", "exact,fast", "--order", "input,hilbert", "--layout", "tet80,embree"}, {"a"});
    EXPECT_EQ(std::count_if(list.begin(), list.end(),
                            [](const auto& name) { return name.find("api:embree") + 10 == name.size(); }),
              2);
    EXPECT_NE(std::find(list.begin(), list.end(), "cdt/maria/tet80/a/primary/math:exact/order:input/api:openmp"),
              list.end());
    EXPECT_NE(std::find(list.begin(), list.end(), "cdt/maria/tet80/a/primary/math:exact/api:openmp"), list.end());
}

TEST(rows, values_given_twice_give_a_row_once)
{
    EXPECT_EQ(names({"bench", "--layout", "tet80,tet80", "--order", "input,input"}, {"a"}).size(), 1u);
}

TEST(rows, the_filter_is_a_search_in_names)
{
    EXPECT_EQ(names({"bench", "--filter", "tet80|packet"}, {"a"}).size(), 2u);
    EXPECT_EQ(names({"bench", "--filter", "/b/.*openmp$"}, {"a", "b"}).size(), 2u);
}

TEST(rows, an_empty_selection_is_an_error_that_says_so)
{
    try {
        static_cast<void>(names({"bench", "--filter", "tet97"}, {"a"}));
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("matches none of the 4 rows"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("cdt/maria/tet96/a"), std::string::npos) << error.what();
    }
    try {
        static_cast<void>(names({"bench", "--backend", "embree", "--method", "maria"}, {"a"}));
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("Embree traces its own BVH only"), std::string::npos) << error.what();
    }
}

TEST(rows, google_benchmarks_filter_negates_with_a_minus)
{
    EXPECT_TRUE(benchmark_filter_keeps("", "x"));
    EXPECT_TRUE(benchmark_filter_keeps("all", "x"));
    EXPECT_TRUE(benchmark_filter_keeps("maria.*openmp$", "cdt/maria/api:openmp"));
    EXPECT_FALSE(benchmark_filter_keeps("-maria", "cdt/maria/api:openmp"));
    EXPECT_THROW(static_cast<void>(benchmark_filter_keeps("(", "x")), Error);
}
