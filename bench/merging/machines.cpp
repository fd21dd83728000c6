#include "bench/merging/machines.h"

#include "bench/statistics/statistics.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

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
std::vector<const json*> rows_of(const ShardResult& shard)
{
    std::vector<const json*> rows;
    const json& section = shard.section();
    const auto add = [&](const json& list) {
        for (const json& row : list)
            rows.push_back(&row);
    };
    add(section.at("rows"));
    if (section.contains("searches")) add(section["searches"].at("rows"));
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

std::uint64_t rays_of(const json& row)
{
    if (row.contains("counts")) return row["counts"].value("rays", std::uint64_t{0});
    return row.contains("verification") ? row["verification"].value("searches", std::uint64_t{0}) : 0;
}

void add_work(std::vector<std::pair<std::string, Work>>& all, const json& row)
{
    if (!row.contains("times") || !row["times"].contains("samples_s")) return;
    const std::string name = row.at("name");
    auto place = std::ranges::find(all, name, &std::pair<std::string, Work>::first);
    if (place == all.end()) place = all.insert(all.end(), {name, {}});
    place->second.rays += static_cast<double>(rays_of(row));
    place->second.seconds += statistics_of(row["times"]["samples_s"].get<std::vector<double>>()).median;
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
        for (const json* row : rows_of(shard))
            if (row->at("name") == name) {
                json kind = host_kind(shard.section());
                if (row->contains("device")) kind["device"] = device_kind((*row)["device"]);
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
            for (const json* row : rows_of(*shard))
                add_work(work, *row);
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
    for (const char* key : {"host", "label"}) {
        section.erase(key);
        if (first.contains(key)) section[key] = first[key];
    }
    section["merged"] = {{"shards", shards.size()}, {"machines", machines_json(shards)}};
}

} // namespace tetrace
