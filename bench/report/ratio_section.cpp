#include "bench/report/charts/bar_chart.h"
#include "bench/report/sections.h"
#include "bench/results/row_keys.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_ratios =
    "The rate of a row over that of the same kernel with another API on the same hardware: medians of the samples, "
    "with the 95 % interval of the ratio from the samples. A hollow dot's interval contains 1: the difference is "
    "not significant, or a rate is noisy. Rows with fewer than 5 samples have no interval, and are not shown.";

/// Identifies one chart.
struct RatioKey {
    std::size_t file;
    std::string scene, rays; ///< as rays_text()
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
    if (found == input.rows.end()) name.reject(fmt::format("is '{}', but no row has that name", wanted));
    return *found;
}

double ratio_from(const ResultValue& value)
{
    if (value.number() < 1e-9 || value.number() > 1e9) value.reject("is not between 1e-9 and 1e9");
    return value.number();
}

void add_ratio(std::vector<RatioGroup>& groups, const ReportInput& input, std::size_t file, const ResultValue& ratio)
{
    const ResultValue name = ratio.at(ratio_key::row), reference_name = ratio.at(ratio_key::reference);
    const ReportRow& row = row_named(input, file, name);
    if (!row.row->device_kind) name.reject("is of a row without a device");
    const ReportRow& reference = row_named(input, file, reference_name);
    const bool noisy = is_noisy(row) || is_noisy(reference);
    const RatioKey key{file, row.row->scene, rays_text(row.rays, row.task), row.kind(), reference.api};
    auto group = std::ranges::find_if(groups, [&](const RatioGroup& other) { return other.key == key; });
    if (group == groups.end()) group = groups.insert(groups.end(), {key, {}});
    group->intervals.push_back({row.name(), row.kernel() + "  " + row.api, noisy ? "noisy" : "",
                                api_series(row.row->backend), ratio_from(ratio.at(ratio_key::ratio)),
                                ratio_from(ratio.at(ratio_key::low)), ratio_from(ratio.at(ratio_key::high)), noisy});
}

Html chart_of(const RatioGroup& group, const ReportInput& input)
{
    const RatioKey& key = group.key;
    const std::string what = fmt::format(
        "{}, {}{}", key.scene, key.rays == name_of(RayKind::primary) ? "" : key.rays + " rays, ", plural_of(key.kind));
    const std::string title = with_letter(what, key.file, input.files.size());
    return figure(title,
                  draw(IntervalChart{fmt::format("Rates over those of {}: {}", key.reference, title),
                                     "slower than " + key.reference, "faster", group.intervals}),
                  "");
}

/// "1.84 [1.80, 1.88]".
std::string interval_text(const ResultValue& row)
{
    std::string text = fmt::format("{:.2f}", ratio_from(row.at(row_key::ratio_to_best_bvh)));
    if (row.find(row_key::ratio_to_best_bvh_low))
        text += fmt::format(" [{:.2f}, {:.2f}]", ratio_from(row.at(row_key::ratio_to_best_bvh_low)),
                            ratio_from(row.at(row_key::ratio_to_best_bvh_high)));
    return text;
}

/// Each row of tets over the fastest BVH, which is named; older results lack it.
Html tets_over_bvhs(const ReportInput& input)
{
    HtmlTable table({{"result"}, {"scene"}, {"row"}, {"device"}, {"over the fastest BVH", "", true}, {"which is"}});
    const std::size_t files = input.files.size();
    std::vector<std::vector<ResultValue>> values;
    for (const ResultFile& file : input.files) {
        const auto rows = file.section().find("rows");
        values.push_back(rows ? rows->items() : std::vector<ResultValue>());
    }
    for (const ReportRow& row : input.rows) {
        const ResultValue& value = values.at(row.file).at(row.index);
        const auto best = value.find(row_key::best_bvh);
        if (!best || row.structure != Structure::cdt) continue;
        const ReportRow& bvh = row_named(input, row.file, *best);
        table.add({text(file_letter(row.file, files)), text(row.row->scene),
                   text(row.kernel_and_rays() + " " + row.api), text(row.device),
                   text(interval_text(value)) +
                       (is_noisy(row) || is_noisy(bvh) ? text_element("small", "", "noisy") : Html()),
                   text(bvh.kernel() + " " + bvh.api)});
    }
    if (table.empty()) return {};
    return heading("Tets over the fastest BVH") +
           note("The rate of each walk through tets over that of the fastest BVH on the same rays and device: on a "
                "CPU ours and Embree's, with all of its entry points; on a GPU those of all its APIs, including the "
                "driver's; on an emulated device its own. With the 95 % interval of the ratio from the samples.") +
           table.html();
}

} // namespace

Section ratio_section(const ReportInput& input)
{
    std::vector<RatioGroup> groups;
    for (std::size_t file = 0; file < input.files.size(); ++file)
        if (const auto ratios = input.files[file].section().find("ratios"))
            for (const ResultValue& ratio : ratios->items())
                if (ratio.find(ratio_key::low)) add_ratio(groups, input, file, ratio);
    Section section{"ratios", "APIs compared", {}};
    Html charts;
    for (const RatioGroup& group : groups)
        charts += chart_of(group, input);
    if (!groups.empty()) section.content = note(how_to_read_ratios) + side_by_side(charts);
    section.content += tets_over_bvhs(input);
    return section;
}

} // namespace tetrace
