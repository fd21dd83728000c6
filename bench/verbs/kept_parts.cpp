#include "bench/verbs/kept_parts.h"

#include "bench/measuring/image_record.h"
#include "bench/measuring/run_journal.h"
#include "bench/output/bench_report.h"
#include "bench/show/recorded_rows.h"
#include "bench/terminal/interrupts.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char *name_key = "part", *section_key = "tetrace", *ended_key = "ended", *usable_key = "usable",
                     *extra_key = "extra", *until_key = "until_s";

/// What results lack: kinds of errors, devices of rows without a scene, whether a device can be used.
void fill_in(RowRecord& row, const std::string& name, const std::vector<RowKey>& keys, const json& entry)
{
    const auto key = std::ranges::find(keys, name, row_name);
    if (key == keys.end()) throw std::domain_error(fmt::format("this run does not have the row '{}'", name));
    row.key = *key;
    if (entry.at(ended_key).contains(name)) row.outcome = ended_from(entry[ended_key][name]);
    row.device.usable = entry.at(usable_key).at(name);
    const Traced* const trace = traced(row);
    if (trace == nullptr) return;
    const RayTotals& totals = trace->totals;
    for (const std::uint64_t count : {totals.hits, totals.misses, totals.lost})
        if (count > totals.rays) throw std::domain_error(fmt::format("{} of {} rays of {}", count, totals.rays, name));
}

KeptPart part_from(const json& entry, const std::vector<RowKey>& keys, const std::filesystem::path& journal)
{
    const ResultFile result = result_from({{section_key, entry.at(section_key)}}, journal);
    const ResultValue section = result.section();
    KeptPart part{read_rows(result), section.at("scenes").json().get<std::vector<json>>(), {}};
    if (part.rows.size() != keys.size())
        throw std::domain_error(fmt::format("it has {} rows, not {}", part.rows.size(), keys.size()));
    for (std::size_t i = 0; i < part.rows.size(); ++i)
        fill_in(part.rows[i], result.rows.at(i).name, keys, entry);
    return part;
}

bool has_scene(const std::vector<json>& scenes, const std::string& name)
{
    return std::ranges::any_of(scenes, [&](const json& scene) { return scene.at("name") == name; });
}

} // namespace

KeptParts::KeptParts(Journal* journal, const Options& options) : journal_(journal), options_(&options)
{
    double until_s = 0;
    if (journal != nullptr)
        for (const json& entry : journal->entries()) {
            const auto until = entry.find(until_key);
            if (until == entry.end() || !until->is_number())
                journal->reject("the journal has an entry that does not belong to this run");
            until_s = std::max(until_s, until->get<double>());
        }
    clock_ = [now = host_clock(), until_s] { return until_s + now(); };
}

std::optional<KeptPart> KeptParts::find(const std::string& name, const std::vector<RowKey>& rows,
                                        const std::function<void(const json&)>& read) const
{
    if (journal_ == nullptr) return std::nullopt;
    for (const json& entry : journal_->entries())
        try {
            if (entry.value(name_key, "") != name) continue;
            KeptPart part = part_from(entry, rows, journal_file(*options_->out));
            if (read) {
                part.measurement = read_measurement(ResultValue(entry[section_key], name));
                read(entry.at(extra_key));
            }
            something_to_keep();
            return part;
        } catch (const std::exception& error) {
            journal_->reject(fmt::format("{} in the journal is damaged: {}", name, error.what()));
        }
    return std::nullopt;
}

void KeptParts::keep(const std::string& name, const KeptPart& part, json extra)
{
    if (journal_ == nullptr) return;
    json section = result_head(*options_), ended = json::object(), usable = json::object();
    section["scenes"] = part.scenes;
    if (part.measurement) set_measurement(section, *part.measurement);
    section["rows"] = json::array();
    for (const RowRecord& row : part.rows) {
        if (!has_scene(part.scenes, row.key.scene)) return;
        section["rows"].push_back(row_json(RowFacts(row)));
        if (traced(row) == nullptr) ended[row_name(row.key)] = ended_json(row.outcome);
        usable[row_name(row.key)] = row.device.usable;
    }
    journal_->append({{name_key, name},
                      {section_key, std::move(section)},
                      {ended_key, std::move(ended)},
                      {usable_key, std::move(usable)},
                      {extra_key, std::move(extra)},
                      {until_key, clock_()}});
}

void KeptParts::require_same(const std::vector<json>& scenes, const std::vector<json>& others) const
{
    for (const json& scene : scenes)
        for (const json& other : others)
            if (scene.at("name") == other.at("name") && scene.at("hash") != other.at("hash"))
                journal_->reject(fmt::format("the journal has rows of another {}: its mesh or its tets have changed",
                                             scene["name"].get<std::string>()));
}

} // namespace tetrace
