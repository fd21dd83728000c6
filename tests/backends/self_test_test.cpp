// The self-test calls the host exact, and finds each way in which a device's arithmetic may differ.
#include "backends/openmp/backend.h"
#include "core/base/exact.h"
#include "core/device/self_test.h"
#include "kernels/layouts/probe_chains.h"
#include "tests/support/temporary_folder.h"

#include <bit>
#include <cmath>
#include <functional>

using namespace tetrace;
using namespace tetrace::test;

namespace tetrace::openmp {
std::vector<std::uint32_t> probe_unsafe(std::span<const Quad> operations); // probe.cpp with -Ofast
} // namespace tetrace::openmp

namespace {

/// Results of a device that computes as the host does.
std::vector<std::uint32_t> right_results()
{
    return openmp_backend().probe(0, MathMode::exact, self_test_operations());
}

/// The results with those of one operation changed.
SelfTest judged_with(std::uint32_t operation, const std::function<std::uint32_t(const Quad&, std::uint32_t)>& change)
{
    auto results = right_results();
    for (std::size_t i = 0; i < results.size(); ++i)
        if (self_test_operations()[i].x == operation) results[i] = change(self_test_operations()[i], results[i]);
    return judge_self_test(results);
}

float number(std::uint32_t word)
{
    return std::bit_cast<float>(word);
}

} // namespace

TEST(SelfTest, the_host_is_exact)
{
    const SelfTest test = judge_self_test(right_results());
    EXPECT_EQ(test, SelfTest{});
    EXPECT_TRUE(test.is_exact());
    EXPECT_EQ(test.allowed_ulps(), 0u);
}

TEST(SelfTest, finds_contraction)
{
    const auto fused = [](const Quad& quad, std::uint32_t) {
        return std::bit_cast<std::uint32_t>(std::fma(number(quad.y), number(quad.z), number(quad.w)));
    };
    const SelfTest test = judged_with(PROBE_MULTIPLY_ADD, fused);
    EXPECT_TRUE(test.contracts);
    EXPECT_FALSE(test.is_exact());
    EXPECT_TRUE(contains(test.text(), "contracts"));
    EXPECT_TRUE(contains(test.brief(), "contracts"));
}

TEST(SelfTest, finds_reassociation)
{
    const auto shortened = [](const Quad& quad, std::uint32_t) { return quad.y; };
    for (const std::uint32_t operation : {PROBE_SPLIT, PROBE_CANCEL, PROBE_SCALE}) {
        const SelfTest test = judged_with(operation, shortened);
        EXPECT_TRUE(test.reassociates) << operation;
        EXPECT_FALSE(test.is_exact());
        EXPECT_EQ(test.brief(), "reassociates");
    }
}

TEST(SelfTest, a_build_that_reassociates_is_not_exact)
{
    const SelfTest test = judge_self_test(openmp::probe_unsafe(self_test_operations()));
    EXPECT_TRUE(test.reassociates) << test.text();
    EXPECT_FALSE(test.contracts) << "only its order of operations is wrong";
    EXPECT_FALSE(test.is_exact());
}

TEST(SelfTest, an_opencl_compiler_that_may_reassociate_is_not_exact)
{
    Backend* const opencl = find_backend("opencl");
    if (opencl == nullptr || !opencl->devices().front().usable) GTEST_SKIP() << "an OpenCL device is missing";
    const SelfTest test = judge_self_test(opencl->probe(0, MathMode::fast, self_test_operations()));
    if (!opencl->devices().front().implementation.starts_with("pocl-3.1")) GTEST_SKIP() << test.text();
    EXPECT_TRUE(test.reassociates) << test.text();
    EXPECT_FALSE(test.is_exact());
}

TEST(SelfTest, measures_division_and_decides_the_tolerance)
{
    const auto off = [](const Quad&, std::uint32_t right) { return right + 2; };
    const SelfTest test = judged_with(PROBE_DIVIDE, off);
    EXPECT_EQ(test.division_ulps, 2u);
    EXPECT_TRUE(test.is_exact());
    EXPECT_EQ(test.allowed_ulps(), 3u);
    EXPECT_EQ(judged_with(PROBE_SQUARE_ROOT, off).square_root_ulps, 2u);
}

TEST(SelfTest, finds_each_other_defect)
{
    const auto flushed = [](const Quad&, std::uint32_t right) {
        return std::fpclassify(number(right)) == FP_SUBNORMAL ? right & 0x80000000u : right;
    };
    EXPECT_FALSE(judged_with(PROBE_MULTIPLY, flushed).denormals_kept);
    EXPECT_TRUE(judged_with(PROBE_MULTIPLY, flushed).is_exact()) << "no decision meets a denormal";
    EXPECT_FALSE(judged_with(PROBE_COPY, flushed).bits_kept);
    const auto off = [](const Quad&, std::uint32_t right) { return right + 1; };
    EXPECT_FALSE(judged_with(PROBE_ADD, off).sums_right);
    EXPECT_FALSE(judged_with(PROBE_CONVERT, off).conversions_right);
    EXPECT_FALSE(judged_with(PROBE_COMPARE, off).comparisons_right);
    EXPECT_FALSE(judged_with(PROBE_INTEGER, off).integers_right);
}

TEST(SelfTest, the_hosts_fast_mode_contracts)
{
    if (const auto reason = openmp_backend().why_not(0, {.math = MathMode::fast}); !reason.empty())
        GTEST_SKIP() << reason;
    EXPECT_TRUE(judge_self_test(openmp_backend().probe(0, MathMode::fast, self_test_operations())).contracts);
}
