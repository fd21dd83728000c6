#include "bench/report/charts/bar_chart.h"
#include "bench/report/sections.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_ratios =
    "The rate of a row over that of the same kernel with another API on the same hardware: medians of the samples, "
    "with the 95 % interval of the ratio. A hollow dot's interval holds 1: no difference can be told. Rows with fewer "
    "than 5 samples have no interval, and are not shown.";

/// Identifies one chart.
struct RatioKey {
    std::size_t file;
    std::string scene;
    std::string rays; ///< kind
    DeviceKind kind;
    std::string reference; ///< API

    [[nodiscard]] bool operator==(const RatioKey&) const = default;
};

struct RatioGroup {
    RatioKey key;
    std::vector<Interval> intervals;
};

const ReportRow& row_named(const ReportInput& input, std::size_t file, const ResultValue& name)
{
    const std::string wanted = name.line();
    const auto found = std::ranges::find_if(
        input.rows, [&](const ReportRow& row) { return row.file == file && row.name() == wanted; });
    if (found == input.rows.end()) name.reject(fmt::format("is '{}', and there is no row of that name", wanted));
    return *found;
}

double ratio_at(const ResultValue& ratio, const char* key)
{
    const ResultValue value = ratio.at(key);
    if (value.number() < 1e-9 || value.number() > 1e9) value.reject("is not between 1e-9 and 1e9");
    return value.number();
}

void add_ratio(std::vector<RatioGroup>& groups, const ReportInput& input, std::size_t file, const ResultValue& ratio)
{
    const ResultValue name = ratio.at("row");
    const ReportRow& row = row_named(input, file, name);
    if (!row.row->device_kind) name.reject("is of a row without a device");
    const RatioKey key{file, row.row->scene, row.rays, row.kind(), row_named(input, file, ratio.at("reference")).api};
    auto group = std::ranges::find_if(groups, [&](const RatioGroup& other) { return other.key == key; });
    if (group == groups.end()) group = groups.insert(groups.end(), {key, {}});
    group->intervals.push_back({row.name(), row.kernel + "  " + row.api, "", api_series(row.row->backend),
                                ratio_at(ratio, "ratio"), ratio_at(ratio, "low"), ratio_at(ratio, "high")});
}

Html chart_of(const RatioGroup& group, const ReportInput& input)
{
    const RatioKey& key = group.key;
    const std::string what =
        fmt::format("{}, {}{}", key.scene, key.rays == "primary" ? "" : key.rays + " rays, ", plural_of(key.kind));
    const std::string title = with_letter(what, key.file, input.files.size());
    return figure(title,
                  draw(IntervalChart{fmt::format("Rates over those of {}: {}", key.reference, title),
                                     "slower than " + key.reference, "faster", group.intervals}),
                  "");
}

} // namespace

Section ratio_section(const ReportInput& input)
{
    std::vector<RatioGroup> groups;
    for (std::size_t file = 0; file < input.files.size(); ++file)
        if (const auto ratios = input.files[file].section().find("ratios"))
            for (const ResultValue& ratio : ratios->items())
                if (ratio.find("low")) add_ratio(groups, input, file, ratio);
    Section section{"ratios", "APIs beside each other", {}};
    section.is_empty = groups.empty();
    if (groups.empty()) {
        section.content =
            paragraph("These results compare no APIs: 'tetrace bench' does where a kernel ran under two on "
                      "one piece of hardware.");
        return section;
    }
    Html charts;
    for (const RatioGroup& group : groups)
        charts += chart_of(group, input);
    section.content = note(how_to_read_ratios) + side_by_side(charts);
    return section;
}

} // namespace tetrace
