#include "bench/show/recorded_rows.h"

#include "bench/rows/ray_json.h"
#include "core/base/printable.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// What a result knows of a session.
class RecordedSession final : public Session {
public:
    RecordedSession(const SetupTimes& setup, std::uint64_t bytes) : setup_(setup), bytes_(bytes) {}

    [[nodiscard]] double wait() override { refuse(); }
    [[nodiscard]] SetupTimes setup_times() const override { return setup_; }
    [[nodiscard]] std::uint64_t bytes() const override { return bytes_; }

private:
    [[noreturn]] static void refuse() { throw Error(ErrorKind::internal, "a row read from a result was launched"); }
    void start(std::span<const TraceJob>) override { refuse(); }
    void read_output(std::span<std::uint32_t>) override { refuse(); }

    SetupTimes setup_;
    std::uint64_t bytes_;
};

double number_at(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    return value ? value->number() : 0;
}

std::uint64_t count_at(const ResultValue& object, const char* key)
{
    const auto value = object.find(key);
    return value ? value->count() : 0;
}

/// The value of that name; the fallback where the object has no such key.
template <NamedEnum Enum>
Enum choice_at(const ResultValue& object, const char* key, Enum fallback)
{
    const auto value = object.find(key);
    if (!value) return fallback;
    const std::string name = value->line();
    for (const Enum one : values_of<Enum>())
        if (name == name_of(one)) return one;
    value->reject(fmt::format("is '{}', and this tetrace knows {}", name, fmt::join(enum_names<Enum>, ", ")));
}

KernelId kernel_of(const ResultValue& row, const std::string& schedule, Task task)
{
    const auto is_called = [&](const char* key, std::string_view name) { return row.at(key).line() == name; };
    for (const KernelId& kernel : kernels_of(task))
        if (is_called("structure", name_of(kernel.structure)) && is_called("method", name_of(kernel.method)) &&
            is_called("layout", name_of(kernel.layout)) && is_called("math", name_of(kernel.math)) &&
            schedule == name_of(kernel.schedule))
            return kernel;
    row.at("method").reject("and its layout, math and schedule are no kernel of this tetrace: use the one that wrote "
                            "the file");
}

RowKey key_of(const ResultValue& value, const ResultRow& row)
{
    RowKey key;
    key.scene = row.scene;
    key.backend = row.backend;
    key.device = row.device_index;
    key.rays = choice_at(value, "rays", RayKind::primary);
    key.ray_order = choice_at(value, "ray_order", RayOrder::tiles);
    key.order = choice_at(value, "order", TetOrder::chains);
    key.kernel = kernel_of(value, row.schedule, key.rays == RayKind::primary ? Task::trace : Task::rays);
    return key;
}

Backend& backend_of(const ResultValue& object)
{
    const ResultValue name = object.at("backend");
    for (Backend* backend : all_backends())
        if (backend->name() == name.line()) return *backend;
    name.reject("is no backend of this tetrace");
}

Device device_from(const ResultValue& value)
{
    Device device;
    device.name = printable_line(value.text_at("name"));
    device.kind = device_kind_of(value);
    device.driver = printable_line(value.text_at("driver"));
    device.implementation = printable_line(value.text_at("implementation"));
    device.uuid = printable_line(value.text_at("uuid"));
    device.pci = printable_line(value.text_at("pci"));
    device.group_width = static_cast<unsigned>(std::min<std::uint64_t>(count_at(value, "group_width"), UINT32_MAX));
    return device;
}

/// text() and brief() are made of the same parts as in the run.
SelfTest self_test_from(const ResultValue& value)
{
    const auto flag = [&](const char* key, bool fallback) {
        const auto found = value.find(key);
        return found ? found->flag() : fallback;
    };
    const auto ulps = [&](const char* key) {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(count_at(value, key), UINT32_MAX));
    };
    SelfTest test;
    test.contracts = flag("contracts", false);
    test.denormals_kept = flag("denormals_kept", true);
    test.division_ulps = ulps("division_ulps");
    test.square_root_ulps = ulps("square_root_ulps");
    test.sums_right = flag("sums_right", true);
    test.comparisons_right = flag("comparisons_right", true);
    test.integers_right = flag("integers_right", true);
    test.conversions_right = flag("conversions_right", true);
    test.bits_kept = flag("bits_kept", true);
    return test;
}

/// Their number, from a mean that was recorded with all its digits.
std::uint64_t steps_of(const ResultValue& counts, const char* mean, std::uint64_t rays)
{
    const double steps = number_at(counts, mean) * static_cast<double>(rays);
    return steps > 0 && steps < 1e18 ? static_cast<std::uint64_t>(std::llround(steps)) : 0;
}

RayTotals totals_from(const ResultValue& counts)
{
    RayTotals totals;
    totals.rays = counts.at("rays").count();
    totals.hits = counts.at("hits").count();
    totals.misses = counts.at("misses").count();
    totals.lost = count_at(counts, "lost");
    totals.hit_steps = steps_of(counts, "mean_steps_hit", totals.hits);
    totals.miss_steps = steps_of(counts, "mean_steps_miss", totals.misses);
    const std::uint64_t steps = count_at(counts, "steps"), known = totals.hit_steps + totals.miss_steps;
    totals.lost_steps = steps > known ? steps - known : 0;
    return totals;
}

/// A ray of a result that anyone may have written.
template <class Ray>
std::optional<Ray> ray_from(const ResultValue& verification, const char* key, Ray (*read)(const nlohmann::json&))
{
    const auto value = verification.find(key);
    if (!value) return std::nullopt;
    try {
        return read(value->json());
    } catch (const std::exception& problem) {
        value->reject(fmt::format("is no ray: {}", problem.what()));
    }
}

void read_verification(Traced& traced, const ResultValue& value)
{
    Verdicts& verdicts = traced.verdicts;
    verdicts.rays = value.at("rays").count();
    verdicts.agreed = value.at("agreed").count();
    verdicts.settled = count_at(value, "settled");
    verdicts.ties = count_at(value, "ties");
    verdicts.offset = count_at(value, "offset");
    verdicts.wrong = count_at(value, "wrong");
    verdicts.lost = count_at(value, "lost");
    verdicts.max_tie_distance = number_at(value, "largest_tie_distance");
    traced.compared = value.find("compared_with_openmp") && value.at("compared_with_openmp").flag();
    traced.different = count_at(value, "different_from_openmp");
    traced.max_ulps = count_at(value, "largest_ulps");
}

/// The rays that `check` prints.
void read_rays(Traced& traced, const ResultValue& verification)
{
    traced.first_different = ray_from(verification, "first_different", differing_ray_from);
    auto& wrong = traced.verdicts.first_wrong;
    wrong = ray_from(verification, "first_wrong", wrong_ray_from);
    if (wrong) wrong->reason = printable_text(wrong->reason);
}

Traced traced_from(const ResultValue& value, const ResultRow& row, bool with_rays)
{
    Traced traced;
    traced.totals = totals_from(value.at("counts"));
    if (const auto entering = value.at("counts").find("entering")) traced.entering = entering->count();
    if (const auto visits = value.find("visits"))
        traced.visits = {traced.totals.rays, visits->at("nodes").count(), visits->at("triangles").count()};
    if (const auto verification = value.find("verification")) {
        read_verification(traced, *verification);
        if (with_rays) read_rays(traced, *verification);
    }
    // Whether any bit differs is not recorded by itself.
    traced.inexact = value.text_at("conformity").starts_with("within") ? 1 : 0;
    if (!row.hit_hash.empty()) traced.hit_hash = std::stoull(row.hit_hash, nullptr, 16);
    if (!row.views_hash.empty()) traced.views_hash = std::stoull(row.views_hash, nullptr, 16);
    if (const auto times = value.find("times")) {
        traced.kernel_s = number_at(*times, "first_kernel_s");
        traced.wall_s = number_at(*times, "first_wall_s");
        traced.download_s = number_at(*times, "download_s");
    }
    return traced;
}

Outcome outcome_from(const ResultValue& value, const ResultRow& row, bool with_rays)
{
    const bool has_answer = value.find("counts").has_value();
    if (row.status == "skipped") return Skipped{Status::skipped, row.reason};
    if (row.status == "unsupported") return Skipped{Status::unsupported, row.reason};
    if (row.status == "error") return Failed{ErrorKind::internal, row.reason};
    if (!has_answer) return Failed{ErrorKind::wrong_result, row.reason};
    Traced traced = traced_from(value, row, with_rays);
    // Older results called rows wrong for lost rays.
    if (row.status == "wrong" && traced.different == 0) return Failed{ErrorKind::wrong_result, row.reason};
    return traced;
}

/// As medians over the samples that were kept; the first of them are those that were throttled.
void read_gpu(RowRun& run, const ResultValue& value)
{
    const auto gpu = value.find("gpu");
    if (!gpu) return;
    const auto told = [&](const char* key) {
        const auto number = gpu->find(key);
        return number ? std::optional(number->number()) : std::nullopt;
    };
    GpuReadings& readings = run.gpu.emplace();
    const GpuState state{told("clock_mhz"), told("memory_clock_mhz"), told("power_w"), told("temperature_c"), ""};
    readings.states.assign(run.samples_s.size(), state);
    readings.dropped = static_cast<std::uint32_t>(count_at(*gpu, "dropped_samples"));
    readings.reasons = printable_text(gpu->text_at("throttled_by"));
    const auto throttled = std::min<std::uint64_t>(count_at(*gpu, "throttled_samples"), readings.states.size());
    for (std::size_t i = 0; i < throttled; ++i)
        readings.states[i].throttled = readings.reasons;
}

void read_times(RowRun& run, const ResultValue& value)
{
    SetupTimes setup;
    if (const auto times = value.find("times")) {
        setup.compile_s = number_at(*times, "compile_s");
        setup.upload_s = number_at(*times, "upload_s");
        setup.compile_cached = times->find("compile_cached") && times->at("compile_cached").flag();
        if (run.key.kernel.layout == Layout::rt) setup.build_s = number_at(*times, "bvh_build_s");
        const std::size_t row_samples = run.samples_s.size();
        if (const auto walls = times->find("wall_samples_s"))
            for (const ResultValue& wall : walls->items())
                run.wall_samples_s.push_back(wall.number());
        if (const auto runs = times->find("runs");
            runs && !runs->items().empty() && row_samples % runs->items().size() == 0)
            run.run_samples.assign(runs->items().size(), row_samples / runs->items().size());
        if (const auto singles = times->find("latency_samples_s"))
            for (const ResultValue& single : singles->items())
                run.latency_samples_s.push_back(single.number());
        run.launches = {static_cast<std::uint32_t>(count_at(*times, "launches")),
                        static_cast<std::uint32_t>(count_at(*times, "latency_launches"))};
        if (const auto passes = times->find("passes")) run.passes = static_cast<std::uint32_t>(passes->count());
        if (const auto pulse = times->find("pulse")) run.pulse_ratio = pulse->number();
        if (const auto disturbed = times->find("disturbed")) run.disturbance = disturbed->line();
    }
    run.session = std::make_unique<RecordedSession>(setup, count_at(value, "bytes"));
    if (const auto times = value.find("times"))
        if (const auto build = times->find("build_s"))
            run.recorded_cost = SetupCost{build->number(), number_at(*times, "pack_s"), count_at(value, "bytes")};
}

RowRun row_from(const ResultValue& value, const ResultRow& row, bool with_rays)
{
    RowRun run;
    run.key = key_of(value, row);
    if (const auto device = value.find("device")) {
        run.backend = &backend_of(value);
        run.device = device_from(*device);
        run.device.usable = row.status != "skipped";
    }
    if (const auto test = value.find("self_test")) run.self_test = self_test_from(*test);
    run.outcome = outcome_from(value, row, with_rays);
    run.recorded_reason = row.reason;
    run.samples_s = row.samples_s;
    read_times(run, value);
    read_gpu(run, value);
    return run;
}

/// Only the row on one thread has that in its key: "/threads:1".
RowRun search_row_from(const ResultValue& value)
{
    RowRun run;
    run.key.scene = search_scene;
    run.key.backend = value.at("backend").line();
    const auto is_called = [&](const char* key, std::string_view name) { return value.at(key).line() == name; };
    const auto kernels = kernels_of(Task::search);
    const auto kernel = std::ranges::find_if(kernels, [&](const KernelId& one) {
        return is_called("method", name_of(one.method)) && is_called("layout", name_of(one.layout)) &&
               is_called("math", name_of(one.math));
    });
    if (kernel == kernels.end()) value.at("method").reject("and its layout and math are no search of this tetrace");
    run.key.kernel = *kernel;
    if (value.find("device_index")) run.key.device = value.at("device_index").count();
    if (value.at("name").line().ends_with("/threads:1")) run.key.threads = 1;
    run.backend = &backend_of(value);
    if (const auto device = value.find("device")) run.device = device_from(*device);
    if (const auto test = value.find("self_test")) run.self_test = self_test_from(*test);
    const std::string status = value.at("status").line(), reason = printable_text(value.text_at("reason"));
    if (status == "skipped") run.outcome = Skipped{Status::skipped, reason};
    if (status == "unsupported") run.outcome = Skipped{Status::unsupported, reason};
    if (status == "error") run.outcome = Failed{ErrorKind::internal, reason};
    if (status == "wrong" && !value.find("verification")) run.outcome = Failed{ErrorKind::wrong_result, reason};
    read_times(run, value);
    return run;
}

/// Those that this program has room for.
decltype(Yardstick::copies) copies_from(const ResultValue& device)
{
    decltype(Yardstick::copies) copies{};
    const auto list = device.find("copies");
    if (!list) return copies;
    const auto items = list->items();
    for (std::size_t i = 0; i < std::min(copies.size(), items.size()); ++i) {
        const auto pair = items[i].items();
        if (pair.size() != 2) items[i].reject("is no pair of bytes and bytes a second");
        copies[i] = {pair[0].count(), pair[1].number()};
    }
    return copies;
}

RowDevice row_device_from(const ResultValue& value)
{
    RowDevice device;
    device.backend = &backend_of(value);
    device.index = value.at("index").count();
    device.device = device_from(value);
    device.hardware = value.at("hardware").count();
    const double copy = number_at(value, "copy_bytes_per_s"), launch = number_at(value, "launch_s");
    if (copy > 0 || launch > 0) device.yardstick = Yardstick{copy, launch, copies_from(value)};
    if (const auto tests = value.find("self_test"))
        for (const auto& [math, test] : tests->members())
            device.self_tests[math == "fast" ? MathMode::fast : MathMode::exact] = self_test_from(test);
    device.problem = printable_text(value.text_at("problem"));
    return device;
}

} // namespace

std::vector<RowRun> read_rows(const ResultFile& file)
{
    std::vector<RowRun> rows;
    const auto values = file.section().at("rows").items();
    for (std::size_t i = 0; i < values.size(); ++i)
        rows.push_back(row_from(values[i], file.rows.at(i), file.head.verb == "check"));
    return rows;
}

std::vector<RowRun> read_search_rows(const ResultFile& file)
{
    std::vector<RowRun> rows;
    if (const auto searches = file.section().find("searches"))
        for (const ResultValue& value : searches->at("rows").items())
            rows.push_back(search_row_from(value));
    return rows;
}

std::vector<RowDevice> read_devices(const ResultFile& file, const std::vector<RowRun>& rows)
{
    const ResultValue section = file.section();
    const auto list = section.find("devices");
    if (!list) return devices_of(rows);
    std::vector<RowDevice> devices;
    for (const ResultValue& device : list->items())
        devices.push_back(row_device_from(device));
    return devices;
}

} // namespace tetrace
