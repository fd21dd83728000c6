#include "bench/report/report_rows.h"

#include "bench/results/row_keys.h"
#include "bench/rows/rows.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// A number in [1e-18, 1e18]: products of such numbers stay finite.
double positive(const ResultValue& value)
{
    if (value.number() < 1e-18 || value.number() > 1e18) value.reject("is not between 1e-18 and 1e18");
    return value.number();
}

std::optional<double> positive_or_nothing(const ResultValue& row, const RowPath& field)
{
    const auto value = row.find(field);
    return value ? std::optional(positive(*value)) : std::nullopt;
}

std::optional<double> launch_share(const ResultValue& row)
{
    const auto overhead = row.find(row_key::overhead_s);
    const auto wall = positive_or_nothing(row, row_key::wall_s);
    if (!overhead || !wall) return std::nullopt;
    return std::max(0.0, overhead->number()) / *wall; // from two clocks: their difference may be negative
}

/// Older results lack the rays that enter; the hits of all are counted.
void read_shares(ReportRow& row, const ResultValue& value)
{
    const auto rays = value.find(row_key::ray_count);
    if (!rays || rays->count() == 0) return;
    const auto share_of = [&](const RowPath& field) -> std::optional<double> {
        const auto count = value.find(field);
        if (!count) return std::nullopt;
        if (count->count() > rays->count()) count->reject("exceeds the number of rays");
        return static_cast<double>(count->count()) / static_cast<double>(rays->count());
    };
    row.enter_share = share_of(row_key::entering);
    row.hit_share = share_of(row_key::hits);
}

std::optional<RowRate> rate_of(const ResultValue& row, const std::vector<double>& samples_s)
{
    if (!row.find(row_key::rates)) return std::nullopt;
    const double median_s = positive(row.at(row_key::median_s));
    RowRate rate;
    rate.mrays_per_s = positive(row.at(row_key::mrays_per_s));
    const double mrays = rate.mrays_per_s * median_s;
    rate.low = mrays / positive(row.at(row_key::upper_quartile_s));
    rate.high = mrays / positive(row.at(row_key::lower_quartile_s));
    for (const double seconds : samples_s)
        rate.samples.push_back(mrays / seconds);
    rate.msteps_per_s = positive_or_nothing(row, row_key::msteps_per_s);
    rate.bytes_per_step = positive_or_nothing(row, row_key::bytes_per_step);
    rate.ceiling_bytes_per_s = positive_or_nothing(row, row_key::ceiling_bytes_per_s);
    rate.launch_share = launch_share(row);
    return rate;
}

/// A blank and the value where it is not the default. Old results may lack the key.
std::string unless_usual(const std::string& value, std::string_view usual)
{
    return value.empty() || value == usual ? "" : " " + value;
}

/// Sets the members that describe the row's kernel.
void read_kernel(ReportRow& row, const ResultValue& value)
{
    read_into(row.structure, value.at(row_key::structure));
    const std::string method = value.at(row_key::method).line(), layout = value.at(row_key::layout).line(),
                      math = value.at(row_key::math).line(), &schedule = row.row->schedule;
    row.layout = layout;
    row.known_kernel = kernel_named(method, layout, math, schedule);
    if (row.known_kernel && !is_portable(*row.known_kernel)) {
        row.walk = is_embree(row.known_kernel->layout) ? embree_title(method, layout) : layout;
        return;
    }
    const auto ray_order = value.find(row_key::ray_order);
    row.walk = fmt::format("{}{}{}{}{}{}", row.structure == Structure::cdt ? method + " " : "", layout,
                           unless_usual(math, "exact"), unless_usual(value.at(row_key::order).line(), "chains"),
                           unless_usual(schedule, "tiles"), ray_order ? unless_usual(ray_order->line(), "tiles") : "");
}

bool same_rays(const ResultScene& a, const ResultScene& b)
{
    return a.name == b.name && a.hash == b.hash && a.camera_set == b.camera_set &&
           a.camera_set_hash == b.camera_set_hash && a.views == b.views && a.width == b.width && a.height == b.height;
}

RowGroup& group_for(std::vector<RowGroup>& groups, const ResultScene& scene, const ReportRow& row)
{
    for (RowGroup& group : groups)
        if (same_rays(group.scene, scene) && group.rays == row.rays && group.task == row.task &&
            group.kind == row.kind())
            return group;
    return groups.emplace_back(RowGroup{scene, row.rays, row.task, row.kind(), {}});
}

/// Keeps groups of one scene together, in the order in which scenes appear.
void order_groups(std::vector<RowGroup>& groups)
{
    std::vector<RowGroup> ordered;
    while (!groups.empty()) {
        const ResultScene scene = groups.front().scene;
        const RayKind rays = groups.front().rays;
        const Task task = groups.front().task;
        const auto others = std::stable_partition(groups.begin(), groups.end(), [&](const RowGroup& group) {
            return same_rays(group.scene, scene) && group.rays == rays && group.task == task;
        });
        std::stable_sort(groups.begin(), others, [](const RowGroup& a, const RowGroup& b) { return a.kind < b.kind; });
        std::move(groups.begin(), others, std::back_inserter(ordered));
        groups.erase(groups.begin(), others);
    }
    groups = std::move(ordered);
}

} // namespace

std::vector<ReportRow> report_rows(const ResultFile& result, std::size_t file)
{
    std::vector<ReportRow> rows;
    const auto values = result.section().find("rows");
    if (!values) return rows;
    const auto items = values->items();
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        ReportRow row;
        row.file = file;
        row.index = i;
        row.row = &result.rows[i];
        read_kernel(row, items[i]);
        row.api = result.rows[i].api();
        if (const auto threads = result.rows[i].threads; threads > 0)
            row.api += ", " + counted(threads, "thread", "threads");
        if (const auto launches = result.rows[i].in_flight; launches > 1)
            row.api += fmt::format(", {} in flight", launches);
        row.device = result.head.shown(result.rows[i].device);
        read_into(row.rays, items[i].at(row_key::rays));
        if (const auto task = items[i].find(row_key::task)) {
            read_into(row.task, *task);
            if (!traits_of(row.task).crosses) task->reject("is not a task that rows name");
        }
        read_shares(row, items[i]);
        row.rate = rate_of(items[i], result.rows[i].samples_s);
        if (row.rate && !row.row->device_kind) items[i].reject("has a rate and no device");
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<RowGroup> rated_groups(const std::vector<ResultFile>& files, const std::vector<ReportRow>& rows)
{
    std::vector<RowGroup> groups;
    for (const ReportRow& row : rows) {
        if (!row.rate) continue;
        const ResultScene* scene = files.at(row.file).find_scene(row.row->scene);
        if (scene == nullptr)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("reading the result '{}': row '{}' has a rate on scene '{}', which is not among "
                                    "its scenes",
                                    files[row.file].path.string(), row.name(), row.row->scene));
        group_for(groups, *scene, row).rows.push_back(&row);
    }
    for (RowGroup& group : groups)
        std::ranges::stable_sort(group.rows, [](const ReportRow* a, const ReportRow* b) {
            return a->rate->mrays_per_s > b->rate->mrays_per_s;
        });
    order_groups(groups);
    return groups;
}

std::string rays_text(RayKind rays, Task task)
{
    return (task == Task::trace ? std::string() : fmt::format("{} of ", name_of(task))).append(name_of(rays));
}

std::string views_text(const ResultScene& scene)
{
    return fmt::format("{} of {} at {} × {}", counted(scene.views.size(), "view", "views"), scene.camera_set,
                       scene.width, scene.height);
}

std::string rays_title(const ResultScene& scene, std::string_view rays)
{
    return fmt::format("{}: {}, {} rays", scene.name, views_text(scene), rays);
}

std::string file_letter(std::size_t file, std::size_t files)
{
    if (files < 2) return {};
    return file < 26 ? std::string(1, static_cast<char>('A' + file)) : std::to_string(file + 1);
}

std::string with_letter(const std::string& title, std::size_t file, std::size_t files)
{
    const std::string letter = file_letter(file, files);
    return letter.empty() ? title : title + " · " + letter;
}

std::string minute_of(std::string date)
{
    if (date.size() >= 16 && date[10] == 'T') return date.replace(10, 1, " ").substr(0, 16);
    return date;
}

const char* plural_of(DeviceKind kind)
{
    return kind == DeviceKind::cpu ? "processors" : kind == DeviceKind::gpu ? "GPUs" : "emulated";
}

} // namespace tetrace
