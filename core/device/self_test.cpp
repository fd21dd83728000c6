#include "core/device/self_test.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "kernels/layouts/probe_chains.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace tetrace {

namespace {

constexpr std::uint32_t min_normal = 0x00800000u;

std::uint32_t bits(float value)
{
    return std::bit_cast<std::uint32_t>(value);
}
float number(std::uint32_t word)
{
    return std::bit_cast<float>(word);
}

bool is_denormal(float value)
{
    return std::fpclassify(value) == FP_SUBNORMAL;
}

/// Numbers of either sign between 2^-20 and 2^20: no operation on three of them gives a denormal or infinite result.
class Numbers {
public:
    float next()
    {
        const auto word = static_cast<std::uint32_t>(engine_());
        const std::uint32_t exponent = 127 - 20 + (word >> 24) % 41;
        return number((word & 0x80000000u) | exponent << 23 | (word & 0x007FFFFFu));
    }
    std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }

private:
    std::mt19937_64 engine_{20170401}; // fixed: every device runs the same operations
};

std::vector<Quad> make_operations()
{
    std::vector<Quad> quads;
    Numbers numbers;
    for (int i = 0; i < 64; ++i) {
        const float a = numbers.next(), b = numbers.next(), c = numbers.next();
        // Subtracts the rounded product: 0 with two roundings, the product's error with one.
        quads.push_back({PROBE_MULTIPLY_ADD, bits(a), bits(b), bits(-(a * b))});
        quads.push_back({PROBE_MULTIPLY_ADD, bits(a), bits(b), bits(c)});
        quads.push_back({PROBE_DIVIDE, bits(a), bits(b), 0});
        quads.push_back({PROBE_SQUARE_ROOT, bits(std::fabs(a)), 0, 0});
        quads.push_back({PROBE_ADD, bits(a), bits(b), 0});
        quads.push_back({PROBE_MULTIPLY, bits(a), 0, bits(b)});
        quads.push_back({PROBE_COMPARE, bits(a), bits(i % 3 == 0 ? a : b), 0});
        quads.push_back({PROBE_CONVERT, numbers.word() >> (i % 32), 0, 0});
        quads.push_back({PROBE_INTEGER, numbers.word(), numbers.word(), numbers.word()});
        quads.push_back({PROBE_COPY, numbers.word(), 0, 0});
        quads.push_back({PROBE_SPLIT, bits(a), 0, 0});
        quads.push_back({PROBE_CANCEL, bits(a), 0, bits(b)});
        quads.push_back({PROBE_SCALE, bits(a), 0, 0});
    }
    quads.push_back({PROBE_COMPARE, bits(0.0f), bits(-0.0f), 0});
    for (const std::uint32_t word : {0u, 1u, 0x00FFFFFFu, 0x01000001u, 0x01000003u, 0xFFFFFFFFu})
        quads.push_back({PROBE_CONVERT, word, 0, 0}); // halfway cases among them
    for (const std::uint32_t word : {0x7F800001u, 0xFFFFFFFEu, 0x00000001u, 0x807FFFFFu})
        quads.push_back({PROBE_COPY, word, 0, 0}); // a signalling NaN, a NaN with a payload, denormals
    // Denormal operands, and denormal results of normal operands.
    quads.push_back({PROBE_ADD, 1u, 1u, 0});
    quads.push_back({PROBE_ADD, min_normal + 1, min_normal | 0x80000000u, 0});
    quads.push_back({PROBE_MULTIPLY, min_normal, 0, bits(0.5f)});
    quads.push_back({PROBE_MULTIPLY, 3u, 0, bits(2.0f)});
    return quads;
}

/// The high half of Dekker's split.
float split(float x)
{
    const float large = x * 4097.0f;
    return large - (large - x);
}

/// What the C++ standard's arithmetic in round-to-nearest gives.
std::uint32_t expected(const Quad& quad)
{
    const float x = number(quad.y), y = number(quad.z), z = number(quad.w);
    switch (quad.x) {
    case PROBE_MULTIPLY_ADD: return bits(x * y + z);
    case PROBE_DIVIDE: return bits(x / y);
    case PROBE_ADD: return bits(x + y);
    case PROBE_MULTIPLY: return bits(x * z);
    case PROBE_SQUARE_ROOT: return bits(std::sqrt(x));
    case PROBE_SPLIT: return bits(split(x));
    case PROBE_CANCEL: return bits((x + z) - z);
    case PROBE_SCALE: return bits((x * 3.0f) * 5.0f);
    case PROBE_CONVERT: return bits(static_cast<float>(quad.y));
    case PROBE_COMPARE: return (x < y ? 1u : 0u) + (x <= y ? 2u : 0u) + (x == y ? 4u : 0u);
    case PROBE_INTEGER: return ((quad.y * quad.z + quad.w) >> (quad.w & 31u)) ^ (quad.y << (quad.z & 31u));
    default: return quad.y;
    }
}

bool involves_denormals(const Quad& quad)
{
    return is_denormal(number(quad.y)) || is_denormal(number(quad.z)) || is_denormal(number(quad.w)) ||
           is_denormal(number(expected(quad)));
}

void raise_to(std::uint32_t& largest, std::uint32_t result, std::uint32_t right)
{
    const std::uint64_t ulps = ulps_between(number(result), number(right));
    largest = std::max(
        largest, static_cast<std::uint32_t>(std::min<std::uint64_t>(ulps, std::numeric_limits<std::uint32_t>::max())));
}

void judge(SelfTest& test, const Quad& quad, std::uint32_t result)
{
    const std::uint32_t right = expected(quad);
    const bool same = result == right;
    switch (quad.x) {
    case PROBE_MULTIPLY_ADD:
        // A sum that cancels may give a zero of either sign; any other difference is a contraction.
        if (!same && number(result) != number(right)) test.contracts = true;
        break;
    case PROBE_DIVIDE: raise_to(test.division_ulps, result, right); break;
    case PROBE_SQUARE_ROOT: raise_to(test.square_root_ulps, result, right); break;
    case PROBE_ADD:
    case PROBE_MULTIPLY:
        if (involves_denormals(quad))
            test.denormals_kept = test.denormals_kept && same;
        else
            test.sums_right = test.sums_right && same;
        break;
    case PROBE_SPLIT:
        // Contraction, which the first operation shows, gives x too.
        if (!same && !test.contracts) test.reassociates = true;
        break;
    case PROBE_CANCEL:
    case PROBE_SCALE: test.reassociates = test.reassociates || !same; break;
    case PROBE_CONVERT: test.conversions_right = test.conversions_right && same; break;
    case PROBE_COMPARE: test.comparisons_right = test.comparisons_right && same; break;
    case PROBE_INTEGER: test.integers_right = test.integers_right && same; break;
    default: test.bits_kept = test.bits_kept && same; break;
    }
}

/// What makes decisions differ from the host's; empty for an exact device.
std::string inexact_text(const SelfTest& test)
{
    std::string text;
    const auto add = [&](bool applies, const char* what) {
        if (applies) text += std::string(text.empty() ? "" : ", ") + what;
    };
    add(test.contracts, "contracts");
    add(test.reassociates, "reassociates");
    add(!test.sums_right, "sums or products wrong");
    add(!test.comparisons_right, "comparisons wrong");
    add(!test.integers_right, "integers wrong");
    add(!test.conversions_right, "conversions wrong");
    add(!test.bits_kept, "words changed");
    return text;
}

std::string rounding_text(const char* what, std::uint32_t ulps)
{
    if (ulps == 0) return std::string(what) + " correctly rounded";
    return std::string(what) + " off by " + std::to_string(ulps) + " ulp";
}

} // namespace

std::uint32_t SelfTest::allowed_ulps() const
{
    constexpr std::uint32_t promised = 3; // Vulkan and OpenCL allow 2.5; openmp itself adds 0.5
    return division_ulps == 0 ? 0 : promised;
}

std::string SelfTest::text() const
{
    return (is_exact() ? "exact" : inexact_text(*this)) + "; " + rounding_text("division", division_ulps) + ", " +
           rounding_text("square root", square_root_ulps) + ", denormals " + (denormals_kept ? "kept" : "flushed");
}

std::string SelfTest::brief() const
{
    std::string text = is_exact() ? "exact" : inexact_text(*this);
    if (division_ulps > 0) text += ", division " + std::to_string(division_ulps) + " ulp";
    if (square_root_ulps > 0) text += ", root " + std::to_string(square_root_ulps) + " ulp";
    if (!denormals_kept) text += ", denormals flushed";
    return text;
}

const std::vector<Quad>& self_test_operations()
{
    static const std::vector<Quad> operations = make_operations();
    return operations;
}

SelfTest judge_self_test(std::span<const std::uint32_t> results)
{
    const auto& operations = self_test_operations();
    if (results.size() != operations.size())
        throw Error(ErrorKind::internal, "self-test: " + std::to_string(results.size()) + " results of " +
                                             std::to_string(operations.size()) + " operations");
    SelfTest test;
    for (std::size_t i = 0; i < results.size(); ++i)
        judge(test, operations[i], results[i]);
    return test;
}

} // namespace tetrace
