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

constexpr const char *name_key = "part", *section_key = "tetrace", *ended_key = "ended", *besides_key = "besides",
                     *until_key = "until_s";

KeptPart part_from(const json& entry, const std::filesystem::path& journal)
{
    const ResultFile result = result_from({{section_key, entry.at(section_key)}}, journal);
    const ResultValue section = result.section();
    KeptPart part{read_rows(result), section.at("scenes").json().get<std::vector<json>>(), {}};
    if (section.find("samples_a_row")) part.measurement = read_measurement(section);
    const json& ended = entry.at(ended_key);
    for (RowRecord& row : part.rows)
        if (const std::string name = row_name(row.key); ended.contains(name)) row.outcome = ended_from(ended[name]);
    return part;
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

std::optional<KeptPart> KeptParts::find(const std::string& name, const std::function<void(const json&)>& read) const
{
    if (journal_ == nullptr) return std::nullopt;
    for (const json& entry : journal_->entries())
        try {
            if (entry.value(name_key, "") != name) continue;
            KeptPart part = part_from(entry, journal_file(*options_->out));
            if (read) read(entry.at(besides_key));
            something_to_keep();
            return part;
        } catch (const std::exception& error) {
            journal_->reject(fmt::format("{} in the journal is damaged: {}", name, error.what()));
        }
    return std::nullopt;
}

void KeptParts::keep(const std::string& name, const KeptPart& part, json besides)
{
    if (journal_ == nullptr) return;
    json section = result_head(*options_), ended = json::object();
    section["scenes"] = part.scenes;
    if (part.measurement) set_measurement(section, *part.measurement);
    section["rows"] = json::array();
    for (const RowRecord& row : part.rows) {
        section["rows"].push_back(row_json(RowFacts(row)));
        if (traced(row) == nullptr) ended[row_name(row.key)] = ended_json(row.outcome); // results lack kinds of errors
    }
    journal_->append({{name_key, name},
                      {section_key, std::move(section)},
                      {ended_key, std::move(ended)},
                      {besides_key, std::move(besides)},
                      {until_key, clock_()}});
}

} // namespace tetrace
