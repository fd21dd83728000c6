#include "bench/report/charts/axis.h"

#include "bench/report/html/svg.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace tetrace {

namespace {
constexpr double leader = 22; ///< length of the slanted part of the line, and space around it
} // namespace

double side_labels_left(double max_label)
{
    return std::max(chart_width / 2, chart_width - max_label - leader - 1);
}

Html side_label(double point_x, double point_y, double plot_right, double label_y, const std::string& label,
                std::optional<std::size_t> series)
{
    const double end = plot_right + leader, start = end + (series ? side_key_width : 0);
    return svg_path(fmt::format("M{:.1f} {:.1f}H{:.1f}L{:.1f} {:.1f}", point_x, point_y, plot_right, end - 4, label_y),
                    "leader") +
           (series ? svg_shape(end + 3, label_y, *series, "solid") : Html()) +
           svg_text(start, label_y + 4.5, "label", shortened(label, label_size, chart_width - start));
}

Html horizontal_ticks(const Axis& axis, double left, double right, double top, double bottom)
{
    Html ticks;
    double taken = std::numeric_limits<double>::lowest();
    for (const double tick : axis.ticks()) {
        const double x = axis.place(tick, left, right);
        ticks += svg_line(x, top, x, bottom, "grid");
        const std::string label = axis.label(tick);
        const double half = text_width(label, small_size) / 2;
        if (x - half < taken) continue;
        ticks += svg_text(x, bottom + 15, "small middle", label);
        taken = x + half + 6;
    }
    return ticks;
}

Html vertical_ticks(const Axis& axis, double left, double right, double top, double bottom)
{
    Html ticks;
    double taken = std::numeric_limits<double>::max();
    for (const double tick : axis.ticks()) {
        const double y = axis.place(tick, bottom, top);
        ticks += svg_line(left, y, right, y, "grid");
        if (y + small_size > taken) continue;
        ticks += svg_text(left - 6, y + 4, "small end", axis.label(tick));
        taken = y;
    }
    return ticks;
}

namespace {

void check_range(double low, double high)
{
    if (!std::isfinite(low) || !std::isfinite(high) || !std::isfinite(high - low) || low > high)
        throw Error(ErrorKind::internal, fmt::format("Axis: [{}, {}] is not a range", low, high));
}

void check_logarithm(double low)
{
    if (low < std::numeric_limits<double>::min())
        throw Error(ErrorKind::internal, fmt::format("Axis: {} cannot be on a logarithmic one", low));
}

/// The least 1, 2 or 5 times a power of ten that is at least `value`, up to rounding.
double round_step(double value)
{
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (value <= factor * power * (1 + 1e-9)) return factor * power;
    return 10 * power;
}

/// The n-th number of the series ..., 0.5, 1, 2, 5, 10, 20, ...; n = 0 gives 1.
double one_two_five(int n)
{
    const int decade = static_cast<int>(std::floor(n / 3.0));
    const double factors[] = {1, 2, 5};
    return factors[n - 3 * decade] * std::pow(10.0, decade);
}

std::vector<double> multiples(double step, double first, double last)
{
    std::vector<double> values;
    for (double i = first; i <= last; ++i)
        values.push_back(i * step);
    return values;
}

std::string with_decimals(double value, int decimals)
{
    std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
    const std::size_t point = std::min(digits.find('.'), digits.size());
    return fmt::format("{}{}{}", value < 0 ? "-" : "", with_commas(std::stoull(digits.substr(0, point))),
                       digits.substr(point));
}

constexpr double max_plain = 1e15;

/// Days between ticks, about four of them in the range: hours, days, weeks, then quarters and years.
double step_of_dates(double range)
{
    constexpr double steps[] = {1 / 24.0, 3 / 24.0, 6 / 24.0, 12 / 24.0, 1, 2, 7, 14, 28, 91, 182, 365};
    for (const double step : steps)
        if (range <= 5 * step) return step;
    return 365 * round_step(range / (5 * 365));
}

/// "2026-11-21"; between days "11-21 06:00".
std::string date_label(double day, bool with_hour)
{
    const double whole = std::floor(day + 1e-6);
    const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(static_cast<int>(whole)))};
    const std::string month_and_day =
        fmt::format("{:02}-{:02}", static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
    if (!with_hour) return fmt::format("{:04}-{}", static_cast<int>(date.year()), month_and_day);
    return fmt::format("{} {:02.0f}:00", month_and_day, std::round(24 * (day - whole)));
}

} // namespace

Axis Axis::between(bool logarithmic, std::vector<double> ticks)
{
    const double low = ticks.front(), high = ticks.back();
    return {logarithmic, low, high, std::move(ticks)};
}

Axis Axis::linear(double low, double high, int intervals)
{
    check_range(low, high);
    // Widens a range that rounding nearly closes: its ticks could not be counted.
    if (const double size = std::max(std::abs(low), std::abs(high)); high - low <= 1e-9 * size) {
        const double margin = size == 0 ? 1 : size / 2;
        low -= size == 0 ? 0 : margin;
        high += margin;
    }
    const double step = round_step((high - low) / std::max(intervals, 1));
    const double first = std::floor(low / step + 1e-9), last = std::ceil(high / step - 1e-9);
    return between(false, multiples(step, first, last));
}

Axis Axis::from_zero(double high, int intervals)
{
    Axis axis = linear(0, high, intervals);
    if (high > 0) axis.high_ = high;
    while (axis.ticks_.back() > axis.high_ * (1 + 1e-9))
        axis.ticks_.pop_back();
    return axis;
}

Axis Axis::dates(double low, double high)
{
    check_range(low, high);
    const double step = step_of_dates(high - low);
    const double first = std::floor(low / step + 1e-9);
    const double last = std::max(std::ceil(high / step - 1e-9), first + 1);
    Axis axis = between(false, multiples(step, first, last));
    axis.dates_ = true;
    return axis;
}

Axis Axis::logarithmic_at(std::vector<double> values, double margin)
{
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (values.empty()) throw Error(ErrorKind::internal, "Axis: no values");
    const double low = values.front() / margin, high = values.back() * margin;
    check_range(low, high);
    check_logarithm(low);
    return {true, low, high, std::move(values)};
}

Axis Axis::logarithmic(double low, double high)
{
    check_range(low, high);
    check_logarithm(low);
    const bool fine = high <= 1000 * low;
    const int stride = fine ? 1 : 3;
    int n = 3 * static_cast<int>(std::floor(std::log10(low) + 1e-9));
    while (fine && one_two_five(n + 1) <= low * (1 + 1e-9))
        ++n;
    std::vector<double> ticks;
    do
        ticks.push_back(one_two_five(n));
    while (one_two_five(std::exchange(n, n + stride)) < high * (1 - 1e-9) || ticks.size() < 2);
    return between(true, std::move(ticks));
}

double Axis::place(double value, double begin, double end) const
{
    if (!std::isfinite(value)) throw Error(ErrorKind::internal, "Axis: a value is not finite");
    const double inside = std::clamp(value, low(), high());
    const double share = logarithmic_ ? (std::log(inside) - std::log(low())) / (std::log(high()) - std::log(low()))
                                      : (inside - low()) / (high() - low());
    return begin + share * (end - begin);
}

std::string Axis::label(double tick) const
{
    if (dates_) return date_label(tick, ticks_[1] - ticks_[0] < 1);
    const double step = logarithmic_ || ticks_.size() < 2 ? std::abs(tick) : ticks_[1] - ticks_[0];
    if (std::abs(tick) >= max_plain || (step > 0 && step < 1e-6)) return fmt::format("{:.3g}", tick);
    const int decimals = step == 0 ? 0 : std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    return with_decimals(tick, decimals);
}

std::string short_number(double value)
{
    const double size = std::abs(value);
    if (value == 0) return "0";
    if (!std::isfinite(value) || size < 1e-6 || size >= max_plain) return fmt::format("{:.3g}", value);
    const int magnitude = static_cast<int>(std::floor(std::log10(size) + 1e-12));
    return with_decimals(value, std::max(0, 2 - magnitude));
}

std::string fixed_number(double value, int decimals)
{
    const double size = std::abs(value), last_place = std::pow(10.0, -decimals);
    const bool is_plain = size >= last_place * (1 - 1e-9) && size < max_plain;
    return is_plain ? with_decimals(value, decimals) : short_number(value);
}

std::string short_percent(double share)
{
    return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0);
}

std::vector<double> spread_apart(const std::vector<double>& positions, double gap, double low, double high)
{
    struct Block {
        double sum;        // of (wanted position - offset in the block)
        std::size_t count; // of positions in it
        [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
    };
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
    // Each rank's share of the gaps is subtracted; "at least a gap apart" then becomes "not descending".
    std::vector<Block> blocks;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        blocks.push_back({positions[order[rank]] - gap * static_cast<double>(rank), 1});
        while (blocks.size() > 1 && blocks[blocks.size() - 2].mean() > blocks.back().mean()) {
            const Block last = blocks.back();
            blocks.pop_back();
            blocks.back().sum += last.sum;
            blocks.back().count += last.count;
        }
    }
    const double margin = std::max(low, high - gap * (static_cast<double>(order.size()) - 1));
    std::vector<double> placed(positions.size());
    std::size_t rank = 0;
    for (const Block& block : blocks)
        for (std::size_t i = 0; i < block.count; ++i, ++rank)
            placed[order[rank]] = std::clamp(block.mean(), low, margin) + gap * static_cast<double>(rank);
    return placed;
}

} // namespace tetrace
