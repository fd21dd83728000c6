#include "bench/measuring/image_record.h"

#include "bench/measuring/budget.h"
#include "bench/rows/json_numbers.h"
#include "bench/rows/ray_json.h"
#include "core/base/hash.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace tetrace {

namespace {

using nlohmann::json;

std::uint64_t hash_from(const json& text)
{
    return std::stoull(text.get<std::string>(), nullptr, 16);
}

std::uint64_t number_from(const json& value)
{
    return count_from<std::uint64_t>(value);
}

json totals_json(const RayTotals& totals)
{
    json list = json::array();
    for (const auto count : counts_of_totals)
        list.push_back(totals.*count);
    return list;
}

RayTotals totals_from(const json& list)
{
    RayTotals totals;
    for (std::size_t i = 0; i < std::size(counts_of_totals); ++i)
        totals.*counts_of_totals[i] = number_from(list.at(i));
    return totals;
}

json verdicts_json(const Verdicts& v)
{
    json object = {{"counts", {v.rays, v.agreed, v.ties, v.settled, v.wrong, v.lost, v.offset}},
                   {"largest_tie_distance", v.max_tie_distance}};
    if (v.first_wrong) object["first_wrong"] = wrong_ray_json(*v.first_wrong);
    return object;
}

Verdicts verdicts_from(const json& object)
{
    const json& c = object.at("counts");
    Verdicts verdicts;
    verdicts.rays = number_from(c.at(0));
    verdicts.agreed = number_from(c.at(1));
    verdicts.ties = number_from(c.at(2));
    verdicts.settled = number_from(c.at(3));
    verdicts.wrong = number_from(c.at(4));
    verdicts.lost = number_from(c.at(5));
    verdicts.offset = number_from(c.at(6));
    verdicts.max_tie_distance = amount_from(object.at("largest_tie_distance"));
    if (object.contains("first_wrong")) verdicts.first_wrong = wrong_ray_from(object["first_wrong"]);
    return verdicts;
}

json verdict_json(const ImageVerdict& verdict)
{
    json object = {{"totals", totals_json(verdict.totals)},
                   {"verdicts", verdicts_json(verdict.verdicts)},
                   {"hit_hash", hash_text(verdict.hit_hash)},
                   {"seconds", {verdict.kernel_s, verdict.wall_s, verdict.download_s}}};
    if (verdict.entering) object["entering"] = *verdict.entering;
    if (verdict.visits.rays > 0)
        object["visits"] = {verdict.visits.rays, verdict.visits.nodes, verdict.visits.triangles};
    if (verdict.lost_at_device_cap > 0) object["lost_at_device_cap"] = verdict.lost_at_device_cap;
    if (verdict.compared) object["compared"] = {verdict.different, verdict.inexact, verdict.max_ulps};
    if (verdict.first_different) object["first_different"] = differing_ray_json(*verdict.first_different);
    return object;
}

ImageVerdict verdict_from(const json& object)
{
    ImageVerdict verdict;
    verdict.totals = totals_from(object.at("totals"));
    if (object.contains("entering")) verdict.entering = number_from(object["entering"]);
    verdict.verdicts = verdicts_from(object.at("verdicts"));
    verdict.hit_hash = hash_from(object.at("hit_hash"));
    if (object.contains("visits")) {
        const json& visits = object["visits"];
        verdict.visits = {number_from(visits.at(0)), number_from(visits.at(1)), number_from(visits.at(2))};
    }
    const json& seconds = object.at("seconds");
    verdict.kernel_s = amount_from(seconds.at(0));
    verdict.wall_s = amount_from(seconds.at(1));
    verdict.download_s = amount_from(seconds.at(2));
    if (object.contains("lost_at_device_cap")) verdict.lost_at_device_cap = number_from(object["lost_at_device_cap"]);
    verdict.compared = object.contains("compared");
    if (verdict.compared) {
        const json& compared = object["compared"];
        verdict.different = number_from(compared.at(0));
        verdict.inexact = number_from(compared.at(1));
        verdict.max_ulps = number_from(compared.at(2));
    }
    if (object.contains("first_different")) verdict.first_different = differing_ray_from(object["first_different"]);
    return verdict;
}

constexpr std::optional<double> GpuState::*told[] = {&GpuState::clock_mhz, &GpuState::memory_clock_mhz,
                                                     &GpuState::power_w, &GpuState::temperature_c};

/// A state is its numbers in the order of `told`, null if it has none, and why it was throttled.
json gpu_readings_json(const GpuReadings& readings)
{
    json states = json::array();
    for (const GpuState& state : readings.states) {
        json& numbers = states.emplace_back(json::array());
        for (const auto member : told)
            numbers.push_back(state.*member ? json(*(state.*member)) : json());
        numbers.push_back(state.throttled);
    }
    return {{"states", std::move(states)}, {"dropped", readings.dropped}, {"reasons", readings.reasons}};
}

GpuReadings gpu_readings_from(const json& object)
{
    GpuReadings readings{{}, count_from<std::uint32_t>(object.at("dropped")), object.at("reasons")};
    for (const json& numbers : object.at("states")) {
        GpuState& state = readings.states.emplace_back();
        std::size_t place = 0;
        for (const auto member : told)
            if (const json& number = numbers.at(place++); !number.is_null()) state.*member = number.get<double>();
        state.throttled = numbers.at(place);
    }
    return readings;
}

json record_json(const ImageRecord& record)
{
    json object = samples_json(record);
    object["verdict"] = verdict_json(record.verdict);
    object["chained_hash"] = hash_text(record.chained_hash);
    object["lost_at_cap"] = record.lost_at_cap;
    object["flat"] = {record.flawed.rays, record.flawed.through_flat, record.any.rays, record.any.through_flat};
    return object;
}

ImageRecord record_from(const json& object)
{
    const json& flat = object.at("flat");
    return {samples_from(object),
            verdict_from(object.at("verdict")),
            hash_from(object.at("chained_hash")),
            number_from(object.at("lost_at_cap")),
            {number_from(flat.at(0)), number_from(flat.at(1))},
            {number_from(flat.at(2)), number_from(flat.at(3))}};
}

/// A value of an enumeration, from the first allowed one to the last.
template <class Enum>
Enum choice_from(const json& number, Enum first, Enum last)
{
    const auto value = number.is_number_integer() ? number.get<std::int64_t>() : -1;
    if (value < static_cast<int>(first) || value > static_cast<int>(last))
        throw std::out_of_range("no such status or kind of error");
    return static_cast<Enum>(value);
}

/// Throws std::domain_error if a count of rays exceeds their number.
void require_possible(const ImageRecord& record)
{
    const ImageVerdict& verdict = record.verdict;
    const RayTotals& totals = verdict.totals;
    const Verdicts& judged = verdict.verdicts;
    for (const std::uint64_t count :
         {totals.hits, totals.misses, totals.lost, totals.unwritten, judged.rays, judged.agreed, judged.ties,
          judged.settled, judged.wrong, judged.lost, judged.offset, verdict.different, verdict.inexact,
          verdict.visits.rays, verdict.lost_at_device_cap, record.lost_at_cap, record.flawed.rays, record.any.rays})
        if (count > totals.rays) throw std::domain_error(fmt::format("{} of {} rays", count, totals.rays));
    for (const FlatWalks& walks : {record.flawed, record.any})
        if (walks.through_flat > walks.rays)
            throw std::domain_error(fmt::format("{} of {} rays", walks.through_flat, walks.rays));
}

} // namespace

nlohmann::json samples_json(const RowSamples& samples)
{
    json object = {
        {"samples_s", samples.samples_s}, {"wall_samples_s", samples.wall_samples_s}, {"sampled_s", samples.sampled_s}};
    if (!samples.latency_samples_s.empty()) object["latency_samples_s"] = samples.latency_samples_s;
    if (samples.passes > 1) object["passes"] = samples.passes;
    if (samples.gpu) object["gpu"] = gpu_readings_json(*samples.gpu);
    return object;
}

RowSamples samples_from(const nlohmann::json& object)
{
    RowSamples samples;
    object.at("samples_s").get_to(samples.samples_s);
    object.at("wall_samples_s").get_to(samples.wall_samples_s);
    object.at("sampled_s").get_to(samples.sampled_s);
    if (object.contains("latency_samples_s")) object["latency_samples_s"].get_to(samples.latency_samples_s);
    if (object.contains("passes")) samples.passes = count_from<std::uint32_t>(object["passes"]);
    if (samples.passes < 1 || samples.passes > max_passes)
        throw std::domain_error(fmt::format("{} passes of a sample", samples.passes));
    if (object.contains("gpu")) samples.gpu = gpu_readings_from(object["gpu"]);
    return samples;
}

void drop_samples(nlohmann::json& record)
{
    if (!record.contains("samples_s")) return;
    record["samples_s"] = record["wall_samples_s"] = json::array();
    for (const char* const of_samples : {"passes", "gpu"})
        record.erase(of_samples);
}

void require_samples(const RowSamples& samples, std::size_t count, bool with_intervals)
{
    const auto is_time = [](double seconds) { return std::isfinite(seconds) && seconds > 0; };
    for (const auto* times : {&samples.samples_s, &samples.wall_samples_s})
        if (times->size() != count || !std::ranges::all_of(*times, is_time))
            throw std::domain_error(fmt::format("{} samples are wanted, all above 0 s", count));
    if (!std::ranges::all_of(samples.latency_samples_s, is_time))
        throw std::domain_error("a pass of single launches must take more than 0 s");
    if (!with_intervals) return;
    const auto is_interval = [](const auto& interval) {
        return std::isfinite(interval.second) && 0 <= interval.first && interval.first <= interval.second;
    };
    if (samples.sampled_s.size() != count || !std::ranges::all_of(samples.sampled_s, is_interval))
        throw std::domain_error(fmt::format("the times of {} samples are wanted", count));
    if (samples.gpu && samples.gpu->states.size() != count)
        throw std::domain_error(fmt::format("a GPU's readings of {} samples are wanted", count));
}

nlohmann::json outcome_json(const ImageOutcome& outcome)
{
    if (const auto* skipped = std::get_if<Skipped>(&outcome))
        return {{"skipped", skipped->reason}, {"status", static_cast<int>(skipped->status)}};
    if (const auto* failed = std::get_if<Failed>(&outcome))
        return {{"failed", failed->what}, {"kind", static_cast<int>(failed->kind)}};
    return record_json(std::get<ImageRecord>(outcome));
}

nlohmann::json ended_json(const Outcome& outcome)
{
    if (const auto* skipped = std::get_if<Skipped>(&outcome)) return outcome_json(*skipped);
    return outcome_json(std::get<Failed>(outcome));
}

Outcome ended_from(const nlohmann::json& json)
{
    const ImageOutcome outcome = outcome_from_json(json);
    if (const auto* skipped = std::get_if<Skipped>(&outcome)) return *skipped;
    if (const auto* failed = std::get_if<Failed>(&outcome)) return *failed;
    throw std::domain_error("a row that has ended has an image");
}

ImageOutcome outcome_from_json(const nlohmann::json& json)
{
    if (json.contains("skipped"))
        return Skipped{choice_from(json.at("status"), Status::unsupported, Status::skipped), json["skipped"]};
    if (json.contains("failed"))
        return Failed{choice_from(json.at("kind"), ErrorKind::usage, ErrorKind::wrong_result), json["failed"]};
    ImageRecord record = record_from(json);
    require_possible(record);
    return record;
}

} // namespace tetrace
