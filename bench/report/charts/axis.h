#pragma once

#include "bench/report/html/html.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// An axis of a chart: maps values to positions, with round ticks that enclose the values.
class Axis {
public:
    /// Ticks at 1, 2 or 5 times a power of ten, about `intervals` of them between low and high, which are rounded
    /// outwards to ticks. The axis has a length even where low equals high, also at 0.
    /// Throws Error{internal} if low or high is not finite, or low is above high.
    static Axis linear(double low, double high, int intervals = 5);

    /// Ticks at powers of ten, and at 2 and 5 times them where low and high are within a factor of 1,000; both are
    /// rounded outwards to ticks. Also throws Error{internal} where low is not positive.
    static Axis logarithmic(double low, double high);

    /// From zero to exactly `high`, with round ticks in between: for bars, whose ends need no enclosing tick.
    /// Throws Error{internal} if high is negative or not finite.
    static Axis from_zero(double high, int intervals = 4);

    /// Logarithmic, with ticks only at the given values; from the lowest over `margin` to the highest times `margin`.
    /// Throws Error{internal} if a value is not positive and finite, or there are none.
    static Axis logarithmic_at(std::vector<double> values, double margin);

    /// Of days since 1970-01-01 UTC: ticks at whole hours, days or weeks, labelled as dates; both ends are rounded
    /// outwards to ticks. Throws as linear() does.
    static Axis dates(double low, double high);

    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const { return high_; }
    [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }

    /// Position of a value when the axis runs from position `begin` to position `end`. Values outside the axis are
    /// placed at its ends. Throws Error{internal} if the value is not finite.
    [[nodiscard]] double place(double value, double begin, double end) const;

    /// A tick's label, with as many decimals as the step between ticks needs, and commas between thousands.
    [[nodiscard]] std::string label(double tick) const;

private:
    /// Ticks ascend; there is at least one.
    Axis(bool logarithmic, double low, double high, std::vector<double> ticks)
        : logarithmic_(logarithmic), low_(low), high_(high), ticks_(std::move(ticks))
    {
    }
    static Axis between(bool logarithmic, std::vector<double> ticks);

    bool logarithmic_;
    bool dates_ = false;
    double low_, high_;
    std::vector<double> ticks_;
};

/// A number with three significant digits, all digits before the point, and commas between thousands: 0.0123, 5.10,
/// 23.0, 1,234. Very small and very large numbers have an exponent.
[[nodiscard]] std::string short_number(double value);

/// A number with the given number of decimals (not negative), and commas between thousands. Numbers smaller than the
/// last decimal, and numbers from 1e15 on, get three significant digits. Only 0 is shown as 0.
[[nodiscard]] std::string fixed_number(double value, int decimals);

/// A share as a percentage: 8.1 %, 14 %.
[[nodiscard]] std::string short_percent(double share);

/// Moves positions apart. The result keeps their order and a distance of `gap`, within [low, high] as far as they fit,
/// and moves each as little as possible (least squares, by pooling adjacent violators). positions: any order; the
/// result has the same order of elements.
[[nodiscard]] std::vector<double> spread_apart(const std::vector<double>& positions, double gap, double low,
                                               double high);

/// Least distance between the labels in the column to the right of a plot.
inline constexpr double side_label_pitch = 17;

/// Room for a series' shape before its label.
inline constexpr double side_key_width = 13;

/// Where a plot must end so that labels of that width fit to its right; the plot keeps at least half of the drawing.
[[nodiscard]] double side_labels_left(double max_label);

/// A label right of a plot that ends at plot_right, at height label_y, with a thin line from the point that it labels,
/// and with the shape of its series before it where one is given.
[[nodiscard]] Html side_label(double point_x, double point_y, double plot_right, double label_y,
                              const std::string& label, std::optional<std::size_t> series = {});

/// Grid lines with their labels: below the plot for a horizontal axis, left of it for a vertical one. A label is left
/// out if its neighbour leaves no space for it.
[[nodiscard]] Html horizontal_ticks(const Axis& axis, double left, double right, double top, double bottom);
[[nodiscard]] Html vertical_ticks(const Axis& axis, double left, double right, double top, double bottom);

} // namespace tetrace
