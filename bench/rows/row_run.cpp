#include "bench/rows/row_run.h"

#include "bench/rows/device_abilities.h"
#include "core/base/hash.h"
#include "core/base/printable.h"
#include "core/device/open_checks.h"
#include "scenes/cache.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <new>

namespace tetrace {

namespace {

Backend& backend_named(const std::string& name, const std::vector<Backend*>& backends)
{
    for (Backend* backend : backends)
        if (backend->name() == name) return *backend;
    throw Error(ErrorKind::internal, "no backend is named " + name);
}

/// Finds the row's device; returns whether a session can be opened there.
bool find_device(RowRun& row, const std::vector<Backend*>& backends)
{
    row.backend = &backend_named(row.key.backend, backends);
    row.device = row.backend->devices().at(row.key.device);
    if (row.device.broken) throw Error(ErrorKind::driver, row.device.reason);
    if (!row.device.usable) {
        row.outcome = Skipped{Status::skipped, fmt::format("{}: {}", row.device.name, row.device.reason)};
        return false;
    }
    if (row.backend->why_not(row.key.device, row.key.kernel).empty())
        row.self_test = self_test_of(*row.backend, row.key.device, row.key.kernel.math);
    return true;
}

void open_session(RowRun& row, const SceneData& data, const Options& options)
{
    SessionOptions session = session_options(options);
    if (row.key.threads != 0) session.threads = row.key.threads;
    row.max_buffer_bytes = max_buffer(row.device, session);
    row.session = row.backend->open(row.key.device, row.key.kernel, data, session);
}

SceneData scene_data(const RowRun& row)
{
    return {&row.scene->loaded().scene.mesh, row.packed ? &row.packed->data : nullptr};
}

void open_on_scene(RowRun& row, const Options& options)
{
    if (!find_device(row, all_backends())) return;
    const auto& no_tets = row.scene->loaded().no_tets;
    if (no_tets && row.key.kernel.structure == Structure::cdt) throw Error(*no_tets);
    if (is_portable(row.key.kernel)) row.packed = &row.scene->packed(row.key.kernel.layout, row.key.order);
    open_session(row, scene_data(row), options);
}

std::string traced_reason(const RowRun& row, const Traced& traced)
{
    std::string text;
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    };
    add(traced.different, "different from openmp's");
    add(traced.verdicts.lost, "lost");
    if (traced.lost_at_device_cap > 0)
        text += fmt::format(" ({} after {} steps, where loops of {} may end early)", traced.lost_at_device_cap,
                            row.device.max_steps, row.device.implementation);
    add(traced.verdicts.wrong, "wrong");
    if (row.key.kernel.math == MathMode::fast && is_portable(row.key.kernel) && !traced.verdicts.clean())
        text += "; math mode fast is held to no proof";
    return text;
}

} // namespace

void Visits::add(const Visits& other)
{
    rays += other.rays;
    nodes += other.nodes;
    triangles += other.triangles;
}

void Traced::add(const ImageVerdict& image)
{
    totals.add(image.totals);
    if (image.entering) entering = entering.value_or(0) + *image.entering;
    visits.add(image.visits);
    verdicts.add(image.verdicts);
    compared = compared || image.compared;
    different += image.different;
    inexact += image.inexact;
    max_ulps = std::max(max_ulps, image.max_ulps);
    lost_at_device_cap += image.lost_at_device_cap;
    if (!first_different) first_different = image.first_different;
    kernel_s += image.kernel_s;
    wall_s += image.wall_s;
    download_s += image.download_s;
    views_hash = hash_of(std::array{image.hit_hash}, views_hash);
}

std::string device_kind_text(const RowRun& row)
{
    return row.device.name.empty() ? std::string() : std::string(name_of(row.device.kind));
}

std::vector<const RowRun*> rows_of(const std::string& scene, const std::vector<RowRun>& rows)
{
    std::vector<const RowRun*> found;
    for (const RowRun& row : rows)
        if (row.key.scene == scene) found.push_back(&row);
    return found;
}

std::vector<std::vector<double>> samples_of_runs(const RowRun& row)
{
    std::vector<std::vector<double>> runs;
    auto next = row.samples_s.begin();
    for (const std::size_t samples : row.run_samples) {
        const auto end = next + static_cast<std::ptrdiff_t>(samples);
        runs.emplace_back(next, end);
        next = end;
    }
    if (runs.empty()) runs.push_back(row.samples_s);
    return runs;
}

const Traced* traced(const RowRun& row)
{
    return std::get_if<Traced>(&row.outcome);
}

Status status_of(const RowRun& row)
{
    if (const auto* skipped = std::get_if<Skipped>(&row.outcome)) return skipped->status;
    if (const auto* failed = std::get_if<Failed>(&row.outcome))
        return failed->kind == ErrorKind::wrong_result ? Status::wrong : Status::error;
    const Traced* result = traced(row);
    if (result->different > 0) return Status::wrong;
    return result->verdicts.wrong + result->verdicts.lost > 0 ? Status::flawed : Status::ok;
}

bool is_timed(const RowRun& row)
{
    const Status status = status_of(row);
    return row.session != nullptr && (status == Status::ok || status == Status::flawed);
}

std::optional<SetupCost> setup_cost(const RowRun& row)
{
    if (row.recorded_cost) return row.recorded_cost;
    if (row.session == nullptr || row.scene == nullptr) return std::nullopt;
    SetupCost cost;
    cost.bytes = row.session->bytes();
    if (row.packed == nullptr) {
        const SetupTimes setup = row.session->setup_times();
        cost.build_s = setup.build_s > 0 ? setup.build_s : setup.compile_s; // a driver's; Embree's
        return cost;
    }
    cost.build_s = row.packed->bvh_build_s.value_or(row.scene->loaded().scene.build.build_s);
    cost.pack_s = row.packed->pack_s;
    return cost;
}

std::string reason_of(const RowRun& row)
{
    if (!row.recorded_reason.empty()) return row.recorded_reason;
    if (const auto* skipped = std::get_if<Skipped>(&row.outcome)) return skipped->reason;
    if (const auto* failed = std::get_if<Failed>(&row.outcome)) return failed->what;
    return traced_reason(row, std::get<Traced>(row.outcome));
}

void guarded(RowRun& row, const std::function<void()>& work)
{
    try {
        work();
        return;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        if (error.kind() == ErrorKind::unsupported)
            row.outcome = Skipped{Status::unsupported, printable_text(error.what())};
        else
            row.outcome = Failed{error.kind(), printable_text(error.what())};
    } catch (const std::bad_alloc&) {
        row.outcome = Skipped{Status::unsupported, "out of memory; use a smaller --size or fewer rows"};
    } catch (const std::exception& error) {
        row.outcome = Failed{ErrorKind::internal, printable_text(error.what())};
    }
    row.session.reset();
}

namespace {

/// Empty where the environment names no cache folder; then no program is kept.
std::filesystem::path program_cache()
{
    try {
        return cache_directory() / "programs";
    } catch (const Error&) {
        return {};
    }
}

} // namespace

SessionOptions session_options(const Options& options)
{
    SessionOptions session;
    session.threads = resolved_threads(options);
    session.tile_height = options.tile_height;
    session.packet_lanes = options.packet_lanes;
    session.max_buffer_bytes = options.buffer_limit;
    session.program_cache = program_cache();
    return session;
}

RowRun open_row(const RowKey& key, SceneWork& scene, const Options& options)
{
    RowRun row;
    row.key = key;
    row.scene = &scene;
    guarded(row, [&] { open_on_scene(row, options); });
    return row;
}

void reopen_row(RowRun& row, const Options& options)
{
    row.views_of_rays.clear();
    guarded(row, [&] { open_session(row, scene_data(row), options); });
}

RowRun open_row(const RowKey& key, const Packed& tets, const Options& options, const std::vector<Backend*>& backends)
{
    RowRun row;
    row.key = key;
    row.packed = &tets;
    guarded(row, [&] {
        if (find_device(row, backends)) open_session(row, {nullptr, &tets.data}, options);
    });
    return row;
}

RowRun failed_row(const RowKey& key, const Error& error)
{
    RowRun row;
    row.key = key;
    guarded(row, [&] { throw error; });
    return row;
}

bool fails(const RowRun& row, bool flawed_passes)
{
    const Status status = status_of(row);
    if (status != Status::flawed) return status == Status::wrong;
    return claims_robustness(row.key.kernel) && (traced(row)->verdicts.lost > 0 || !flawed_passes);
}

int exit_code(const std::vector<RowRun>& rows, bool flawed_passes)
{
    if (std::ranges::any_of(rows, [&](const RowRun& row) { return fails(row, flawed_passes); })) return 1;
    for (const RowRun& row : rows)
        if (const auto* failed = std::get_if<Failed>(&row.outcome)) return exit_code(failed->kind);
    return 0;
}

} // namespace tetrace
