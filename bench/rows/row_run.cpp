#include "bench/rows/row_run.h"

#include "bench/rows/physical_device.h"
#include "core/base/control_groups.h"
#include "core/base/printable.h"
#include "core/device/session.h"
#include "scenes/cache.h"

#include <fmt/format.h>
#include <new>

namespace tetrace {

namespace {

/// Finds the row's device; returns whether a session can be opened there.
bool find_device(RowRun& row, const std::vector<Backend*>& backends)
{
    row.backend = &backend_named(row.key.backend, backends);
    row.device = row.backend->devices().at(row.key.device);
    row.clock = row.backend->clock();
    if (row.device.broken) throw Error(ErrorKind::driver, row.device.reason);
    if (!row.device.usable) {
        row.outcome = Skipped{Status::skipped, fmt::format("{}: {}", row.device.name, row.device.reason)};
        return false;
    }
    if (row.backend->why_not(row.key.device, row.key.kernel).empty())
        row.self_test = self_test_of(*row.backend, row.key.device, row.key.kernel.math);
    return true;
}

/// What the structure cost: TetGen and our optimiser, the BVH's builder, Embree, or a GPU's driver.
void note_building(RowRun& row)
{
    const SetupTimes times = row.session->setup_times();
    RowSetup& setup = row.setup;
    setup.bytes = row.session->bytes();
    if (times.build_s > 0) setup.bvh_build_s = times.build_s;
    if (row.packed != nullptr) {
        setup.pack_s = row.packed->pack_s;
        setup.bvh_build_s = row.packed->bvh_build_s;
        row.fall_back = row.packed->fall_back;
    }
    if (row.scene == nullptr) return; // searches are without a structure
    if (row.packed == nullptr)
        setup.build_s = times.build_s > 0 ? times.build_s : times.compile_s;
    else if (setup.bvh_build_s)
        setup.build_s = setup.bvh_build_s;
    else if (const double built_s = row.scene->loaded().scene.build.build_s; built_s > 0)
        setup.build_s = built_s; // tets that were stored have none
}

void open_session(RowRun& row, const SceneData& data, const Options& options)
{
    SessionOptions session = session_options(options);
    if (row.key.threads != 0) session.threads = row.key.threads;
    session.program_file = row.program_file;
    if (!row.program_file.empty()) session.program_cache.clear();
    row.max_buffer_bytes = max_buffer(row.device, session);
    row.session = row.backend->open(row.key.device, row.key.kernel, data, session);
    note_building(row);
    note_compiling(row);
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

} // namespace

RowRun closed_row(RowRecord record)
{
    RowRun row;
    static_cast<RowRecord&>(row) = std::move(record);
    return row;
}

RowRecord record_of(const RowRun& row)
{
    RowRecord record = row;
    if (row.readings) record.gpu = row.readings->summary();
    return record;
}

std::vector<RowRecord> records_of(const std::vector<RowRun>& rows)
{
    std::vector<RowRecord> records;
    for (const RowRun& row : rows)
        records.push_back(record_of(row));
    return records;
}

std::vector<RowRun*> pointers_to(std::vector<RowRun>& rows)
{
    std::vector<RowRun*> pointers;
    for (RowRun& row : rows)
        pointers.push_back(&row);
    return pointers;
}

bool is_timed(const RowRun& row)
{
    return row.session != nullptr && has_answers(row);
}

void note_compiling(RowRun& row)
{
    const SetupTimes times = row.session->setup_times();
    row.setup.compile_s = times.compile_s;
    row.setup.compile_cached = times.compile_cached;
    row.setup.upload_s = times.upload_s;
}

void end_interrupted(RowRun& row)
{
    row.outcome = Skipped{Status::skipped, "the run was interrupted before the row had an answer"};
    row.session.reset();
    row.setup = {};
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
        row.outcome = Skipped{Status::unsupported,
                              "out of memory" + memory_limit_text() + "; use a smaller --size or fewer rows"};
    } catch (const std::exception& error) {
        row.outcome = Failed{ErrorKind::internal, printable_text(error.what())};
    }
    row.session.reset();
    row.setup = {};
}

namespace {

/// Empty if the environment names no cache folder; then no program is kept.
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

} // namespace tetrace
