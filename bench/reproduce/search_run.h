#pragma once

#include "bench/measuring/row_recorder.h"

#include <map>
#include <optional>

namespace tetrace {

/// Exit searches by themselves: random tets, random rays that stab each (core/rays/search_set.h), in batches of whole
/// tets.
struct SearchRun : RecordedRows {
    SearchSize size;
    std::uint32_t batch_tets = 0; ///< of each batch; the last may have fewer
    Shard shard;                  ///< the batches that are done, the first ones if the run is interrupted
    std::optional<std::uint32_t> batches_done = {}; ///< of an interrupted run
    unsigned threads = 1;                           ///< host threads of rows whose key gives none
    std::map<Layout, Packed> tets;                  ///< the data that sessions work on
};

/// Whether this is the row that the others' faces are compared with: openmp on one thread.
[[nodiscard]] bool is_reference(const RowKey& key);

/// Number of tets in a batch: as many as have 1,638,400 rays, 100 of the paper's. Fewer where there would be fewer than
/// 20 batches, because intervals are computed from the batches.
[[nodiscard]] std::uint32_t tets_of_batch(const SearchSize& size);
[[nodiscard]] std::uint32_t batch_count(const SearchSize& size);

/// Opens the rows of task search that the options select.
/// Throws Error{usage} if nothing is selected.
[[nodiscard]] SearchRun open_search_run(const Options& options, const std::vector<Backend*>& backends = all_backends());

/// A run of rows that were read from results, for merging: it is without tets.
[[nodiscard]] SearchRun recorded_search_run(const Options& options, const std::vector<RowRecord>& rows);

/// Does every batch with every row. Compares each face with openmp's and judges it by exact arithmetic, outside the
/// timing; then times the batch and appends it to the journal. Rows that do not fit the budget are skipped. Batches
/// that are in the journal are taken from there. In the images, a ray is a search, and what agrees is right. The first
/// wrong or different search gives its tet as the view, its number among the tet's rays as x, and local faces;
/// reference_face: the least of the faces through which it exactly leaves. Throws Error{usage} if the journal belongs
/// to other searches or rows.
void run_searches(SearchRun& run, const Options& options, const Recording& shared);

} // namespace tetrace
