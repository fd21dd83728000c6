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

constexpr double score_error = 0.05; // of the interval: the chance that it misses

bool is_pinned_work(const ResultValue& scene, const PinnedScene& pinned, const Workload& workload,
                    const std::vector<std::uint32_t>& views)
{
    const auto cameras = scene.find("camera_set_hash");
    if (scene.at("hash").hash() != hash_text(pinned.scene_hash)) return false;
    if (!cameras || cameras->hash() != hash_text(pinned.cameras_hash)) return false;
    if (scene.at("width").count() != workload.size || scene.at("height").count() != workload.size) return false;
    return std::ranges::equal(scene.at("views").items(), views, {}, &ResultValue::count);
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

/// The geometric mean of the rates of timed rows, each row's device seconds by `seconds`; 0 if none is timed.
template <class Seconds>
double mean_rate(const Score& score, const Seconds& seconds)
{
    double sum = 0;
    int count = 0;
    for (const RowRecord* row : score.rows) {
        if (!figures_of(*row)) continue;
        sum += std::log(1e-6 * static_cast<double>(traced(*row)->totals.rays) / seconds(*row));
        ++count;
    }
    return count > 0 ? std::exp(sum / count) : 0;
}

/// The range of the runs' own scores.
FactorInterval range_over_runs(const Score& score)
{
    std::vector<double> scores;
    for (std::size_t run = 0; run < score.rows.front()->run_samples.size(); ++run)
        scores.push_back(
            mean_rate(score, [&](const RowRecord& row) { return statistics_of(samples_of_runs(row).at(run)).median; }));
    const auto [low, high] = std::ranges::minmax(scores);
    return {low, high};
}

/// All medians are between their bounds at once, but in score_error of all cases, and so is their mean.
std::optional<FactorInterval> interval_of(const Score& score)
{
    if (score.rows.front()->run_samples.size() > 1) return range_over_runs(score);
    const double error = score_error / static_cast<double>(score.rows.size());
    for (const RowRecord* row : score.rows)
        if (!median_interval(row->samples_s, error)) return std::nullopt;
    return FactorInterval{
        mean_rate(score, [&](const RowRecord& row) { return median_interval(row.samples_s, error)->high; }),
        mean_rate(score, [&](const RowRecord& row) { return median_interval(row.samples_s, error)->low; })};
}

std::string reason_against(const Score& score, const Workload* workload)
{
    if (workload == nullptr) return "not a workload";
    const std::size_t all = workload->scenes.size() * workload->rays.size();
    std::size_t noisy = 0;
    for (const RowRecord* row : score.rows) {
        const auto figures = figures_of(*row);
        if (status_of(*row) != Status::ok || !figures)
            return fmt::format("{} is {}", rays_title(row->key),
                               status_of(*row) == Status::ok ? "not timed" : name_of(status_of(*row)));
        noisy += figures->noisy ? 1 : 0;
    }
    if (score.rows.size() < all) return fmt::format("{} of {} rows are missing", all - score.rows.size(), all);
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
    for (const Workload& workload : workloads()) {
        if (scenes.size() != workload.scenes.size()) continue;
        Options options;
        options.views = workload.views;
        const std::vector<std::uint32_t> views = selected_views(options);
        std::size_t same = 0;
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            const PinnedScene* const pinned = find_pinned(workload.scenes[i]);
            same += is_pinned_work(ResultValue(scenes[i], "scene"), *pinned, workload, views) ? 1 : 0;
        }
        std::set<RayKind> kinds;
        for (const RowRecord& row : rows)
            kinds.insert(row.key.rays);
        if (same == scenes.size() && kinds == std::set<RayKind>(workload.rays.begin(), workload.rays.end()))
            return &workload;
    }
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
    if (!interval) return fmt::format("{:.2f}", mrays_per_s);
    return fmt::format("{:.2f} [{:.2f}, {:.2f}]", mrays_per_s, interval->low, interval->high);
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
        score.mrays_per_s = mean_rate(score, [](const RowRecord& row) { return statistics_of(row.samples_s).median; });
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
        for (const RowRecord* row : score.rows)
            object["rows"].push_back(row_name(row->key));
        if (score.is_score())
            object["mrays_per_s"] = score.mrays_per_s;
        else
            object["reason"] = score.reason;
        if (score.interval) {
            object["low"] = score.interval->low;
            object["high"] = score.interval->high;
        }
        list.push_back(std::move(object));
    }
    return list;
}

} // namespace tetrace
