#include "bench/merging/merged_rows.h"

#include "bench/measuring/image_record.h"
#include "bench/results/row_keys.h"
#include "bench/show/recorded_rows.h"
#include "bench/statistics/statistics.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"
#include "core/base/hash.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* device_keys[] = {"name", "driver", "type"};

json device_kind(const json& device)
{
    json kind = json::object();
    for (const char* key : device_keys)
        if (device.contains(key)) kind[key] = device[key];
    return kind;
}

/// What makes a processor's times its own.
json host_kind(const json& section)
{
    json kind = {{"host", section.at("host")}, {"threads", section.value("threads", 0)}};
    kind["host"].erase("system"); // the kernel's release differs from node to node
    if (section.contains("label")) kind["label"] = section["label"];
    return kind;
}

/// The rows of scenes, and those of searches.
std::vector<ResultValue> rows_of(const ShardResult& shard)
{
    const ResultValue section = shard.result.section();
    std::vector<ResultValue> rows = section.at("rows").items();
    if (const auto searches = section.find("searches"))
        std::ranges::move(searches->at("rows").items(), std::back_inserter(rows));
    return rows;
}

json machine_kind(const ShardResult& shard)
{
    const json& section = shard.section();
    json kind = host_kind(section);
    kind["devices"] = json::array();
    if (section.contains("devices"))
        for (const json& device : section["devices"])
            kind["devices"].push_back(device_kind(device));
    return kind;
}

/// What a kind of machine did of a row.
struct Work {
    double rays = 0, seconds = 0;
};

std::uint64_t rays_of(const ResultValue& row)
{
    if (const auto rays = row.find(row_key::ray_count)) return rays->count();
    const auto verification = row.find(row_key::verification);
    const auto searches = verification ? verification->find("searches") : std::nullopt;
    return searches ? searches->count() : 0;
}

void add_work(std::vector<std::pair<std::string, Work>>& all, const ResultValue& row)
{
    const auto samples_s = row.find(row_key::samples_s);
    if (!samples_s) return;
    const std::string name = row.at(row_key::name).line();
    auto place = std::ranges::find(all, name, &std::pair<std::string, Work>::first);
    if (place == all.end()) place = all.insert(all.end(), {name, {}});
    place->second.rays += static_cast<double>(rays_of(row));
    place->second.seconds += statistics_of(samples_s->json().get<std::vector<double>>()).median;
}

json rates_json(const std::vector<std::pair<std::string, Work>>& all)
{
    json rows = json::array();
    for (const auto& [name, work] : all)
        if (work.seconds > 0 && work.rays > 0)
            rows.push_back({{"name", name}, {"mrays_per_s", 1e-6 * work.rays / work.seconds}});
    return rows;
}

} // namespace

bool is_of_one_kind(const std::vector<ShardResult>& shards, const std::string& name)
{
    std::vector<json> kinds;
    for (const ShardResult& shard : shards)
        for (const ResultRow* row : shard.result.timed_rows())
            if (row->name == name) {
                json kind = host_kind(shard.section());
                if (row->device_kind) kind["device"] = {row->device, row->driver, name_of(*row->device_kind)};
                kinds.push_back(std::move(kind));
            }
    return std::ranges::adjacent_find(kinds, std::not_equal_to<>()) == kinds.end();
}

nlohmann::json machines_json(const std::vector<ShardResult>& shards)
{
    std::map<json, std::vector<const ShardResult*>> kinds;
    std::vector<json> order; // by the first shard of each
    for (const ShardResult& shard : shards) {
        auto& same = kinds[machine_kind(shard)];
        if (same.empty()) order.push_back(machine_kind(shard));
        same.push_back(&shard);
    }
    json machines = json::array();
    for (const json& kind : order) {
        json machine = {{"shards", json::array()},
                        {"host", kinds[kind].front()->section().at("host")},
                        {"devices", kind["devices"]}};
        if (kind.contains("label")) machine["label"] = kind["label"];
        std::vector<std::pair<std::string, Work>> work;
        for (const ShardResult* shard : kinds[kind]) {
            machine["shards"].push_back(shard->shard.number);
            for (const ResultValue& row : rows_of(*shard))
                add_work(work, row);
        }
        machine["rows"] = rates_json(work);
        machines.push_back(std::move(machine));
    }
    return machines;
}

Sheet machines_sheet(const nlohmann::json& merged)
{
    Sheet sheet;
    sheet.heading(fmt::format("merged of {} shards", merged.at("shards").get<std::uint64_t>()));
    sheet.gap();
    Table table({{"machine", "machine"}, {"shards", "shards"}, {"devices", "devices"}, {"rows", "rows timed"}});
    for (const json& machine : merged.at("machines")) {
        std::vector<std::string> devices;
        for (const json& device : machine.at("devices"))
            if (const std::string name = device.value("name", ""); std::ranges::find(devices, name) == devices.end())
                devices.push_back(name);
        const std::string cpu = machine.at("host").value("cpu", "");
        const auto numbers = machine.at("shards").get<std::vector<unsigned>>();
        table.add({machine.value("label", cpu), fmt::format("{}", fmt::join(numbers, ", ")),
                   text_cell(fmt::format("{}", fmt::join(devices, ", "))), std::uint64_t{machine.at("rows").size()}});
    }
    sheet.table(table);
    sheet.gap();
    sheet.labelled("Times",
                   "each machine's rates are its own, in the JSON (merged.machines); a row's times are put "
                   "together where one kind of machine, device and driver took all of them. Shards that ran at "
                   "the same time on one machine shared its memory.");
    return sheet;
}

void set_origin(nlohmann::json& section, const std::vector<ShardResult>& shards)
{
    const json& first = shards.front().section();
    for (const char* key : {"host", "label", "conditions"}) {
        section.erase(key);
        if (first.contains(key)) section[key] = first[key];
    }
    section.erase("command"); // each shard had one of its own
    section["merged"] = {{"shards", shards.size()}, {"machines", machines_json(shards)}};
}

namespace {

using nlohmann::json;

std::vector<RowRecord> rows_of(const ShardResult& shard, bool searches)
{
    return searches ? read_search_rows(shard.result) : read_rows(shard.result);
}

/// What the whole run finds out again, or does not have.
void forget_answers(RowRecord& row)
{
    row.samples_s.clear();
    row.wall_samples_s.clear();
    row.latency_samples_s.clear();
    row.run_samples.clear();
    row.launches = {};
    if (traced(row) != nullptr) row.outcome = Traced{};
}

/// The place of an entry in the whole run: scenes in the order of the shards' first entries.
struct EntryPlace {
    std::size_t scene = 0;
    std::uint64_t part = 0;

    friend auto operator<=>(const EntryPlace&, const EntryPlace&) = default;
};

/// Rows whose times are not put together, among all that were asked about.
class StrippedRows {
public:
    explicit StrippedRows(const std::vector<ShardResult>& shards) : shards_(&shards) {}

    [[nodiscard]] bool has(const std::string& row)
    {
        const auto known = known_.find(row);
        if (known != known_.end()) return known->second;
        return known_.emplace(row, !is_of_one_kind(*shards_, row)).first->second;
    }

private:
    const std::vector<ShardResult>* shards_;
    std::map<std::string, bool> known_;
};

void strip(json& entry, StrippedRows& stripped)
{
    for (auto& [name, record] : entry.at("rows").items()) {
        if (record.contains("chained_hash")) record["chained_hash"] = hash_text(0);
        if (stripped.has(name)) drop_samples(record);
    }
}

std::size_t number_of(std::vector<std::string>& names, const std::string& name)
{
    const auto known = std::ranges::find(names, name);
    if (known != names.end()) return static_cast<std::size_t>(known - names.begin());
    names.push_back(name);
    return names.size() - 1;
}

/// The record of each row of a scene, view after view.
using Views = std::map<std::uint32_t, const json*>;

Views views_of(const std::vector<ShardResult>& shards, const std::string& scene)
{
    Views found;
    for (const ShardResult& shard : shards)
        for (const json& entry : shard.journal.entries) {
            if (entry.value("scene", "") != scene) continue;
            const auto view = entry.at("view").get<std::uint32_t>();
            if (!found.emplace(view, &entry).second)
                throw Error(ErrorKind::usage,
                            fmt::format("merging shards: view {} of {} is in two journals", view, scene));
        }
    return found;
}

void require_views(const Views& found, const std::vector<std::uint32_t>& asked, const std::string& scene)
{
    std::vector<std::uint32_t> missing;
    std::ranges::copy_if(asked, std::back_inserter(missing), [&](std::uint32_t view) { return !found.contains(view); });
    if (!missing.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("merging shards: views {} of {} are in no journal", fmt::join(missing, ", "), scene));
}

void add_answers(RowRecord& row, const Views& views)
{
    const std::string name = row_name(row.key);
    for (const auto& [view, entry] : views) {
        if (traced(row) == nullptr) return;
        const json& rows = entry->at("rows");
        if (!rows.contains(name))
            throw Error(ErrorKind::usage, fmt::format("merging shards: view {} lacks hits of {}", view, name));
        ImageOutcome outcome = outcome_from_json(rows[name]);
        if (const auto* record = std::get_if<ImageRecord>(&outcome)) std::get<Traced>(row.outcome).add(record->verdict);
        if (auto* skipped = std::get_if<Skipped>(&outcome)) row.outcome = *skipped;
        if (auto* failed = std::get_if<Failed>(&outcome)) row.outcome = *failed;
    }
}

/// The walk of a ray of the whole run, as the shard that found it has it.
void add_walks(Traced& whole, const Traced& part)
{
    const auto is_same = [](const auto& a, const auto& b) {
        return a && b && a->view == b->view && a->x == b->x && a->y == b->y;
    };
    if (is_same(whole.first_different, part.first_different)) whole.walk_of_different = part.walk_of_different;
    if (is_same(whole.verdicts.first_wrong, part.verdicts.first_wrong)) whole.walk_of_wrong = part.walk_of_wrong;
}

/// A sample traces all views once: sample by sample, the shards' sum. If a budget took fewer of one shard, as few.
void add_samples(RowRecord& row, const std::vector<std::vector<RowRecord>>& shards)
{
    std::vector<const RowRecord*> parts;
    for (const auto& rows : shards)
        for (const RowRecord& part : rows)
            if (part.key == row.key) parts.push_back(&part);
    for (const RowRecord* part : parts) {
        row.launches.joined += part->launches.joined;
        row.launches.single += part->launches.single;
    }
    const auto is_same = [&](const RowRecord* part) { return part->run_samples == parts.front()->run_samples; };
    row.run_samples = std::ranges::all_of(parts, is_same) ? parts.front()->run_samples : std::vector<std::size_t>();
    for (std::vector<double> RowRecord::*samples :
         {&RowRecord::samples_s, &RowRecord::wall_samples_s, &RowRecord::latency_samples_s}) {
        std::vector<double> sum = parts.front()->*samples;
        for (std::size_t i = 1; i < parts.size(); ++i) {
            sum.resize(std::min(sum.size(), (parts[i]->*samples).size()));
            for (std::size_t sample = 0; sample < sum.size(); ++sample)
                sum[sample] += (parts[i]->*samples)[sample];
        }
        row.*samples = std::move(sum);
    }
}

/// What speaks against the rate of one shard speaks against that of all.
void add_disturbance(RowRecord& row, const RowRecord& part)
{
    if (part.pulse_ratio) row.pulse_ratio = std::max(row.pulse_ratio.value_or(0), *part.pulse_ratio);
    if (part.disturbance.empty() || row.disturbance.find(part.disturbance) != std::string::npos) return;
    append_item(row.disturbance, "; ", part.disturbance);
}

} // namespace

std::vector<RowRecord> rows_of_shards(const std::vector<ShardResult>& shards, bool searches)
{
    std::vector<RowRecord> rows;
    for (const ShardResult& shard : shards)
        for (RowRecord& row : rows_of(shard, searches)) {
            const auto same = [&](const RowRecord& one) { return one.key == row.key; };
            const auto known = std::ranges::find_if(rows, same);
            if (known == rows.end()) {
                rows.push_back(std::move(row));
                continue;
            }
            add_disturbance(*known, row);
            if (traced(*known) != nullptr && traced(row) == nullptr) *known = std::move(row);
        }
    for (RowRecord& row : rows)
        forget_answers(row);
    return rows;
}

std::vector<nlohmann::json> merged_entries(const std::vector<ShardResult>& shards)
{
    std::multimap<EntryPlace, json> parts;
    std::vector<json> others;
    std::set<std::string> known;
    std::vector<std::string> scenes;
    StrippedRows stripped(shards);
    for (const ShardResult& shard : shards)
        for (json entry : shard.journal.entries) {
            const bool is_view = entry.contains("view"), is_batch = entry.contains("batch");
            if (!is_view && !is_batch) {
                // Of a device's microbenchmark and a row's set-up, the first shard's.
                const std::string what = entry.contains("setup") ? "setup" : "yardstick";
                if (known.insert(what + entry.value(what, "")).second) others.push_back(std::move(entry));
                continue;
            }
            strip(entry, stripped);
            const std::size_t scene = is_view ? number_of(scenes, entry.at("scene")) : max_shards;
            const EntryPlace place{scene, entry.at(is_view ? "view" : "batch").get<std::uint64_t>()};
            parts.emplace(place, std::move(entry));
        }
    std::vector<json> entries;
    for (auto& [place, entry] : parts)
        entries.push_back(std::move(entry));
    std::ranges::move(others, std::back_inserter(entries));
    return entries;
}

std::vector<RowRecord> merged_rows(const std::vector<ShardResult>& shards, const std::vector<std::uint32_t>& views)
{
    std::vector<RowRecord> rows = rows_of_shards(shards);
    std::vector<std::vector<RowRecord>> timed;
    for (const ShardResult& shard : shards)
        timed.push_back(read_rows(shard.result));
    std::map<std::string, Views> found;
    for (RowRecord& row : rows) {
        if (traced(row) == nullptr) continue;
        const std::string& scene = row.key.scene;
        if (!found.contains(scene)) {
            found[scene] = views_of(shards, scene);
            require_views(found[scene], views, scene);
        }
        add_answers(row, found[scene]);
        for (const auto& part : timed)
            for (const RowRecord& one : part)
                if (one.key == row.key && traced(row) != nullptr && traced(one) != nullptr)
                    add_walks(std::get<Traced>(row.outcome), *traced(one));
        if (traced(row) != nullptr && is_of_one_kind(shards, row_name(row.key))) add_samples(row, timed);
    }
    return rows;
}

} // namespace tetrace
