#include "bench/debugging/trace_sheet.h"

#include "bench/debugging/ray_steps.h"
#include "bench/rows/json_numbers.h"
#include "bench/rows/ray_json.h"
#include "bench/rows/rows.h"
#include "core/base/printable.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace tetrace {

namespace {

/// A ray on a device, as a result has it.
struct ShownRay {
    std::string place, name, status, reason;
    bool is_traced = false; ///< the members below are known
    Hit hit{}, alone{};
    std::vector<RayStep> steps;
    bool is_cut = false, differs = false;
    std::optional<std::size_t> first_difference; ///< from 0
    std::optional<Visits> visits;
};

struct Trace {
    std::string scene, camera_set;
    RowKey key;
    std::uint64_t view = 0, x = 0, y = 0, width = 0, height = 0;
    std::vector<float> origin, direction;
    std::optional<double> end;
    std::string start; ///< of a given ray, in words; empty: outside
    std::vector<ShownRay> devices;

    /// openmp's hit; null if it has none.
    [[nodiscard]] const ShownRay* reference() const { return devices.front().is_traced ? &devices.front() : nullptr; }
    [[nodiscard]] std::vector<const ShownRay*> rays() const
    {
        std::vector<const ShownRay*> traced;
        for (const ShownRay& ray : devices)
            if (ray.is_traced) traced.push_back(&ray);
        return traced;
    }
    [[nodiscard]] bool has_steps() const { return key.kernel.structure == Structure::cdt; }
};

/// What `read` makes of the value; throws as ResultValue does.
template <class Read>
auto read_as(const ResultValue& value, const char* what, const Read& read)
{
    try {
        return read(value.json());
    } catch (const nlohmann::json::exception&) {
        value.reject(what);
    } catch (const std::logic_error&) {
        value.reject(what);
    }
}

/// JSON has neither NaN nor infinity: both are null there.
std::vector<float> vector_from(const ResultValue& value)
{
    return read_as(value, "is not a vector", [](const nlohmann::json& list) {
        std::vector<float> numbers;
        for (std::size_t axis = 0; axis < 3; ++axis)
            numbers.push_back(float_from(list.at(axis)));
        return numbers;
    });
}

Hit read_hit(const ResultValue& value)
{
    return read_as(value, "is not a hit", hit_from);
}

std::optional<std::uint32_t> small_number(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    if (!value) return std::nullopt;
    return read_as(*value, "is not the number of a tet or face", count_from<std::uint32_t>);
}

RayStep read_step(const ResultValue& value)
{
    RayStep step{small_number(value, "tet"), small_number(value, "face"), value.at("beyond").line()};
    if (step.face) std::ranges::copy(vector_from(value.at("products")), step.products.begin());
    return step;
}

ShownRay read_ray(const ResultValue& value)
{
    ShownRay ray;
    RowKey key;
    key.backend = value.at("backend").line();
    key.device = value.at("device_index").count();
    const std::string schedule = value.at("schedule").line();
    ray.place = device_label(key) + (schedule == name_of(Schedule::tiles) ? "" : " " + schedule);
    if (const auto name = value.find("device")) ray.name = name->line();
    ray.status = value.at("status").line();
    ray.reason = printable_text(value.text_at("reason"));
    const auto hit = value.find("hit");
    if (!hit) return ray;
    ray.is_traced = true;
    ray.hit = read_hit(*hit);
    ray.alone = read_hit(value.at("alone"));
    for (const ResultValue& step : value.at("steps").items())
        ray.steps.push_back(read_step(step));
    ray.is_cut = value.at("steps_cut").flag();
    if (const auto differs = value.find("differs")) ray.differs = differs->flag();
    if (const auto first = small_number(value, "first_difference")) ray.first_difference = std::max(*first, 1u) - 1;
    if (const auto visits = value.find("visits"))
        ray.visits = Visits{1, visits->at("nodes").count(), visits->at("triangles").count()};
    return ray;
}

KernelId read_kernel(const ResultValue& trace)
{
    if (const auto kernel = kernel_named(trace.at("method").line(), trace.at("layout").line(), trace.at("math").line(),
                                         name_of(Schedule::tiles)))
        return *kernel;
    trace.at("method").reject("and its layout and math are not a kernel of this tetrace");
}

/// Results from before rays were given have none of the keys of those.
void read_rays(Trace& trace, const ResultValue& value)
{
    if (const auto rays = value.find("rays")) read_into(trace.key.rays, *rays);
    if (const auto order = value.find("ray_order")) read_into(trace.key.ray_order, *order);
    if (const auto order = value.find("order")) read_into(trace.key.order, *order);
    if (const auto end = value.find("end")) trace.end = end->number();
    const auto start = value.find("start");
    if (!start) return;
    trace.start = fmt::format("in tet {}, by its face {}", start->at("tet").count(), start->at("face").count());
    if (const auto triangle = start->find("triangle"))
        trace.start += fmt::format(", on triangle {}", triangle->count());
}

Trace read_trace(const ResultValue& section)
{
    Trace trace;
    const auto scenes = section.at("scenes").items();
    if (scenes.empty()) section.at("scenes").reject("is empty, and a ray has a scene");
    trace.scene = scenes.front().at("name").line();
    trace.camera_set = scenes.front().at("camera_set").line();
    trace.width = scenes.front().at("width").count();
    trace.height = scenes.front().at("height").count();
    const ResultValue value = section.at("trace");
    trace.key.kernel = read_kernel(value);
    read_rays(trace, value);
    trace.view = value.at("view").count();
    const auto pixel = value.at("pixel").items();
    if (pixel.size() != 2) value.at("pixel").reject("is not a pixel: write [x, y]");
    trace.x = pixel[0].count();
    trace.y = pixel[1].count();
    trace.origin = vector_from(value.at("origin"));
    trace.direction = vector_from(value.at("direction"));
    for (const ResultValue& device : value.at("devices").items())
        trace.devices.push_back(read_ray(device));
    if (trace.devices.empty()) value.at("devices").reject("is empty");
    return trace;
}

std::string number_text(float number)
{
    return fmt::format("{:.9g}", number);
}

std::string vector_text(const std::vector<float>& vector)
{
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", vector[0], vector[1], vector[2]);
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

Table answer_table(const Trace& trace)
{
    Table table({{"device", "device"},
                 {"answer", "hit"},
                 {"t", "t"},
                 {"u", "u"},
                 {"v", "v"},
                 {"tet", "tet"},
                 {"steps", "steps"},
                 {.key = "alone", .title = "traced alone", .rank = 0},
                 {.key = "name", .title = "name", .rank = 2}});
    for (const ShownRay* ray : trace.rays()) {
        const Hit& hit = ray->hit;
        table.add({ray->place, answer_text(hit), number_text(hit.t), number_text(hit.u), number_text(hit.v),
                   hit.tet == NO_TET ? Cell() : Cell(std::uint64_t{hit.tet}),
                   trace.has_steps() ? Cell(std::uint64_t{hit.steps}) : Cell(),
                   same_bits(hit, ray->alone) ? Cell("the same") : Cell("DIFFERENT: " + answer_text(ray->alone)),
                   ray->name});
    }
    return table;
}

Cell number_cell(const std::optional<std::uint32_t>& number)
{
    return number ? Cell(std::uint64_t{*number}) : Cell();
}

Cell product_cell(const RayStep& step, std::size_t edge)
{
    return step.face ? Cell(number_text(step.products[edge])) : Cell();
}

std::size_t max_steps(const Trace& trace)
{
    std::size_t max = 0;
    for (const ShownRay& ray : trace.devices)
        max = std::max(max, ray.steps.size());
    return max;
}

/// The first step at which any device differs from openmp's.
std::optional<std::size_t> first_of_all(const Trace& trace)
{
    std::optional<std::size_t> first;
    for (const ShownRay& ray : trace.devices)
        if (ray.first_difference && (!first || *ray.first_difference < *first)) first = ray.first_difference;
    return first;
}

/// A step that some devices agree on.
struct SharedStep {
    const RayStep* step;
    std::vector<std::string> devices;
};

std::vector<SharedStep> shared_steps(const Trace& trace, std::size_t index)
{
    std::vector<SharedStep> shared;
    for (const ShownRay* ray : trace.rays()) {
        if (index >= ray->steps.size()) continue;
        const RayStep& step = ray->steps[index];
        const auto known = std::ranges::find_if(shared, [&](const SharedStep& one) { return *one.step == step; });
        if (known != shared.end())
            known->devices.push_back(ray->place);
        else
            shared.push_back({&step, {ray->place}});
    }
    return shared;
}

std::string devices_text(const SharedStep& step, std::size_t rays)
{
    if (step.devices.size() == rays && rays > 1) return fmt::format("all {}", rays);
    return fmt::format("{}", fmt::join(step.devices, ", "));
}

Table step_table(const Trace& trace)
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
    const auto first = first_of_all(trace);
    for (std::size_t i = 0; i < max_steps(trace); ++i) {
        const auto shared = shared_steps(trace, i);
        for (const SharedStep& one : shared) {
            const bool is_first = first == i && &one == &shared.back();
            table.add({std::uint64_t{i + 1}, number_cell(one.step->tet), number_cell(one.step->face),
                       text_cell(one.step->beyond), product_cell(*one.step, 0), product_cell(*one.step, 1),
                       product_cell(*one.step, 2), devices_text(one, trace.rays().size()),
                       is_first ? Cell("<- first difference") : Cell()});
        }
    }
    return table;
}

Table all_steps_table(const Trace& trace)
{
    Table table({{"device", "device"},
                 {"step", "step"},
                 {"tet", "tet"},
                 {"face", "face"},
                 {"beyond", "to"},
                 {"p0", "product 0"},
                 {"p1", "product 1"},
                 {"p2", "product 2"}});
    for (const ShownRay& ray : trace.devices)
        for (std::size_t i = 0; i < ray.steps.size(); ++i) {
            const RayStep& step = ray.steps[i];
            table.add({ray.place, std::uint64_t{i + 1}, number_cell(step.tet), number_cell(step.face),
                       text_cell(step.beyond), product_cell(step, 0), product_cell(step, 1), product_cell(step, 2)});
        }
    return table;
}

std::string step_text(const ShownRay& ray, std::size_t index)
{
    if (index >= ray.steps.size()) return fmt::format("{} has ended", ray.place);
    const RayStep& step = ray.steps[index];
    const std::string tet = step.tet ? fmt::format("tet {}", *step.tet) : std::string("no tet");
    if (!step.face) return fmt::format("{} is in {} ({})", ray.place, tet, step.beyond);
    return fmt::format("{} leaves {} by face {} to {}", ray.place, tet, *step.face, step.beyond);
}

/// One sentence for a device, compared with openmp.
std::string verdict_text(const ShownRay& ray, const ShownRay& reference, bool has_steps)
{
    if (ray.first_difference)
        return fmt::format("{}: differs first at step {}: {}; {}.", ray.place, *ray.first_difference + 1,
                           step_text(ray, *ray.first_difference), step_text(reference, *ray.first_difference));
    return fmt::format("{}: {}its hit is {}.", ray.place, has_steps ? "the steps are openmp's, and " : "",
                       same_bits(ray.hit, reference.hit) ? "the same, bit for bit"
                       : !ray.differs                    ? "the same within what its self-test allows"
                                                         : "DIFFERENT ");
}

void add_verdicts(Sheet& sheet, const Trace& trace)
{
    const ShownRay* const reference = trace.reference();
    for (const ShownRay* ray : trace.rays()) {
        if (reference != nullptr && ray != reference) sheet.prose(verdict_text(*ray, *reference, trace.has_steps()));
        if (!same_bits(ray->hit, ray->alone))
            sheet.prose(fmt::format("{}: traced alone, the same ray gives {}{}: the other rays affect it.", ray->place,
                                    answer_text(ray->alone),
                                    trace.has_steps() ? fmt::format(" after {} steps", ray->alone.steps) : ""));
        if (ray->is_cut)
            sheet.prose(fmt::format("{}: the walk has {} steps; {} were followed.", ray->place, ray->hit.steps,
                                    ray->steps.size()));
        if (ray->visits)
            sheet.prose(fmt::format("{} visits {} nodes and {} triangles. The kernels of BVHs do not report which, "
                                    "so no steps are shown.",
                                    ray->place, ray->visits->nodes, ray->visits->triangles));
    }
    for (const ShownRay& ray : trace.devices)
        if (!ray.reason.empty()) sheet.prose(fmt::format("{}: {}: {}", ray.place, ray.status, ray.reason));
    if (reference == nullptr)
        sheet.prose(fmt::format("{} has no hit to compare the devices with.", trace.devices.front().place));
}

/// "ray from (...) along (...)", and for a given ray its start and end.
std::string ray_text(const Trace& trace)
{
    std::string text = fmt::format("ray from {} along {}", vector_text(trace.origin), vector_text(trace.direction));
    if (!trace.start.empty()) text += ", starts " + trace.start;
    if (trace.end) text += fmt::format(", ends at t = {:.9g}", static_cast<float>(*trace.end));
    return text;
}

} // namespace

ShownTrace shown_trace(const ResultValue& section)
{
    const Trace trace = read_trace(section);
    ShownTrace shown{{}, all_steps_table(trace)};
    Sheet& sheet = shown.sheet;
    sheet.heading(fmt::format("{}, {}: view {} of {}, pixel {},{} of {} x {}", trace.scene, kernel_title(trace.key),
                              trace.view, trace.camera_set, trace.x, trace.y, trace.width, trace.height));
    sheet.prose(ray_text(trace));
    sheet.gap();
    if (!trace.rays().empty()) {
        sheet.table(answer_table(trace));
        sheet.gap();
    }
    if (max_steps(trace) > 0) {
        sheet.table(step_table(trace));
        sheet.gap();
    }
    add_verdicts(sheet, trace);
    return shown;
}

} // namespace tetrace
