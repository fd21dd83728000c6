#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What a GPU reports at a moment; what it does not report is left out.
struct GpuState {
    std::optional<double> clock_mhz, memory_clock_mhz, power_w, temperature_c;
    /// Why its clocks are lower than they could be, for example "power"; empty if they are not, or it does not tell.
    std::string throttled;
};

/// Medians of what a row's GPU reported while the samples were taken; what it did not report is left out.
struct GpuSummary {
    std::optional<double> clock_mhz, memory_clock_mhz, power_w, temperature_c;
    std::uint32_t dropped_samples = 0;   ///< taken again, since the GPU was throttled
    std::uint32_t throttled_samples = 0; ///< kept although the GPU was throttled: it still was in the third attempt
    std::string throttled_by;            ///< each reason once, of dropped samples and of throttled ones
};

/// What the GPU of a row reported while the row's samples were taken.
struct GpuReadings {
    std::vector<GpuState> states; ///< one a sample that was kept, while its last view was traced
    std::uint32_t dropped = 0;    ///< samples that were taken again, since the GPU was throttled
    std::string reasons;          ///< each once, of dropped samples and of those that had to be kept

    /// Samples that were kept although the GPU was throttled: it still was when they had been taken again.
    [[nodiscard]] std::uint32_t throttled() const;
    /// The median over the samples; empty if none tells.
    [[nodiscard]] std::optional<double> median(std::optional<double> GpuState::*member) const;
    [[nodiscard]] GpuSummary summary() const;
    void add_reason(const std::string& reason);
    /// Adds those of other samples.
    void add(const GpuReadings& others);
};

} // namespace tetrace
