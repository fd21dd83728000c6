#include "bench/output/score.h"

#include "bench/measuring/figures.h"
#include "bench/results/result_value.h"
#include "bench/statistics/statistics.h"
#include "core/base/hash.h"
#include "scenes/pinned.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>
#include <set>

namespace tetrace {

namespace {

bool is_pinned_work(const ResultValue& scene, const PinnedScene& pinned, const Workload& workload,
                    const std::vector<std::uint32_t>& views)
{
    const auto cameras = scene.find("camera_set_hash");
    if (scene.at("hash").hash() != hash_text(pinned.scene_hash)) return false;
    if (!cameras || cameras->hash() != hash_text(pinned.cameras_hash)) return false;
    if (scene.at("width").count() != workload.size || scene.at("height").count() != workload.size) return false;
    return std::ranges::equal(scene.at("views").items(), views, {}, &ResultValue::count);
}

/// Whether the records are those of the workload's scenes, in any order.
bool has_scenes_of(const Workload& workload, const std::vector<nlohmann::json>& scenes)
{
    Options options;
    options.views = workload.views;
    const std::vector<std::uint32_t> views = selected_views(options);
    return scenes.size() == workload.scenes.size() && std::ranges::all_of(workload.scenes, [&](const auto& name) {
               return std::ranges::any_of(scenes, [&](const nlohmann::json& scene) {
                   return is_pinned_work(ResultValue(scene, "scene"), *find_pinned(name), workload, views);
               });
           });
}

/// Whether the row traced rays of the workload; rows that were not traced have none.
bool has_rays_of(const Workload& workload, const RowRecord& row)
{
    if (!traits_of(row.key.kernel.task).finds_hits) return false;
    for (const Workload::Rays& rays : workload.rays)
        if (rays.kind == row.key.rays && row.key.ray_order == RayOrder::tiles) {
            if (!row.ray_hash || rays.hashes.empty()) return true;
            for (std::size_t i = 0; i < workload.scenes.size(); ++i)
                if (find_pinned(workload.scenes[i])->of == row.key.scene) return rays.hashes[i] == *row.ray_hash;
        }
    return false;
}

/// What one score is of: a kernel in one place.
bool same_score(const RowRecord& a, const RowRecord& b)
{
    RowKey key = b.key;
    key.scene = a.key.scene;
    key.rays = a.key.rays;
    key.kernel.task = a.key.kernel.task; // given rays have kernels of their own
    return a.key == key;
}

/// In units of the medians of the rows' seconds: their geometric mean is divided into it for a score.
double mean_mrays(const std::vector<const RowRecord*>& rows)
{
    double sum = 0;
    for (const RowRecord* row : rows)
        sum += std::log(1e-6 * static_cast<double>(traced(*row)->totals.rays));
    return std::exp(sum / static_cast<double>(rows.size()));
}

/// Of the rows' samples, or of those of one run.
MedianRatio mean_seconds(const std::vector<const RowRecord*>& rows, std::optional<std::size_t> run = {})
{
    std::vector<std::vector<double>> lists;
    for (const RowRecord* row : rows)
        lists.push_back(run ? samples_of_runs(*row).at(*run) : row->samples_s);
    return geometric_mean_of_medians(lists);
}

std::vector<const RowRecord*> timed_rows(const Score& score)
{
    std::vector<const RowRecord*> timed;
    std::ranges::copy_if(score.rows, std::back_inserter(timed),
                         [](const RowRecord* row) { return figures_of(*row).has_value(); });
    return timed;
}

/// By the samples of one run; over several, the range of their own scores.
FactorInterval interval_of(const Score& score)
{
    const double mrays = mean_mrays(score.rows);
    const std::size_t runs = score.rows.front()->run_samples.size();
    if (runs <= 1) {
        const MedianRatio seconds = mean_seconds(score.rows);
        return {mrays / seconds.high, mrays / seconds.low};
    }
    std::vector<double> scores;
    for (std::size_t run = 0; run < runs; ++run)
        scores.push_back(mrays / mean_seconds(score.rows, run).value);
    const auto [low, high] = std::ranges::minmax(scores);
    return {std::min(low, score.mrays_per_s), std::max(high, score.mrays_per_s)};
}

std::string reason_against(const Score& score, const Workload* workload)
{
    if (workload == nullptr) return "not a workload";
    const std::size_t all = workload->scenes.size() * workload->rays.size();
    std::size_t noisy = 0, fewest = min_samples;
    bool same_runs = true;
    for (const RowRecord* row : score.rows) {
        const auto figures = figures_of(*row);
        if (status_of(*row) != Status::ok || !figures)
            return fmt::format("{} is {}", rays_title(row->key),
                               status_of(*row) == Status::ok ? "not timed" : name_of(status_of(*row)));
        noisy += figures->noisy ? 1 : 0;
        fewest = std::min(fewest, row->samples_s.size());
        same_runs = same_runs && row->run_samples.size() == score.rows.front()->run_samples.size();
    }
    if (score.rows.size() < all) return fmt::format("{} of {} rows are missing", all - score.rows.size(), all);
    if (fewest < min_samples) return fmt::format("fewer than {} samples", min_samples);
    if (!same_runs) return "a run was interrupted";
    return noisy > 0 ? fmt::format("{} of {} rows are noisy", noisy, all) : std::string();
}

std::optional<double> rate_of(const RowRecord& row)
{
    const auto figures = figures_of(row);
    return figures ? std::optional(figures->mrays_per_s) : std::nullopt;
}

} // namespace

const Workload* workload_of(const std::vector<nlohmann::json>& scenes, const std::vector<RowRecord>& rows)
{
    std::set<RayKind> kinds;
    for (const RowRecord& row : rows)
        kinds.insert(row.key.rays);
    for (const Workload& workload : workloads())
        if (workload.rays.size() == kinds.size() && has_scenes_of(workload, scenes) &&
            std::ranges::all_of(rows, [&](const RowRecord& row) { return has_rays_of(workload, row); }))
            return &workload;
    return nullptr;
}

std::string Score::title() const
{
    RowKey key = rows.front()->key;
    key.rays = RayKind::primary;
    return kernel_title(key);
}

std::string Score::text() const
{
    if (!is_score()) return {};
    return fmt::format("{:.2f} [{:.2f}, {:.2f}]", mrays_per_s, interval.low, interval.high);
}

std::vector<Score> scores_of(const Workload* workload, const std::vector<RowRecord>& rows)
{
    std::vector<Score> scores;
    for (const RowRecord& row : rows) {
        const auto found =
            std::ranges::find_if(scores, [&](const Score& score) { return same_score(*score.rows.front(), row); });
        (found == scores.end() ? scores.emplace_back() : *found).rows.push_back(&row);
    }
    for (Score& score : scores) {
        score.reason = reason_against(score, workload);
        const auto timed = timed_rows(score);
        if (!timed.empty()) score.mrays_per_s = mean_mrays(timed) / mean_seconds(timed).value;
        if (score.is_score()) score.interval = interval_of(score);
    }
    std::ranges::stable_sort(scores, std::ranges::greater(), &Score::mrays_per_s);
    return scores;
}

Table score_table(const std::vector<Score>& scores, bool with_reasons)
{
    std::vector<Column> columns = {{"row", "row"}, {"backend", "backend"}, {"score", "score", "Mrays/s", 2, false, 0}};
    std::vector<std::string> titles;
    for (const Score& score : scores)
        for (const RowRecord* row : score.rows)
            if (std::ranges::find(titles, rays_title(row->key)) == titles.end()) titles.push_back(rays_title(row->key));
    for (const std::string& title : titles)
        columns.push_back({title, title, "", 1});
    if (with_reasons) columns.push_back({"reason", "no score because"});
    Table table(columns);
    for (const Score& score : scores) {
        const RowKey& key = score.rows.front()->key;
        std::vector<Cell> cells = {score.title(), device_label(key), text_cell(score.text())};
        for (const std::string& title : titles) {
            const auto row =
                std::ranges::find_if(score.rows, [&](const RowRecord* of) { return rays_title(of->key) == title; });
            cells.push_back(row != score.rows.end() ? cell_of(rate_of(**row)) : Cell());
        }
        if (with_reasons) cells.push_back(text_cell(score.reason));
        table.add(std::move(cells));
    }
    return table;
}

nlohmann::json scores_json(const std::vector<Score>& scores)
{
    nlohmann::json list = nlohmann::json::array();
    for (const Score& score : scores) {
        const RowKey& key = score.rows.front()->key;
        nlohmann::json object = {{"row", score.title()}, {"backend", key.backend}, {"device_index", key.device}};
        if (key.threads > 0) object["threads"] = key.threads;
        if (key.in_flight > 1) object["launches_in_flight"] = key.in_flight;
        for (const RowRecord* row : score.rows)
            object["rows"].push_back(row_name(row->key));
        if (score.is_score()) {
            object["mrays_per_s"] = score.mrays_per_s;
            object["low"] = score.interval.low;
            object["high"] = score.interval.high;
        } else {
            object["reason"] = score.reason;
        }
        list.push_back(std::move(object));
    }
    return list;
}

} // namespace tetrace
