#include "bench/debugging/trace_report.h"

#include "bench/output/row_json.h"
#include "bench/rows/ray_json.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

std::string place_of(const RowRun& row)
{
    const Schedule schedule = row.key.kernel.schedule;
    return device_label(row.key) + (schedule == Schedule::tiles ? std::string() : " " + std::string(name_of(schedule)));
}

std::string number_text(float number)
{
    return fmt::format("{:.9g}", number);
}

std::string vector_text(const Float3& vector)
{
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", vector.x, vector.y, vector.z);
}

std::string answer_text(const Hit& hit)
{
    if (hit.face_id == NO_HIT) return "no hit";
    return hit.face_id == LOST ? "lost" : fmt::format("triangle {}", hit.face_id);
}

bool same_bits(const Hit& a, const Hit& b)
{
    return is_same_hit(a, b, {});
}

Table answer_table(const TraceRun& run)
{
    Table table({{"device", "device"},
                 {"answer", "answer"},
                 {"t", "t"},
                 {"u", "u"},
                 {"v", "v"},
                 {"tet", "tet"},
                 {"steps", "steps"},
                 {.key = "alone", .title = "traced alone", .rank = 0},
                 {.key = "name", .title = "name", .rank = 2}});
    for (const RayOnDevice& ray : run.rays) {
        const Hit& hit = ray.hit;
        table.add({place_of(*ray.row), answer_text(hit), number_text(hit.t), number_text(hit.u), number_text(hit.v),
                   hit.tet == NO_TET ? Cell() : Cell(std::uint64_t{hit.tet}), std::uint64_t{hit.steps},
                   same_bits(hit, ray.alone) ? Cell("the same") : Cell("OTHER: " + answer_text(ray.alone)),
                   ray.row->device.name});
    }
    return table;
}

Cell tet_cell(const RayStep& step)
{
    return step.tet ? Cell(std::uint64_t{*step.tet}) : Cell();
}

Cell face_cell(const RayStep& step)
{
    return step.face ? Cell(std::uint64_t{*step.face}) : Cell();
}

Cell product_cell(const RayStep& step, std::size_t edge)
{
    return step.face ? Cell(number_text(step.products[edge])) : Cell();
}

std::size_t most_steps(const TraceRun& run)
{
    std::size_t most = 0;
    for (const RayOnDevice& ray : run.rays)
        most = std::max(most, ray.steps.size());
    return most;
}

/// The first step at which any device differs from openmp's.
std::optional<std::size_t> first_of_all(const TraceRun& run)
{
    std::optional<std::size_t> first;
    for (const RayOnDevice& ray : run.rays)
        if (const auto at = first_difference(ray, run.rays.front()); at && (!first || *at < *first)) first = at;
    return first;
}

/// A way in which some devices take a step.
struct Way {
    const RayStep* step;
    std::vector<std::string> devices;
};

std::vector<Way> ways_of(const TraceRun& run, std::size_t index)
{
    std::vector<Way> ways;
    for (const RayOnDevice& ray : run.rays) {
        if (index >= ray.steps.size()) continue;
        const RayStep& step = ray.steps[index];
        const auto known = std::ranges::find_if(ways, [&](const Way& way) { return *way.step == step; });
        if (known != ways.end())
            known->devices.push_back(place_of(*ray.row));
        else
            ways.push_back({&step, {place_of(*ray.row)}});
    }
    return ways;
}

std::string devices_text(const Way& way, const TraceRun& run)
{
    if (way.devices.size() == run.rays.size() && run.rays.size() > 1) return fmt::format("all {}", run.rays.size());
    return fmt::format("{}", fmt::join(way.devices, ", "));
}

Table step_table(const TraceRun& run)
{
    Table table({{"step", "step"},
                 {.key = "tet", .title = "tet", .rank = 0},
                 {.key = "face", .title = "face", .rank = 0},
                 {.key = "beyond", .title = "to", .rank = 0},
                 {.key = "p0", .title = "product 0"},
                 {.key = "p1", .title = "product 1"},
                 {.key = "p2", .title = "product 2"},
                 {.key = "from", .title = "on", .rank = 0},
                 {.key = "mark", .title = " ", .rank = 0}});
    const auto first = first_of_all(run);
    for (std::size_t i = 0; i < most_steps(run); ++i) {
        const auto ways = ways_of(run, i);
        for (const Way& way : ways) {
            const bool is_first = first == i && &way == &ways.back();
            table.add({std::uint64_t{i + 1}, tet_cell(*way.step), face_cell(*way.step), text_cell(way.step->beyond),
                       product_cell(*way.step, 0), product_cell(*way.step, 1), product_cell(*way.step, 2),
                       devices_text(way, run), is_first ? Cell("<- first difference") : Cell()});
        }
    }
    return table;
}

Table all_steps_table(const TraceRun& run)
{
    Table table({{"device", "device"},
                 {"step", "step"},
                 {"tet", "tet"},
                 {"face", "face"},
                 {"beyond", "to"},
                 {"p0", "product 0"},
                 {"p1", "product 1"},
                 {"p2", "product 2"}});
    for (const RayOnDevice& ray : run.rays)
        for (std::size_t i = 0; i < ray.steps.size(); ++i) {
            const RayStep& step = ray.steps[i];
            table.add({place_of(*ray.row), std::uint64_t{i + 1}, tet_cell(step), face_cell(step),
                       text_cell(step.beyond), product_cell(step, 0), product_cell(step, 1), product_cell(step, 2)});
        }
    return table;
}

std::string step_text(const RayOnDevice& ray, std::size_t index)
{
    if (index >= ray.steps.size()) return fmt::format("{} has ended", place_of(*ray.row));
    const RayStep& step = ray.steps[index];
    const std::string tet = step.tet ? fmt::format("tet {}", *step.tet) : std::string("no tet");
    if (!step.face) return fmt::format("{} is in {} ({})", place_of(*ray.row), tet, step.beyond);
    return fmt::format("{} leaves {} by face {} to {}", place_of(*ray.row), tet, *step.face, step.beyond);
}

/// One sentence for each device but openmp's.
std::string verdict_text(const RayOnDevice& ray, const RayOnDevice& reference)
{
    const std::string place = place_of(*ray.row);
    if (const auto at = first_difference(ray, reference))
        return fmt::format("{}: differs first at step {}: {}; {}.", place, *at + 1, step_text(ray, *at),
                           step_text(reference, *at));
    const bool allowed = is_same_hit(ray.hit, reference.hit, allowance_of(*ray.row));
    return fmt::format("{}: takes openmp's steps, and its answer is {}.", place,
                       same_bits(ray.hit, reference.hit) ? "the same, bit for bit"
                       : allowed                         ? "the same within what its self-test allows"
                                                         : "ANOTHER");
}

nlohmann::json step_json(const RayStep& step)
{
    nlohmann::json object = {{"beyond", step.beyond}};
    if (step.tet) object["tet"] = *step.tet;
    if (step.face) object["face"] = *step.face;
    if (step.face) object["products"] = step.products;
    return object;
}

nlohmann::json row_json(const RowRun& row)
{
    nlohmann::json object = {{"backend", row.key.backend},
                             {"device_index", row.key.device},
                             {"schedule", name_of(row.key.kernel.schedule)},
                             {"status", name_of(status_of(row))}};
    if (!row.device.name.empty()) object["device"] = row.device.name;
    if (!row.device.driver.empty()) object["driver"] = row.device.driver;
    if (const std::string reason = reason_of(row); !reason.empty()) object["reason"] = reason;
    return object;
}

nlohmann::json device_json(const RowRun& row, const TraceRun& run)
{
    nlohmann::json object = row_json(row);
    const auto ray = std::ranges::find(run.rays, &row, &RayOnDevice::row);
    if (ray == run.rays.end()) return object;
    object["hit"] = hit_json(ray->hit);
    object["alone"] = hit_json(ray->alone);
    object["steps"] = nlohmann::json::array();
    for (const RayStep& step : ray->steps)
        object["steps"].push_back(step_json(step));
    object["steps_cut"] = ray->is_cut;
    if (const auto at = first_difference(*ray, run.rays.front())) object["first_difference"] = *at + 1;
    object["differs"] = differs(*ray, run.rays.front());
    return object;
}

nlohmann::json trace_json(const TraceRun& run, const Options& options)
{
    const KernelId& kernel = run.rows.front().key.kernel;
    const auto numbers = [](const Float3& vector) { return nlohmann::json{vector.x, vector.y, vector.z}; };
    nlohmann::json trace = {{"method", name_of(kernel.method)},
                            {"layout", name_of(kernel.layout)},
                            {"math", name_of(kernel.math)},
                            {"view", run.scene->view_numbers().front()},
                            {"pixel", {options.pixel->x, options.pixel->y}},
                            {"origin", numbers(run.ray.origin)},
                            {"direction", numbers(run.ray.direction)},
                            {"devices", nlohmann::json::array()}};
    for (const RowRun& row : run.rows)
        trace["devices"].push_back(device_json(row, run));
    nlohmann::json section = result_head(options);
    section["scenes"] = nlohmann::json::array();
    section["scenes"].push_back(scene_json(*run.scene, options));
    section["trace"] = std::move(trace);
    return {{"tetrace", std::move(section)}};
}

void add_verdicts(Sheet& sheet, const TraceRun& run)
{
    for (const RayOnDevice& ray : run.rays) {
        if (&ray != &run.rays.front()) sheet.prose(verdict_text(ray, run.rays.front()));
        if (!same_bits(ray.hit, ray.alone))
            sheet.prose(fmt::format("{}: as an image of its own, the same ray gives {} after {} steps: what the other "
                                    "rays of the image do matters here.",
                                    place_of(*ray.row), answer_text(ray.alone), ray.alone.steps));
        if (ray.is_cut)
            sheet.prose(fmt::format("{}: the walk has {} steps, of which {} are followed.", place_of(*ray.row),
                                    ray.hit.steps, ray.steps.size()));
    }
    for (const RowRun& row : run.rows)
        if (const std::string reason = reason_of(row); !reason.empty())
            sheet.prose(fmt::format("{}: {}: {}", place_of(row), name_of(status_of(row)), reason));
}

} // namespace

Report trace_report(const TraceRun& run, const Options& options)
{
    const RowRun& first = run.rows.front();
    Report report{{}, all_steps_table(run), trace_json(run, options)};
    Sheet& sheet = report.sheet;
    sheet.heading(fmt::format("{}, {}: view {} of {}, pixel {},{} of {} x {}", first.key.scene, kernel_title(first.key),
                              run.scene->view_numbers().front(), camera_set_name(options), options.pixel->x,
                              options.pixel->y, run.scene->width(), run.scene->height()));
    sheet.line(fmt::format("ray from {} along {}", vector_text(run.ray.origin), vector_text(run.ray.direction)));
    sheet.gap();
    if (!run.rays.empty()) {
        sheet.table(answer_table(run));
        sheet.gap();
        sheet.table(step_table(run));
        sheet.gap();
    }
    add_verdicts(sheet, run);
    report.markdown = sheet.markdown();
    if (options.out) sheet.labelled("Result", options.out->string());
    return report;
}

} // namespace tetrace
