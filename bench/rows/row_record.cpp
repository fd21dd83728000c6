#include "bench/rows/row_record.h"

#include "bench/terminal/text.h"
#include "core/base/hash.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace tetrace {

namespace {

std::string traced_reason(const RowRecord& row, const Traced& traced)
{
    std::string text;
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) append_item(text, ", ", fmt::format("{} {}", count, what));
    };
    add(traced.different, "different from openmp's");
    add(traced.verdicts.lost, "lost");
    if (traced.lost_at_device_cap > 0)
        text += fmt::format(" ({} after {} steps, where loops of {} may end early)", traced.lost_at_device_cap,
                            row.device.max_steps, row.device.implementation);
    add(traced.verdicts.wrong, "wrong");
    if (row.key.kernel.math == MathMode::fast && is_portable(row.key.kernel) && !traced.verdicts.clean())
        text += "; math mode fast is held to no proof";
    return text;
}

} // namespace

void Visits::add(const Visits& other)
{
    rays += other.rays;
    nodes += other.nodes;
    triangles += other.triangles;
}

void Traced::add(const ImageVerdict& image)
{
    totals.add(image.totals);
    if (image.entering) entering = entering.value_or(0) + *image.entering;
    visits.add(image.visits);
    verdicts.add(image.verdicts);
    compared = compared || image.compared;
    different += image.different;
    inexact += image.inexact;
    max_ulps = std::max(max_ulps, image.max_ulps);
    lost_at_device_cap += image.lost_at_device_cap;
    if (!first_different) first_different = image.first_different;
    kernel_s += image.kernel_s;
    wall_s += image.wall_s;
    download_s += image.download_s;
    views_hash = hash_of(std::array{image.hit_hash}, views_hash);
}

std::string device_kind_text(const RowRecord& row)
{
    return row.device.name.empty() ? std::string() : std::string(name_of(row.device.kind));
}

std::vector<const RowRecord*> rows_of(const std::string& scene, const std::vector<RowRecord>& rows)
{
    std::vector<const RowRecord*> found;
    for (const RowRecord& row : rows)
        if (row.key.scene == scene) found.push_back(&row);
    return found;
}

std::vector<std::vector<double>> samples_of_runs(const RowRecord& row)
{
    std::vector<std::vector<double>> runs;
    auto next = row.samples_s.begin();
    for (const std::size_t samples : row.run_samples) {
        const auto end = next + static_cast<std::ptrdiff_t>(samples);
        runs.emplace_back(next, end);
        next = end;
    }
    if (runs.empty()) runs.push_back(row.samples_s);
    return runs;
}

bool has_latency(const RowRecord& row)
{
    return row.launches.joined == row.launches.single && row.key.in_flight == 1;
}

const Traced* traced(const RowRecord& row)
{
    return std::get_if<Traced>(&row.outcome);
}

Status status_of(const RowRecord& row)
{
    if (const auto* skipped = std::get_if<Skipped>(&row.outcome)) return skipped->status;
    if (const auto* failed = std::get_if<Failed>(&row.outcome))
        return failed->kind == ErrorKind::wrong_result ? Status::wrong : Status::error;
    const Traced* result = traced(row);
    if (result->different > 0) return Status::wrong;
    return result->verdicts.wrong + result->verdicts.lost > 0 ? Status::flawed : Status::ok;
}

bool has_answers(const RowRecord& row)
{
    return has_answers(status_of(row));
}

std::optional<SetupCost> setup_cost(const RowRecord& row)
{
    const RowSetup& setup = row.setup;
    if (!setup.build_s || !setup.bytes) return std::nullopt;
    return SetupCost{*setup.build_s, setup.pack_s.value_or(0), *setup.bytes};
}

void set_setup_cost(RowRecord& row, const SetupCost& cost)
{
    row.setup.build_s = cost.build_s;
    if (cost.pack_s > 0 || row.setup.pack_s) row.setup.pack_s = cost.pack_s;
    row.setup.bytes = cost.bytes;
}

std::string reason_of(const RowRecord& row)
{
    if (const auto* skipped = std::get_if<Skipped>(&row.outcome)) return skipped->reason;
    if (const auto* failed = std::get_if<Failed>(&row.outcome)) return failed->what;
    return traced_reason(row, std::get<Traced>(row.outcome));
}

bool fails(const RowRecord& row, bool flawed_passes)
{
    const Status status = status_of(row);
    if (status != Status::flawed) return status == Status::wrong;
    return claims_robustness(row.key.kernel) && (traced(row)->verdicts.lost > 0 || !flawed_passes);
}

int exit_code(const std::vector<RowRecord>& rows, bool flawed_passes)
{
    return exit_code(rows, [&](const RowRecord& row) { return fails(row, flawed_passes); });
}

int exit_code(const std::vector<RowRecord>& rows, const std::function<bool(const RowRecord&)>& row_fails)
{
    if (std::ranges::any_of(rows, row_fails)) return 1;
    for (const RowRecord& row : rows)
        if (const auto* failed = std::get_if<Failed>(&row.outcome)) return exit_code(failed->kind);
    return 0;
}

} // namespace tetrace
