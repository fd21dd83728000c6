#include "bench/report/charts/bar_chart.h"

#include "bench/report/charts/axis.h"
#include "bench/report/html/svg.h"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace tetrace {

namespace {

constexpr double top = 6, bar_height = 13, gap = 10, axis_room = 38, max_labels = 230, max_values = 160;

/// Labels on the left, one below the other; then the plot; then space for the text right of each bar.
struct RowFrame {
    double left = 0, right = 0; ///< of the plot
    double pitch = 22;          ///< from row to row
    double bottom = 0;

    /// Height of the middle of a row's bar.
    [[nodiscard]] double middle(std::size_t row) const { return top + pitch * static_cast<double>(row) + pitch / 2; }
};

/// The label in as many lines as it needs: a row's name is shown whole, and only a word that is too long for a line of
/// its own is cut.
std::vector<std::string> lines_of(const std::string& label, double size, double width)
{
    if (label.empty()) return {};
    if (text_width(label, size) <= width) return {label};
    std::vector<std::string> lines;
    std::istringstream words(label);
    for (std::string word; words >> word;) {
        const std::string longer = lines.empty() ? word : lines.back() + " " + word;
        if (!lines.empty() && text_width(longer, size) <= width)
            lines.back() = longer;
        else
            lines.push_back(shortened(word, size, width));
    }
    return lines;
}

constexpr double line_height = 14;

/// The lines of a row's label, and then of its sublabel, each with its class.
template <class Row>
std::vector<std::pair<std::string, const char*>> label_lines(const Row& row, double width)
{
    std::vector<std::pair<std::string, const char*>> lines;
    for (const std::string& line : lines_of(row.label, label_size, width))
        lines.emplace_back(line, "label end");
    for (const std::string& line : lines_of(row.sublabel, small_size, width))
        lines.emplace_back(line, "small end");
    return lines;
}

template <class Row>
RowFrame frame_of(const std::vector<Row>& rows, double behind)
{
    RowFrame frame;
    double labels = 0;
    for (const Row& row : rows)
        labels = std::max({labels, text_width(row.label, label_size), text_width(row.sublabel, small_size)});
    labels = std::min(labels, max_labels);
    for (const Row& row : rows)
        frame.pitch = std::max(frame.pitch, 8 + line_height * static_cast<double>(label_lines(row, labels).size()));
    frame.left = labels + gap;
    frame.right = chart_width - behind - gap;
    frame.bottom = top + frame.pitch * static_cast<double>(rows.size()) + 4;
    return frame;
}

template <class Row>
Html row_label(const Row& row, const RowFrame& frame, double middle)
{
    const double width = frame.left - gap;
    const auto lines = label_lines(row, width);
    double baseline = middle + 4.5 - line_height * (static_cast<double>(lines.size()) - 1) / 2;
    Html label;
    for (const auto& [line, css_class] : lines) {
        label += svg_text(width, baseline, css_class, line);
        baseline += line_height;
    }
    return label;
}

Html grid(const Axis& axis, const RowFrame& frame, const std::string& title)
{
    return horizontal_ticks(axis, frame.left, frame.right, top, frame.bottom) +
           svg_text((frame.left + frame.right) / 2, frame.bottom + 31, "small middle", title);
}

constexpr double before_note = 8;

double value_width(const Bar& bar)
{
    return text_width(short_number(bar.value), label_size) +
           (bar.note.empty() ? 0 : before_note + text_width(bar.note, small_size));
}

/// The value, and its note in small letters as far as it fits.
Html value_and_note(const Bar& bar, double x, double baseline)
{
    const std::string value = short_number(bar.value);
    const double note_x = x + text_width(value, label_size) + before_note;
    const Html number = svg_text(x, baseline, "value", value);
    if (bar.note.empty()) return number;
    return number + svg_text(note_x, baseline, "small", shortened(bar.note, small_size, chart_width - note_x));
}

double largest(const Bar& bar)
{
    double value = std::max(bar.value, bar.high.value_or(0));
    for (const double sample : bar.samples)
        value = std::max(value, sample);
    return value;
}

template <class Row>
std::string full_label(const Row& row)
{
    return row.sublabel.empty() ? row.label : row.label + ", " + row.sublabel;
}

Html spread_of(const Bar& bar, const Axis& axis, const RowFrame& frame, double middle)
{
    const auto place = [&](double value) { return axis.place(value, frame.left, frame.right); };
    std::vector<double> places;
    for (const double sample : bar.samples)
        places.push_back(place(sample));
    const Html spread = svg_samples(places, middle);
    if (!bar.low || !bar.high) return spread;
    const double low = place(*bar.low), high = place(*bar.high);
    return spread + svg_line(low, middle, high, middle, "whisker") +
           svg_line(low, middle - 4, low, middle + 4, "whisker") +
           svg_line(high, middle - 4, high, middle + 4, "whisker");
}

Html bar_mark(const Bar& bar, const Axis& axis, const RowFrame& frame, double middle, const std::string& unit)
{
    const double end = axis.place(bar.value, frame.left, frame.right);
    const double drawn_to = std::max(axis.place(largest(bar), frame.left, frame.right), end);
    std::string tooltip = fmt::format("{}: {} {}", full_label(bar), short_number(bar.value), unit);
    if (!bar.note.empty()) tooltip += ", " + bar.note;
    if (bar.low && bar.high)
        tooltip += fmt::format(", quartiles {} to {}", short_number(*bar.low), short_number(*bar.high));
    return svg_mark(series_class(bar.series), bar.id, tooltip,
                    row_label(bar, frame, middle) +
                        svg_rectangle(frame.left, middle - bar_height / 2, end - frame.left, bar_height, "bar") +
                        spread_of(bar, axis, frame, middle) + value_and_note(bar, drawn_to + 6, middle + 4.5));
}

std::string interval_text(const Interval& interval)
{
    return fmt::format("{:.2f} [{:.2f}, {:.2f}]", interval.value, interval.low, interval.high);
}

Html interval_mark(const Interval& interval, const Axis& axis, const RowFrame& frame, double middle)
{
    const auto place = [&](double value) { return axis.place(value, frame.left, frame.right); };
    const bool undecided = interval.noisy || (interval.low <= 1 && 1 <= interval.high);
    return svg_mark(
        series_class(interval.series), interval.id,
        fmt::format("{}: {}", full_label(interval), interval_text(interval)),
        row_label(interval, frame, middle) +
            svg_line(place(interval.low), middle, place(interval.high), middle, "interval") +
            svg_shape(place(interval.value), middle, 0, undecided ? "hollow" : "solid") +
            svg_text(chart_width, middle + 4.5, interval.noisy ? "small end" : "value end", interval_text(interval)));
}

} // namespace

Html draw(const BarChart& chart)
{
    double behind = 0, high = 0;
    for (const Bar& bar : chart.bars) {
        behind = std::max(behind, std::min(value_width(bar), max_values));
        high = std::max(high, largest(bar));
    }
    const RowFrame frame = frame_of(chart.bars, behind);
    const Axis axis = Axis::from_zero(high);
    Html content = grid(axis, frame, chart.unit);
    for (std::size_t i = 0; i < chart.bars.size(); ++i)
        content += bar_mark(chart.bars[i], axis, frame, frame.middle(i), chart.unit);
    return svg_drawing(frame.bottom + axis_room, chart.label,
                       content + svg_line(frame.left, top, frame.left, frame.bottom, "axis"));
}

Html draw(const IntervalChart& chart)
{
    double behind = 0, low = 1, high = 1;
    for (const Interval& interval : chart.intervals) {
        behind = std::max(behind, text_width(interval_text(interval), label_size));
        low = std::min(low, interval.low);
        high = std::max(high, interval.high);
    }
    const RowFrame frame = frame_of(chart.intervals, behind);
    const Axis axis = high <= 1.4 * low ? Axis::linear(low, high, 4) : Axis::logarithmic(low, high);
    const double one = axis.place(1, frame.left, frame.right);
    Html content = grid(axis, frame, fmt::format("← {}  ·  {} →", chart.below, chart.above)) +
                   svg_line(one, top, one, frame.bottom, "reference");
    for (std::size_t i = 0; i < chart.intervals.size(); ++i)
        content += interval_mark(chart.intervals[i], axis, frame, frame.middle(i));
    return svg_drawing(frame.bottom + axis_room, chart.label, content);
}

} // namespace tetrace
