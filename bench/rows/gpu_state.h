#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What a GPU tells of itself at a moment; what it does not tell is left out.
struct GpuState {
    std::optional<double> clock_mhz, memory_clock_mhz, power_w, temperature_c;
    /// Why its clocks are lower than they could be, for example "power"; empty where they are not, or it does not tell.
    std::string throttled;
};

/// What the GPU of a row told while the row's samples were taken.
struct GpuReadings {
    std::vector<GpuState> states; ///< one a sample that was kept, while its last view was traced
    std::uint32_t dropped = 0;    ///< samples that were taken again, since the GPU was throttled
    std::string reasons;          ///< each once, of dropped samples and of those that had to be kept

    /// Samples that were kept although the GPU was throttled: it still was when they had been taken again.
    [[nodiscard]] std::uint32_t throttled() const;
    /// The median over the samples; empty where none tells.
    [[nodiscard]] std::optional<double> median(std::optional<double> GpuState::*member) const;
    void add_reason(const std::string& reason);
    /// Adds those of other samples.
    void add(const GpuReadings& others);
};

} // namespace tetrace
