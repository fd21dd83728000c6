#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/output/row_fields.h"
#include "bench/reproduce/speed.h"

namespace tetrace {

namespace {

using nlohmann::json;

/// A search with the face that it found and the other face; a face that is NO_EXIT is left out.
json search_json(std::uint32_t tet, std::uint32_t ray, std::uint32_t face, const char* other, std::uint32_t other_face)
{
    json object = {{"tet", tet}, {"ray", ray}};
    if (face != NO_EXIT) object["face"] = face;
    if (other_face != NO_EXIT) object[other] = other_face;
    return object;
}

json search_verification(const Traced& result)
{
    const Verdicts& verdicts = result.verdicts;
    json object = {{"searches", verdicts.rays}, {"right", verdicts.agreed}, {"ties", verdicts.ties},
                   {"wrong", verdicts.wrong},   {"lost", verdicts.lost},    {"compared_with_openmp", result.compared}};
    if (result.compared) object["different_from_openmp"] = result.different;
    if (const auto& first = verdicts.first_wrong)
        object["first_wrong"] =
            search_json(first->view, first->x, first->ours.face_id, "exact_face", first->reference_face);
    if (const auto& first = result.first_different)
        object["first_different"] =
            search_json(first->view, first->x, first->ours.face_id, "openmp_face", first->openmp.face_id);
    return object;
}

/// The fields that a row of searches shares with a row of a scene; its rays do not walk.
constexpr const char* shared_keys[] = {"name",   "method",       "layout",    "backend", "math",  "status", "reason",
                                       "device", "device_index", "self_test", "bytes",   "times", "gpu"};

json search_row_json(const SearchRun& run, std::size_t i)
{
    const RowRecord row = record_of(run.rows[i]);
    const json all = row_json(RowFacts(row));
    json object;
    for (const char* key : shared_keys)
        if (all.contains(key)) object[key] = all[key];
    object["host_threads"] = row.key.threads == 0 ? run.threads : row.key.threads;
    const Traced* result = traced(row);
    if (result == nullptr) return object;
    if (all.contains("hit_hash")) object["face_hash"] = all["hit_hash"];
    object["batches_hash"] = all["views_hash"];
    object["verification"] = search_verification(*result);
    if (const auto seconds = view_seconds(run, i); !seconds.empty()) object["batch_medians_s"] = seconds;
    if (const auto figures = figures_of(row)) object["msearches_per_s"] = figures->mrays_per_s;
    return object;
}

} // namespace

nlohmann::json searches_json(const SearchRun& run)
{
    json object = {{"tets", run.size.tets},
                   {"rays_a_tet", run.size.rays},
                   {"batch_tets", run.batch_tets},
                   {"batches", run.batches_done.value_or(run.shard.share(batch_count(run.size)))},
                   {"rows", json::array()}};
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        object["rows"].push_back(search_row_json(run, i));
    return object;
}

} // namespace tetrace
