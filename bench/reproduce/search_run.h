#pragma once

#include "bench/reproduce/row_recorder.h"

#include <map>

namespace tetrace {

/// Exit searches alone: random tets, random rays that stab each (core/rays/search_set.h), cut into batches of whole
/// tets.
struct SearchRun : RecordedRows {
    SearchSize size;
    std::uint32_t batch_tets = 0;  ///< of each batch but the last, which may have fewer
    unsigned threads = 1;          ///< host threads of rows whose key names none
    std::map<Layout, Packed> tets; ///< what sessions work on
};

/// Whether the others' faces are compared with this row's: openmp on one thread.
[[nodiscard]] bool is_reference(const RowKey& key);

/// How many tets a batch has: as many as have 1,638,400 rays, 100 of the paper's; fewer where there would be fewer than
/// 20 batches, for intervals come from them.
[[nodiscard]] std::uint32_t tets_of_batch(const SearchSize& size);
[[nodiscard]] std::uint32_t batch_count(const SearchSize& size);

/// Opens the rows of task search that the options select.
/// Throws Error{usage} where nothing is selected.
[[nodiscard]] SearchRun open_search_run(const Options& options, const std::vector<Backend*>& backends = all_backends());

/// Does every batch with every row: compares each face with openmp's and judges it by exact arithmetic, outside the
/// timing; then times the batch, and appends it to the journal; batches that the journal has are taken from there.
/// In images, a ray is a search, what agrees is right, and the first wrong or different one names its tet as the view,
/// its number among the tet's rays as x, and local faces; reference_face: the least of those that it exactly leaves by.
/// journal: may be null.
/// Throws Error{usage} where the journal is of other searches or rows.
void run_searches(SearchRun& run, const Options& options, Journal* journal, RunProgress& progress);

} // namespace tetrace
