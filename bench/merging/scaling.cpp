#include "bench/merging/scaling.h"

#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace tetrace {

namespace {

using nlohmann::json;

const std::string searches_name = "exit searches";

/// What the entries of one scene add up to.
struct Collected {
    std::string name;
    std::map<std::uint64_t, double> parts;
    std::vector<double> opened;
};

Collected& collected(std::vector<Collected>& all, const std::string& name)
{
    const auto known = std::ranges::find(all, name, &Collected::name);
    return known != all.end() ? *known : all.emplace_back(Collected{name, {}, {}});
}

double sum_of(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

Table scaling_table(const std::vector<MeasuredScene>& scenes, const std::vector<unsigned>& ranks)
{
    Table table({{"ranks", "ranks"},
                 {"seconds", "time", "s", 1},
                 {"speed_up", "speed-up", {}, 2},
                 {"efficiency", "efficiency", "%", 0},
                 {"open_share", "opening scenes", "%", 0},
                 {"without", "ranks without work"}});
    const double one_s = simulate(scenes, 1).seconds;
    for (const unsigned number : ranks) {
        const SimulatedRun run = simulate(scenes, number);
        table.add({std::uint64_t{number}, run.seconds, one_s / run.seconds, 100 * one_s / run.seconds / number,
                   100 * run.open_s / run.seconds, std::uint64_t{run.without}});
    }
    return table;
}

/// What no number of ranks goes below.
std::string end_sentence(const std::vector<MeasuredScene>& scenes)
{
    double open_s = 0, longest_s = 0;
    std::string longest;
    for (const MeasuredScene& scene : scenes) {
        open_s += scene.open_s;
        const double part_s = scene.parts_s.empty() ? 0 : std::ranges::max(scene.parts_s);
        if (part_s <= longest_s) continue;
        longest_s = part_s;
        longest = scene.name;
    }
    return fmt::format(
        "opening the scenes takes {} of every rank that has a part of each, and the longest part, of {}, "
        "{}: no number of ranks takes less than the larger.",
        seconds_text(open_s), longest, seconds_text(longest_s));
}

} // namespace

std::vector<MeasuredScene> measured_scenes(const std::vector<ShardResult>& shards)
{
    std::vector<Collected> all;
    for (const ShardResult& shard : shards)
        for (const json& entry : shard.journal.entries) {
            const bool is_view = entry.contains("view");
            if ((!is_view && !entry.contains("batch")) || !entry.contains("wall_s")) continue;
            Collected& scene = collected(all, is_view ? entry.at("scene").get<std::string>() : searches_name);
            scene.parts[entry.at(is_view ? "view" : "batch").get<std::uint64_t>()] = entry["wall_s"].get<double>();
            if (entry.contains("open_s")) scene.opened.push_back(entry["open_s"].get<double>());
        }
    std::vector<MeasuredScene> scenes;
    for (const Collected& one : all) {
        MeasuredScene& scene = scenes.emplace_back(MeasuredScene{one.name, 0, {}, one.name != searches_name});
        if (!one.opened.empty()) scene.open_s = sum_of(one.opened) / static_cast<double>(one.opened.size());
        for (const auto& [number, seconds] : one.parts)
            scene.parts_s.push_back(seconds);
    }
    return scenes;
}

SimulatedRun simulate(const std::vector<MeasuredScene>& scenes, unsigned ranks)
{
    SimulatedRun run{ranks};
    double all_s = 0;
    for (unsigned number = 1; number <= ranks; ++number) {
        double seconds = 0, open_s = 0;
        for (const MeasuredScene& scene : scenes) {
            const auto own = dealt(scene.parts_s, Shard{number, ranks});
            if (!own.empty()) open_s += scene.open_s;
            seconds += sum_of(own);
        }
        seconds += open_s;
        if (seconds == 0) ++run.without;
        all_s += seconds;
        if (seconds <= run.seconds) continue;
        run.seconds = seconds;
        run.open_s = open_s;
    }
    run.mean_s = all_s / ranks;
    return run;
}

std::vector<MeasuredScene> of_all_views(std::vector<MeasuredScene> scenes, std::size_t population)
{
    for (MeasuredScene& scene : scenes) {
        const std::vector<double> measured = scene.parts_s;
        if (!scene.is_of_views || measured.empty() || measured.size() >= population) continue;
        scene.parts_s.clear();
        for (std::size_t view = 0; view < population; ++view)
            scene.parts_s.push_back(measured[view * measured.size() / population]);
    }
    return scenes;
}

Sheet scaling_sheet(const std::vector<MeasuredScene>& scenes, const std::vector<unsigned>& ranks,
                    std::size_t population)
{
    if (scenes.empty())
        throw Error(ErrorKind::usage,
                    "--ranks: the journals have no wall time of a view or batch; shards of 'reproduce' "
                    "have");
    Sheet sheet;
    sheet.heading("how this run scales, by simulation");
    sheet.gap();
    sheet.table(scaling_table(scenes, ranks));
    sheet.gap();
    const auto is_sampled = [&](const MeasuredScene& scene) {
        return scene.is_of_views && scene.parts_s.size() < population;
    };
    if (std::ranges::any_of(scenes, is_sampled)) {
        sheet.heading(fmt::format("the same of all {} views, each measured one standing for those near it",
                                  with_commas(population)));
        sheet.gap();
        sheet.table(scaling_table(of_all_views(scenes, population), ranks));
        sheet.gap();
    }
    sheet.labelled("The end", end_sentence(scenes));
    sheet.labelled("Simulated", "parts take as long as they were measured to take in this run, dealt out by number; "
                                "ranks do not slow each other down; starting them and merging are left out.");
    return sheet;
}

} // namespace tetrace
