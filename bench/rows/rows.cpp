#include "bench/rows/rows.h"

#include "bench/options/name_filter.h"
#include "bench/rows/scene_work.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace tetrace {

namespace {

template <class T>
bool has(const std::vector<T>& list, const T& value)
{
    return std::ranges::find(list, value) != list.end();
}

template <class T>
bool wanted(const std::vector<T>& list, const T& value)
{
    return list.empty() || has(list, value);
}

/// Where no method is named, the kernel list says which methods represent all: two of the cdt, the paper's and the
/// fastest. The many other rows are for comparing methods.
bool wanted_method(const Options& options, const KernelId& kernel)
{
    return options.methods.empty() ? is_default(kernel) : wanted(options.methods, kernel.method);
}

bool wanted_math(const Options& options, const KernelId& kernel)
{
    if (!is_portable(kernel)) return true;
    return options.math.empty() ? kernel.math == MathMode::exact : wanted(options.math, kernel.math);
}

bool wanted_schedule(const Options& options, const KernelId& kernel)
{
    if (!is_portable(kernel)) return true;
    if (!options.schedules.empty()) return wanted(options.schedules, kernel.schedule);
    const bool has_packets = options.verb != Verb::reproduce; // the paper's tables are for one ray at a time
    return kernel.schedule == Schedule::tiles || (has_packets && kernel.schedule == Schedule::packets);
}

std::vector<TetOrder> wanted_orders(const Options& options, const KernelId& kernel)
{
    if (kernel.structure != Structure::cdt || options.orders.empty()) return {TetOrder::chains};
    return options.orders;
}

bool wanted_kernel(const Options& options, const KernelId& kernel)
{
    return wanted(options.structures, kernel.structure) && wanted_method(options, kernel) &&
           wanted(options.layouts, kernel.layout) && wanted_math(options, kernel) && wanted_schedule(options, kernel);
}

bool is_named(const Options& options, const Backend& backend)
{
    for (const auto* list : {&options.backends, &options.required})
        if (has(*list, backend.name())) return true;
    return false;
}

bool has_usable_device(const Backend& backend)
{
    const auto& devices = backend.devices();
    return std::ranges::any_of(devices, [](const Device& device) { return device.usable; });
}

bool has_any_kernel(const Backend& backend)
{
    const auto& kernels = all_kernels();
    return std::ranges::any_of(kernels, [&](const KernelId& k) { return backend.has_kernel(k); });
}

std::string in_lower_case(std::string text)
{
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// Whether the backend's driver failed before any device was known: a run must not pass over that, unless it is on
/// certain devices.
bool fails_whole(const Options& options, const Backend& backend)
{
    return backend.devices().front().broken && options.devices.empty();
}

/// Indices of the devices that have rows.
std::vector<std::size_t> devices_with_rows(const Options& options, const Backend& backend)
{
    if (!has_usable_device(backend) && (is_named(options, backend) || fails_whole(options, backend))) return {0};
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < backend.devices().size(); ++i)
        if (backend.devices()[i].usable && wanted_device(options, backend, i)) indices.push_back(i);
    return indices;
}

/// Whether --layout, --filter or --benchmark_filter names the layout rt, or --schedule the one that only it has.
bool names_rt(const Options& options)
{
    static const NameFilter word("layout rt", "\\brt\\b");
    const auto names_it = [](const std::string& filter) { return word.keeps(filter); };
    const auto& flags = options.benchmark_flags;
    return !options.layouts.empty() || has(options.schedules, Schedule::pipeline) || names_it(options.filter) ||
           std::ranges::any_of(flags, [&](const std::string& flag) {
               return flag.rfind("--benchmark_filter=", 0) == 0 && names_it(flag);
           });
}

/// What traces rays of layout rt on a device: what --schedule names, if that is tiles or pipeline, and else ray queries
/// (tiles), or a pipeline if the driver lacks ray queries.
bool wanted_tracer(const Options& options, const Backend& backend, std::size_t device, const KernelId& kernel)
{
    const auto can = [&](KernelId other, Schedule schedule) {
        other.schedule = schedule;
        return backend.why_not(device, other).empty();
    };
    if (has(options.schedules, Schedule::tiles) || has(options.schedules, Schedule::pipeline))
        return has(options.schedules, kernel.schedule);
    const bool takes_pipeline = !can(kernel, Schedule::tiles) && can(kernel, Schedule::pipeline);
    return kernel.schedule == (takes_pipeline ? Schedule::pipeline : Schedule::tiles);
}

/// Rows of layout rt are selected by default only on real GPUs that support it. An emulated device takes a hundred
/// times as long for them as for its other rows.
bool wanted_there(const Options& options, const Backend& backend, std::size_t device, const KernelId& kernel)
{
    if (kernel.layout != Layout::rt) return true;
    if (!wanted_tracer(options, backend, device, kernel)) return false;
    if (names_rt(options)) return true;
    return backend.devices()[device].kind != DeviceKind::emulated && backend.why_not(device, kernel).empty();
}

/// Of rows on the device: 0 is those of the whole run, the most of all numbers asked for. Only a processor has several.
std::vector<unsigned> wanted_threads(const Options& options, const Device& device)
{
    if (options.thread_counts.empty() || device.kind != DeviceKind::cpu) return {0};
    std::vector<unsigned> counts = options.thread_counts;
    counts.back() = 0;
    return counts;
}

unsigned launches_in_flight(const Options& options, const Device& device, const KernelId& kernel)
{
    const bool can = device.kind != DeviceKind::cpu && !traits_of(kernel.task).tallies;
    return can ? options.launches_in_flight : 1;
}

void add_rows(std::vector<RowKey>& rows, const Options& options, RowKey key, const Backend& backend)
{
    key.backend = backend.name();
    for (const std::size_t device : devices_with_rows(options, backend)) {
        if (!wanted_there(options, backend, device, key.kernel)) continue;
        for (const TetOrder order : wanted_orders(options, key.kernel)) {
            key.device = device;
            key.order = order;
            key.in_flight = launches_in_flight(options, backend.devices()[device], key.kernel);
            for (const unsigned threads : wanted_threads(options, backend.devices()[device])) {
                key.threads = threads;
                if (std::ranges::find(rows, key) == rows.end()) rows.push_back(key);
            }
        }
    }
}

std::vector<RowKey> rows_of_scene(const Options& options, const std::string& scene,
                                  const std::vector<Backend*>& backends, const std::vector<KernelId>& kernels)
{
    std::vector<RowKey> rows;
    for (const KernelId& kernel : kernels)
        for (const Backend* backend : backends)
            if (wanted_kernel(options, kernel) && wanted(options.backends, backend->name()) &&
                backend->has_kernel(kernel))
                add_rows(rows, options, {scene, {}, kernel}, *backend);
    return rows;
}

bool crosses(Task task)
{
    return traits_of(task).crosses;
}

/// The task of rows of rays of a kind: all but primary ones are given.
Task task_for(Task asked, RayKind kind)
{
    return asked == Task::trace && kind != RayKind::primary ? Task::rays : asked;
}

/// Rows of a task: of primary rays, and of given rays in each order asked for, kind after kind.
std::vector<RowKey> rows_of_kinds(const Options& options, Task asked, const std::string& scene,
                                  const std::vector<Backend*>& backends)
{
    std::vector<RowKey> rows;
    for (const RayKind kind : options.rays.empty() ? std::vector{RayKind::primary} : options.rays) {
        const bool is_given = traits_of(task_for(asked, kind)).takes_rays;
        const auto kernels = kernels_for(asked, kind);
        const auto orders = is_given && !options.ray_orders.empty() ? options.ray_orders : std::vector{RayOrder::tiles};
        for (const RayOrder order : orders)
            for (RowKey key : rows_of_scene(options, scene, backends, kernels)) {
                key.rays = kind;
                key.ray_order = order;
                rows.push_back(std::move(key));
            }
    }
    return rows;
}

/// The usable devices of the backends kept, in one line, each with the APIs that have it:
/// "llvmpipe (opencl, vulkan:1)".
std::string device_names(const Options& options, const std::vector<Backend*>& backends)
{
    std::vector<std::pair<std::string, std::string>> names;
    for (const Backend* backend : backends) {
        if (!wanted(options.backends, backend->name())) continue;
        for (std::size_t i = 0; i < backend->devices().size(); ++i) {
            const Device& device = backend->devices()[i];
            if (!device.usable) continue;
            const std::string api = i == 0 ? backend->name() : fmt::format("{}:{}", backend->name(), i);
            const auto known = std::ranges::find(names, device.name, &std::pair<std::string, std::string>::first);
            if (known == names.end())
                names.emplace_back(device.name, api);
            else
                known->second += ", " + api;
        }
    }
    std::string text;
    for (const auto& [name, apis] : names)
        append_item(text, ", ", fmt::format("{} ({})", name, apis));
    return text;
}

/// A text of --device that means no device would leave out what the user came for. If no backend kept has a usable
/// device, its rows give the reason.
void require_named_devices(const Options& options, const std::vector<Backend*>& backends)
{
    if (options.devices.empty()) return;
    const std::string names = device_names(options, backends);
    if (names.empty()) return;
    for (const std::string& text : options.devices) {
        Options one = options;
        one.devices = {text};
        const auto has_it = [&](const Backend* backend) {
            return wanted(options.backends, backend->name()) && has_usable_device(*backend) &&
                   !devices_with_rows(one, *backend).empty();
        };
        if (std::ranges::none_of(backends, has_it))
            throw Error(
                ErrorKind::missing,
                fmt::format("--device: no device's name contains {} (nor its driver, library, type, id or number); "
                            "there are: {}",
                            text, names));
    }
}

constexpr const char* crossing_rule = "; rows of --task segments, tally and absorb are of maria and project on tets "
                                      "that name their corners, of segments also of the older methods, and on openmp "
                                      "of plucker64 and barycentric, on tet80, with schedule tiles (project on half32 "
                                      "also packets), math mode exact, and rays of kinds primary, diffuse and random";

/// The reasons of the backends asked for, to explain an empty selection.
std::string reasons(const Options& options)
{
    std::string text;
    for (const KernelId& kernel : all_kernels())
        for (const Backend* backend : all_backends())
            if (wanted_kernel(options, kernel) && wanted(options.backends, backend->name()))
                if (const std::string reason = backend->why_not(0, kernel); !reason.empty())
                    text += fmt::format("\n  {} on {}: {}", name_of(kernel), backend->name(), reason);
    return text;
}

bool asks_to_cross(const Options& options)
{
    return std::ranges::any_of(options.tasks, crosses) ||
           std::ranges::any_of(options.methods, [](Method method) { return traits_of(method).has_doubles; });
}

[[noreturn]] void reject_selection(const Options& options, const std::vector<RowKey>& unfiltered)
{
    if (unfiltered.empty())
        throw Error(ErrorKind::usage,
                    "no row has this combination of --structure, --method, --layout, --task, --rays, --backend, "
                    "--device, --schedule and --math" +
                        std::string(asks_to_cross(options) ? crossing_rule : "") + reasons(options) +
                        fmt::format("\n'tetrace {} --list' prints the rows of the defaults",
                                    options.verb == Verb::check ? "check" : "bench"));
    std::string text = fmt::format("--filter '{:.200}' matches none of the {} rows selected otherwise:", options.filter,
                                   unfiltered.size());
    for (const RowKey& key : unfiltered)
        text += "\n  " + row_name(key);
    throw Error(ErrorKind::usage, text);
}

/// An option that no row obeys is a mistake.
void require_in_flight(const Options& options, const std::vector<RowKey>& rows)
{
    const auto has_it = [&](const RowKey& key) { return key.in_flight == options.launches_in_flight; };
    if (std::ranges::any_of(rows, has_it)) return;
    throw Error(ErrorKind::usage,
                fmt::format("--launches-in-flight {}: no selected row can have several; devices of kind cpu "
                            "begin a launch when the one before it has ended, and the sums of --task tally are "
                            "those of one launch; select a device of another kind, or another task",
                            options.launches_in_flight));
}

std::string numbered_backend(const RowKey& key)
{
    return key.device == 0 ? key.backend : fmt::format("{}:{}", key.backend, key.device);
}

} // namespace

bool wanted_device(const Options& options, const Backend& backend, std::size_t index)
{
    const Device& device = backend.devices()[index];
    const std::string what =
        in_lower_case(fmt::format("{}\n{}\n{}\n{}\n{}\n{}:{}", device.name, device.driver, name_of(device.kind),
                                  device.id, device.library, backend.name(), index));
    const auto holds = [&](const std::string& text) { return what.find(in_lower_case(text)) != std::string::npos; };
    return options.devices.empty() || std::ranges::any_of(options.devices, holds);
}

// Compares copies of whole keys, so that a field added later counts as a difference.
RowKey reference_row(RowKey key)
{
    key.backend = reference_backend().name();
    key.device = 0;
    key.threads = 0;
    key.in_flight = 1;
    key.kernel.schedule = Schedule::tiles;
    return key;
}

bool same_work(const RowKey& a, const RowKey& b)
{
    return reference_row(a) == reference_row(b);
}

bool same_rays(RowKey a, RowKey b)
{
    for (RowKey* key : {&a, &b}) {
        key->kernel = {.task = asked_task(key->kernel.task)};
        key->order = {};
    }
    return same_work(a, b);
}

bool same_place(const RowKey& a, const RowKey& b)
{
    RowKey there = a;
    there.backend = b.backend;
    there.device = b.device;
    return there == a && same_load(a, b);
}

bool same_load(const RowKey& a, const RowKey& b)
{
    return a.threads == b.threads && a.in_flight == b.in_flight;
}

bool on_reference(const RowKey& key)
{
    return key.backend == reference_backend().name();
}

std::string row_name(const RowKey& key)
{
    const std::string rays =
        key.kernel.task == Task::search ? std::string() : std::string("/").append(name_of(key.rays));
    const std::string order =
        key.ray_order == RayOrder::tiles ? std::string() : std::string("/rays:").append(name_of(key.ray_order));
    const std::string schedule = key.kernel.schedule == Schedule::tiles
                                     ? std::string()
                                     : std::string("/schedule:").append(name_of(key.kernel.schedule));
    return fmt::format(
        "{}/{}{}/math:{}{}{}{}/api:{}{}{}", name_of(key.kernel), key.scene, rays, name_of(key.kernel.math),
        key.order == TetOrder::chains ? std::string() : std::string("/order:").append(name_of(key.order)), schedule,
        order, numbered_backend(key), key.threads == 0 ? "" : fmt::format("/threads:{}", key.threads),
        key.in_flight == 1 ? "" : fmt::format("/in_flight:{}", key.in_flight));
}

bool is_method_of(Structure structure, Method method)
{
    return std::ranges::any_of(values_of<Task>(), [&](Task task) {
        return std::ranges::any_of(kernels_of(task), [&](const KernelId& kernel) {
            return kernel.structure == structure && kernel.method == method;
        });
    });
}

std::string device_label(const RowKey& key)
{
    std::string device = numbered_backend(key);
    if (key.threads != 0) device += fmt::format(", {}", counted(key.threads, "thread", "threads"));
    if (key.in_flight != 1) device += fmt::format(", {} in flight", key.in_flight);
    return device;
}

std::vector<std::string> missing_devices(const Options& options, const std::vector<Backend*>& backends)
{
    std::vector<std::string> sentences;
    for (const Backend* backend : backends) {
        if (!wanted(options.backends, backend->name())) continue; // nor is its driver loaded
        const bool has_rows = has_usable_device(*backend) || fails_whole(options, *backend) ||
                              (is_named(options, *backend) && has_any_kernel(*backend));
        if (!has_rows)
            sentences.push_back(fmt::format("{}: no device: {}", backend->name(), backend->devices().front().reason));
    }
    return sentences;
}

std::vector<KernelId> kernels_for(Task asked, RayKind kind)
{
    const bool has_end = kind == RayKind::shadow || kind == RayKind::ao;
    return has_end && crosses(asked) ? std::vector<KernelId>() : kernels_of(task_for(asked, kind));
}

std::string kernel_title(const RowKey& key)
{
    const KernelId& kernel = key.kernel;
    std::string title(crosses(kernel.task) ? name_of(kernel.task) : name_of(kernel.structure));
    if (kernel.structure == Structure::cdt) title.append(" ").append(name_of(kernel.method));
    title += ' ';
    if (is_embree(kernel.layout))
        title += embree_title(name_of(kernel.method), name_of(kernel.layout));
    else
        title += name_of(kernel.layout);
    if (is_portable(kernel) && kernel.math == MathMode::fast) title += " fast";
    if (key.order != TetOrder::chains) title.append(" ").append(name_of(key.order)).append(" order");
    if (kernel.schedule != Schedule::tiles) title.append(" ").append(name_of(kernel.schedule));
    if (key.rays != RayKind::primary) title.append(", ").append(name_of(key.rays));
    if (key.ray_order != RayOrder::tiles) title.append(" ").append(name_of(key.ray_order));
    return title;
}

std::optional<KernelId> kernel_named(std::string_view method, std::string_view layout, std::string_view math,
                                     std::string_view schedule, Task task)
{
    for (const KernelId& kernel : kernels_of(task))
        if (name_of(kernel.method) == method && name_of(kernel.layout) == layout && name_of(kernel.math) == math &&
            name_of(kernel.schedule) == schedule)
            return kernel;
    return std::nullopt;
}

std::string rays_title(const RowKey& key)
{
    std::string title = key.scene;
    if (crosses(key.kernel.task)) title.append(", ").append(name_of(key.kernel.task));
    if (key.rays != RayKind::primary) title += fmt::format(", {} rays", name_of(key.rays));
    if (key.ray_order != RayOrder::tiles) title += fmt::format(" {}", name_of(key.ray_order));
    return title;
}

std::string row_label(const RowKey& key)
{
    return kernel_title(key) + " on " + device_label(key);
}

std::vector<RowKey> unfiltered_rows(const Options& options, const std::vector<std::string>& scene_labels,
                                    const std::vector<Backend*>& backends)
{
    require_named_devices(options, backends);
    std::vector<RowKey> rows;
    for (const std::string& scene : scene_labels)
        for (const Task task : options.tasks.empty() ? std::vector{Task::trace} : options.tasks)
            for (const RowKey& key : rows_of_kinds(options, task, scene, backends))
                rows.push_back(key);
    if (rows.empty()) reject_selection(options, rows);
    require_in_flight(options, rows);
    return rows;
}

std::vector<RowKey> filtered_rows(const Options& options, std::vector<RowKey> rows)
{
    const NameFilter filter("--filter", options.filter);
    std::erase_if(rows, [&](const RowKey& key) { return !filter.keeps(row_name(key)); });
    return rows;
}

void require_rows(const Options& options, const std::vector<RowKey>& rows, const std::vector<RowKey>& unfiltered)
{
    if (rows.empty()) reject_selection(options, unfiltered);
}

std::vector<RowKey> select_rows(const Options& options, const std::vector<std::string>& scene_labels,
                                const std::vector<Backend*>& backends)
{
    const auto unfiltered = unfiltered_rows(options, scene_labels, backends);
    auto rows = filtered_rows(options, unfiltered);
    require_rows(options, rows, unfiltered);
    return rows;
}

std::vector<RowKey> select_search_rows(const Options& options, const std::vector<Backend*>& backends)
{
    require_named_devices(options, backends);
    std::vector<RowKey> rows;
    for (RowKey key : rows_of_scene(options, search_scene, backends, kernels_of(Task::search))) {
        if (on_reference(key)) {
            key.threads = 1;
            rows.push_back(key);
            key.threads = 0;
            if (resolved_threads(options) == 1) continue;
        }
        rows.push_back(key);
    }
    if (rows.empty()) reject_selection(options, rows);
    return filtered_rows(options, std::move(rows));
}

} // namespace tetrace
