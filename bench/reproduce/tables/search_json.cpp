#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/output/row_fields.h"
#include "bench/reproduce/speed.h"
#include "bench/results/row_keys.h"

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

/// What of its verification a row of searches does not share with a row of a scene.
void add_verification(json& object, const Traced& result)
{
    const Verdicts& verdicts = result.verdicts;
    json& verification = object[row_key::verification.key];
    verification["searches"] = verdicts.rays;
    verification["right"] = verdicts.agreed;
    if (const auto& first = verdicts.first_wrong)
        verification[row_key::first_wrong.key] =
            search_json(first->view, first->x, first->ours.face_id, "exact_face", first->reference_face);
    if (const auto& first = result.first_different)
        verification[row_key::first_different.key] =
            search_json(first->view, first->x, first->ours.face_id, "openmp_face", first->openmp.face_id);
}

json search_row_json(const SearchRun& run, std::size_t i)
{
    const RowRecord row = record_of(run.rows[i]);
    const json all = row_json(RowFacts(row));
    json object;
    // What such a row shares with a row of a scene; its rays do not walk.
    const ResultValue of_scene(all, row_name(row.key));
    for (const RowPath& field :
         {row_key::name, row_key::method, row_key::layout, row_key::backend, row_key::math, row_key::status,
          row_key::reason, row_key::device, row_key::device_index, row_key::self_test, row_key::bytes, row_key::times,
          row_key::gpu, row_key::ties, row_key::wrong, row_key::lost, row_key::compared_with_openmp,
          row_key::different_from_openmp})
        if (const auto value = of_scene.find(field)) field_in(object, field) = value->json();
    object["host_threads"] = row.key.threads == 0 ? run.threads : row.key.threads;
    const Traced* result = traced(row);
    if (result == nullptr) return object;
    if (all.contains(row_key::hit_hash.key)) object["face_hash"] = all[row_key::hit_hash.key];
    object["batches_hash"] = all[row_key::views_hash.key];
    add_verification(object, *result);
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
