#include "core/device/stressors.h"

#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <utility>

namespace tetrace {

namespace {

// What each kernel returns, by other means: 64-bit words, exact arithmetic.

constexpr std::uint32_t golden = 2654435761u;

/// Of item numbers, as the kernels scatter them: 22 bits.
std::uint32_t scattered(std::uint32_t item)
{
    return (item * golden) >> 10;
}

std::uint32_t hash_of_floats(std::initializer_list<float> values)
{
    std::uint32_t hash = 0;
    for (const float value : values)
        hash = hash * 31 + std::bit_cast<std::uint32_t>(value);
    return hash;
}

/// The zoo's state; word i of the buffer is i.
struct Zoo {
    std::uint32_t sum;
    std::array<std::uint32_t, 4> ways = {};
    bool is_over = false;

    /// False if the inner loop ends.
    bool pass(std::uint32_t outer, std::uint32_t word, std::uint32_t inner)
    {
        const std::uint32_t kind = (word + inner) % 7;
        if (kind == 2) return true;
        if (kind == 0) sum += 3;
        if (kind <= 1) sum *= 5;
        if (kind == 3) sum ^= word;
        if (kind >= 3) sum += inner;
        if (sum % 4 != 1) {
            sum += 7;
            if ((sum & 4) != 0) sum ^= 5;
        }
        ways[sum % 4] = inner + 1;
        sum += (inner + 1) * 256;
        is_over = sum / 256 % 64 == 17;
        if (is_over) sum = sum * 3 + outer;
        return !is_over && sum / 256 % 16 != 9;
    }
};

std::uint32_t denormal_word(std::uint32_t item)
{
    return scattered(item) + 1;
}

std::uint32_t pairs_under_pressure(std::uint32_t item)
{
    std::array<std::uint64_t, 16> numbers;
    for (std::uint32_t i = 0; i < numbers.size(); ++i)
        numbers[i] = std::uint64_t{i} << 32 | item * (2 * i + 1);
    const std::uint32_t rounds = item < 4096 ? 256 : 4;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        const std::uint32_t factor = ((round + item) % 64 * (golden - 1)) | 1;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const std::uint64_t sum = numbers[i] * factor + numbers[(i + 1) % numbers.size()];
            numbers[i] = sum ^ sum >> 29;
        }
    }
    const std::uint64_t all = std::accumulate(numbers.begin(), numbers.end(), std::uint64_t{0});
    return static_cast<std::uint32_t>(all) ^ static_cast<std::uint32_t>(all >> 32) * 31;
}

std::uint32_t array_by_dynamic_index(std::uint32_t item)
{
    std::array<std::uint32_t, 16> own;
    std::iota(own.begin(), own.end(), 0u);
    std::uint32_t sum = item * golden;
    const std::uint32_t rounds = item < 4096 ? 64 : 8;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        const std::uint32_t a = ((round + item) % 64 + round) % 16, b = sum / 8 % 16;
        auto changed = own;
        changed[a] = own[b] + 16;
        changed[b] = 99;
        sum = sum * 31 + changed[(a + 1) % 16] * 7 + changed[a] * 3 + 99;
        std::swap(own[a], own[b]);
        sum += own[a ^ b];
    }
    for (const std::uint32_t place : own)
        sum = sum * 31 + place;
    return sum;
}

std::uint32_t zoo_of_exits(std::uint32_t item)
{
    Zoo zoo{item * golden};
    for (std::uint32_t outer = 0; outer < (item < 4096 ? 12u : 2u); ++outer) {
        for (std::uint32_t inner = 0; inner < 8 && zoo.pass(outer, (outer * 5 + item) % 64, inner); ++inner) {
        }
        if (zoo.is_over) return zoo.sum;
        if (zoo.sum / 256 % 128 == 77) return zoo.sum ^ 0x5A5A5A5A;
    }
    return zoo.sum + zoo.ways[0];
}

std::uint32_t loops_that_data_end(std::uint32_t item)
{
    std::uint32_t steps = 0, odd_steps = 0;
    for (std::uint32_t at = item % 64; at != (item * 7 + 5) % 64; at = (at * 5 + 3) % 64)
        ++steps;
    const std::uint32_t first = item % (item < 4096 ? 1024 : 32) + 1;
    for (std::uint32_t number = first; number != 1; number = number % 2 == 0 ? number / 2 : number * 3 + 1)
        odd_steps += number % 2;
    const std::uint32_t place = steps + item % 32 + 1;
    const bool is_inside = place < 64;
    const std::uint32_t reduced = is_inside ? place : 43 + (place - 64) % 21;
    return ((reduced * 64 + odd_steps) * 2048 + (is_inside ? place : 1000 + place)) ^ (item * golden);
}

std::uint32_t lost_in_sums(std::uint32_t item)
{
    const double a = 8388608 + scattered(item);
    const double b = (2 * ((item * 747796405 + item % 64) % 2048) + 1) / 4096.0;
    const auto sum = static_cast<float>(a + b); // doubles hold the sum and its error
    const auto lost = static_cast<float>(a + b - sum);
    return hash_of_floats(
        {sum, lost, lost, lost, lost, lost, lost, lost, lost, -lost, -lost, lost, lost, -lost, -lost});
}

std::uint32_t lost_in_products(std::uint32_t item)
{
    const std::uint64_t a = 8388609 + 2 * scattered(item);
    const std::uint64_t b = 8388609 + 2 * ((item * 747796405 + item % 64 * 65536) % 4194304);
    const auto product = static_cast<float>(a * b);
    const auto lost = static_cast<float>(static_cast<std::int64_t>(a * b) - static_cast<std::int64_t>(product));
    return hash_of_floats({product, lost, lost, 0.0f, lost, lost, lost, lost, -lost, -lost, lost, lost, -lost, -lost});
}

std::uint32_t denormals_copied(std::uint32_t item)
{
    return denormal_word(item) + item % 4;
}

std::uint32_t denormals_selected(std::uint32_t item)
{
    return item % 64 % 3 == 0 ? denormal_word(item) + 1 : 0x80000000u | denormal_word(item);
}

std::uint32_t denormals_in_minima(std::uint32_t item)
{
    return denormal_word(item);
}

std::uint32_t denormals_in_maxima(std::uint32_t item)
{
    return denormal_word(item) + 1;
}

/// Bits of denormal_word() times 2^24, a normal number.
std::uint32_t normal_word(std::uint32_t item)
{
    return std::bit_cast<std::uint32_t>(std::ldexp(static_cast<float>(denormal_word(item)), 24 - 149));
}

std::uint32_t denormals_multiplied(std::uint32_t item)
{
    return 2 * (denormal_word(item) + 1) * 31 + normal_word(item);
}

// As OpenCL and Vulkan allow of arithmetic, for each operation and item: copies and selects keep all bits.

/// A comparison that flushes its operands finds two zeros, and may return either denormal.
bool is_flushed_extremum(std::uint32_t item, std::uint32_t word)
{
    return word == 0 || word == denormal_word(item) || word == denormal_word(item) + 1;
}

/// Either product may be zero.
bool is_flushed_product(std::uint32_t item, std::uint32_t word)
{
    return word == 0 || word == normal_word(item) || word == denormals_multiplied(item) - normal_word(item);
}

} // namespace

std::span<const Defect> all_stressors()
{
    static constexpr Defect stressors[] = {
        {"pairs_under_pressure", "64-bit arithmetic by pairs of words, 16 of them alive in a loop that loads",
         "IGC#416", pairs_under_pressure, true},
        {"array_by_dynamic_index", "a private array with a dynamic index, in a struct that is passed by value",
         "IGC#392, clspv#119", array_by_dynamic_index, true},
        {"zoo_of_exits", "fall-through, continue and return in nested loops, loops of one round, dead branches",
         "ROCm#1182, DXC#5302, DXC#6561, compute-runtime#394", zoo_of_exits, true},
        {"loops_that_data_end", "loops that only data end, and bound checks after them",
         "wgpu#4972, wgpu#6528, DXC#6721", loops_that_data_end, true},
        {"lost_in_sums", "what float sums lose (TwoSum, Dekker), in many spellings, that of vectors too",
         "slang#11933, SPIRV-Cross#1748, MoltenVK#1209", lost_in_sums, true},
        {"lost_in_products", "what float products lose (Dekker's TwoProd), in many spellings, that of vectors too",
         "slang#11933, SPIRV-Cross#1748, MoltenVK#1209", lost_in_products, true},
        {"denormals_copied", "denormals through an array", "clspv#1646", denormals_copied, true},
        {"denormals_selected", "denormals through a select", "clspv#1646", denormals_selected, true},
        {"denormals_in_minima", "the lesser of two denormals", "clspv#1646", denormals_in_minima, true,
         is_flushed_extremum},
        {"denormals_in_maxima", "the greater of two denormals", "clspv#1646", denormals_in_maxima, true,
         is_flushed_extremum},
        {"denormals_multiplied", "denormals times powers of two", "clspv#1646", denormals_multiplied, true,
         is_flushed_product},
    };
    return stressors;
}

} // namespace tetrace
