#pragma once

#include "core/base/exact.h"

#include <cstdint>

namespace tetrace::test {

/// A counter-based generator: number n of a stream is the same on every machine (splitmix64's finalizer).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return z ^ z >> 31;
    }
    /// In [0, 1), a multiple of 2^-24.
    float unit() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
    float between(float low, float high) { return low + (high - low) * unit(); }
    std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(bits() % limit); }
    Float3 point(float low, float high)
    {
        const float x = between(low, high), y = between(low, high), z = between(low, high);
        return snap_to_grid(Float3{x, y, z});
    }

private:
    std::uint64_t state_;
};

} // namespace tetrace::test
