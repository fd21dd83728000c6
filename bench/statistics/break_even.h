#pragma once

#include <optional>

namespace tetrace {

/// What tracing with a structure takes: once, to make it, and then each ray. Seconds.
struct TotalCost {
    double once_s = 0;
    double ray_s = 0;
};

/// Which of two structures takes less in all, once there are rays enough.
struct BreakEven {
    enum class Ahead { neither, first, second };
    Ahead ahead = Ahead::neither;
    /// The rays from which on it is ahead, the other one before; empty if it is so from the first ray on.
    std::optional<double> rays;
};

/// The one with the faster rays is ahead in the end; one with a faster build is ahead only until that is paid off; of
/// equal rays the faster build decides, for any number of them. Precondition: all are finite and not negative.
[[nodiscard]] BreakEven break_even(const TotalCost& first, const TotalCost& second);

} // namespace tetrace
