#pragma once

#include "bench/rows/row_record.h"
#include "bench/rows/scene_work.h"

#include <functional>
#include <memory>
#include <vector>

namespace tetrace {

/// Views that one launch traces together: indices in SceneWork::views(), ascending.
using ViewBatch = std::vector<std::size_t>;

/// A row while it runs: its record, and what is alive meanwhile, of which no output knows. A failure becomes the
/// record's outcome.
struct RowRun : RowRecord {
    SceneWork* scene = nullptr; ///< null if the scene could not be loaded
    Backend* backend = nullptr;
    const Packed* packed = nullptr; ///< null for kernels that are not portable
    std::unique_ptr<Session> session;
    std::filesystem::path program_file;  ///< as SessionOptions has it; its program is in no cache
    std::uint64_t max_buffer_bytes = 0;  ///< that the session may make; 0: no limit
    ViewBatch views_of_rays;             ///< views whose rays the session has been given; see prepare_batch()
    std::vector<ViewBatch> batches;      ///< of a pass of a sample: one launch each
    std::optional<GpuReadings> readings; ///< of its GPU, sample by sample
    double warm_s = 0;                   ///< wall seconds of the warm-up pass
};

/// A row that was read from a result: nothing of it is alive.
[[nodiscard]] RowRun closed_row(RowRecord record);

/// The row as it is now.
[[nodiscard]] RowRecord record_of(const RowRun& row);
[[nodiscard]] std::vector<RowRecord> records_of(const std::vector<RowRun>& rows);

/// Rows where they are, for work on some of them or on those of several scenes.
[[nodiscard]] std::vector<RowRun*> pointers_to(std::vector<RowRun>& rows);

/// Whether samples of the row are taken: it is open, and ok or flawed.
[[nodiscard]] bool is_timed(const RowRun& row);

/// Settings of a session; the same for every row of a run.
[[nodiscard]] SessionOptions session_options(const Options& options);

/// Opens a row's session on its device. Throws only Error{interrupted}.
[[nodiscard]] RowRun open_row(const RowKey& key, SceneWork& scene, const Options& options);

/// Opens the session of a row anew, after it was closed. A failure becomes the row's outcome.
void reopen_row(RowRun& row, const Options& options);

/// Opens the session of a row of task search on a device of one of the backends. The tets must outlive it. Throws as
/// the other overload does.
[[nodiscard]] RowRun open_row(const RowKey& key, const Packed& tets, const Options& options,
                              const std::vector<Backend*>& backends);

/// A row that could not be opened because its scene could not be loaded.
[[nodiscard]] RowRun failed_row(const RowKey& key, const Error& error);

/// Notes in the record what compiling for the open session has taken so far: some is done at the first launch.
void note_compiling(RowRun& row);

/// Ends a row of an interrupted run that is without hits so far.
void end_interrupted(RowRun& row);

/// Does a part of a row's work. An exception becomes the row's outcome and frees its session; Error{interrupted} is
/// passed on.
void guarded(RowRun& row, const std::function<void()>& work);

} // namespace tetrace
