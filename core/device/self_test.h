#pragma once

#include "core/device/backend.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// How a device computes in a math mode, measured by kernels/probe.h; recorded with every result.
struct SelfTest {
    bool contracts = false;             ///< x * y + z is rounded once
    bool reassociates = false;          ///< (x + z) - z is x: sums or products are not computed as they are written
    bool denormals_kept = true;         ///< false: sums or products flush them to zero
    std::uint32_t division_ulps = 0;    ///< largest error found; 0: correctly rounded
    std::uint32_t square_root_ulps = 0; ///< the same
    bool sums_right = true;             ///< sums and products of normal numbers, correctly rounded
    bool comparisons_right = true;
    bool integers_right = true;
    bool conversions_right = true; ///< uint to float, correctly rounded
    bool bits_kept = true;         ///< words that are NaNs or denormals as floats are copied unchanged

    friend bool operator==(const SelfTest&, const SelfTest&) = default;

    /// Whether decisions can be the same bits as on the host: all of the above except the ulps and the denormals.
    [[nodiscard]] bool is_exact() const
    {
        return !contracts && !reassociates && sums_right && comparisons_right && integers_right && conversions_right &&
               bits_kept;
    }
    /// Units in the last place by which t, u and v may differ: 0 where division is correctly rounded, else 3.
    [[nodiscard]] std::uint32_t allowed_ulps() const;
    /// In one line: "exact; division correctly rounded, denormals kept".
    [[nodiscard]] std::string text() const;
    /// "exact", or only what deviates, for a narrow column: "contracts, division 2 ulp, denormals flushed".
    [[nodiscard]] std::string brief() const;
};

/// The operations to run: some hundreds of quads {operation, a, b, c}.
[[nodiscard]] const std::vector<Quad>& self_test_operations();

/// results: one word for each of self_test_operations(). Throws Error{internal} if the counts differ.
[[nodiscard]] SelfTest judge_self_test(std::span<const std::uint32_t> results);

} // namespace tetrace
