#include "bench/show/recorded_rows.h"

#include "bench/options/browser_api.h"
#include "bench/output/device_json.h"
#include "bench/output/row_fields.h"
#include "bench/output/trust.h"
#include "bench/results/row_keys.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

/// How the row ended, without its answers. Older results called rows wrong for lost rays.
Outcome outcome_from(const ResultValue& value, const ResultRow& row)
{
    if (row.status == Status::skipped) return Skipped{Status::skipped, row.reason};
    if (row.status == Status::unsupported) return Skipped{Status::unsupported, row.reason};
    if (row.status == Status::error) return Failed{ErrorKind::internal, row.reason};
    const auto different = value.find(row_key::different_from_openmp);
    const bool is_different = different && different->count() > 0;
    if (!value.find(row_key::counts) || (row.status == Status::wrong && !is_different))
        return Failed{ErrorKind::wrong_result, row.reason};
    return Traced{};
}

/// with_answers: a row of searches has its answers in a form of its own, and its batches have all of them.
void read_fields(RowRecord& record, const ResultValue& value, bool with_answers = true)
{
    for (const RowField& field : row_fields()) {
        if (field.schema == nullptr) continue;
        const bool is_grouped = *field.group != '\0';
        if (!with_answers && field.group == std::string_view(row_key::verification.key)) continue;
        const auto object = is_grouped ? value.find(field.group) : std::optional(value);
        if (!object) continue;
        if (const auto found = object->find(field.key))
            field.value.set(record, *found);
        else if (is_grouped && field.required)
            static_cast<void>(object->at(field.key)); // throws
    }
}

/// From a mean that was recorded with all its digits.
std::uint64_t steps_of(const std::optional<ResultValue>& mean, std::uint64_t rays)
{
    const double steps = mean ? mean->number() * static_cast<double>(rays) : 0;
    return steps > 0 && steps < 1e18 ? static_cast<std::uint64_t>(std::llround(steps)) : 0;
}

/// What results from before these keys have in others.
void read_older(RowRecord& record, const ResultValue& value)
{
    Traced* const result = std::get_if<Traced>(&record.outcome);
    if (result == nullptr) return;
    RayTotals& totals = result->totals;
    const auto steps = value.find(row_key::steps);
    if (steps && !value.find(row_key::hit_steps)) {
        totals.hit_steps = steps_of(value.find(row_key::mean_steps_hit), totals.hits);
        totals.miss_steps = steps_of(value.find(row_key::mean_steps_miss), totals.misses);
        const std::uint64_t known = totals.hit_steps + totals.miss_steps;
        totals.lost_steps = std::max(steps->count(), known) - known;
    }
    const auto conformity = value.find(row_key::conformity);
    if (conformity && conformity->text().starts_with("within"))
        result->inexact = std::max<std::uint64_t>(result->inexact, 1);
}

/// The kernel of this program that the record's key names.
KernelId known_kernel(const KernelId& named, const ResultValue& row)
{
    const auto found = kernel_named(name_of(named.method), name_of(named.layout), name_of(named.math),
                                    name_of(named.schedule), named.task);
    if (!found)
        row.at(row_key::method)
            .reject("and its layout, math and schedule are not a kernel of this tetrace: use the one that "
                    "wrote the file");
    return *found;
}

void require_backend(const ResultValue& row)
{
    const ResultValue backend = row.at(row_key::backend);
    if (!is_known_api(backend.line())) backend.reject("is not a backend of this tetrace");
}

RowRecord record_from(const ResultValue& value, const ResultRow& row)
{
    RowRecord record;
    record.outcome = outcome_from(value, row);
    record.key.rays = RayKind::primary;
    read_fields(record, value);
    read_older(record, value);
    RowKey& key = record.key;
    key.scene = row.scene;
    if (key.kernel.task == Task::trace && key.rays != RayKind::primary) key.kernel.task = Task::rays;
    const nlohmann::json schedule = row.schedule; // older results have it in the row's name
    read_into(key.kernel.schedule, ResultValue(schedule, row.name));
    key.kernel = known_kernel(key.kernel, value);
    if (!record.device.name.empty()) require_backend(value);
    record.device.usable = row.status != Status::skipped;
    return record;
}

/// Only the row on one thread has that in its key: "/threads:1".
RowRecord search_record_from(const ResultValue& value, const ResultRow& row)
{
    RowRecord record;
    if (row.status == Status::skipped || row.status == Status::unsupported || row.status == Status::error ||
        !value.find(row_key::verification))
        record.outcome = outcome_from(value, row);
    read_fields(record, value, false);
    RowKey& key = record.key;
    key.scene = search_scene;
    key.kernel.task = Task::search;
    key.kernel = known_kernel(key.kernel, value);
    if (row.name.ends_with("/threads:1")) key.threads = 1;
    require_backend(value);
    return record;
}

} // namespace

std::vector<RowRecord> read_rows(const ResultFile& file)
{
    std::vector<RowRecord> rows;
    const auto values = file.section().at("rows").items();
    for (std::size_t i = 0; i < values.size(); ++i)
        rows.push_back(record_from(values[i], file.rows.at(i)));
    return rows;
}

std::vector<RowRecord> read_search_rows(const ResultFile& file)
{
    std::vector<RowRecord> rows;
    if (file.searches.empty()) return rows;
    const auto values = file.section().at("searches").at("rows").items();
    for (std::size_t i = 0; i < values.size(); ++i)
        rows.push_back(search_record_from(values[i], file.searches.at(i)));
    return rows;
}

std::vector<RowDevice> read_devices(const ResultFile& file, const std::vector<RowRecord>& rows)
{
    const ResultValue section = file.section();
    const auto list = section.find("devices");
    if (!list) return devices_of(rows);
    std::vector<RowDevice> devices;
    for (const ResultValue& device : list->items())
        devices.push_back(row_device_from(device));
    return devices;
}

unsigned small_count(const ResultValue& value)
{
    constexpr unsigned most = 1'000'000;
    return static_cast<unsigned>(std::min<std::uint64_t>(value.count(), most));
}

Measurement read_measurement(const ResultValue& section)
{
    Measurement measurement;
    if (const auto runs = section.find("runs")) measurement.runs = std::max(1u, small_count(*runs));
    measurement.samples = small_count(section.at("samples_a_row")) / measurement.runs;
    measurement.lowered = section.at("samples_lowered").flag();
    if (const auto timed = section.find("timed_s")) measurement.wall_s = timed->number();
    const Steadiness steadiness = read_steadiness(section);
    measurement.load = steadiness.load;
    measurement.pulses = steadiness.pulses;
    return measurement;
}

} // namespace tetrace
