#include "bench/variants/variant_trials.h"

#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/variants/reduction.h"
#include "core/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tetrace {

namespace {

/// Of a row: failures that are reduced. Each takes tens of programs, and a defect that is met often has many causes.
constexpr std::size_t max_causes = 3;

} // namespace

VariantTrials::VariantTrials(RowRecord row, std::string name, std::string label, const Options& options,
                             const Budget& budget)
    : options_(&options), budget_(&budget)
{
    result_.row = std::move(row);
    result_.name = std::move(name);
    result_.label = std::move(label);
}

void VariantTrials::find_program(const std::string& backend)
try {
    program_.emplace(backend, result_.row.key.kernel);
    result_.changes = program_->text().changes().size();
} catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw;
    result_.reason = error.what();
}

void VariantTrials::run(std::uint32_t number)
{
    const auto changes = program_->text().choose(options_->seed.value_or(1), number);
    try {
        const Seen seen = look(changes);
        ++result_.ran;
        result_.made += changes.size();
        if (result_.spilling && seen.spills) ++*result_.spilling;
        if (seen.sight != VariantSight::right) note_failure(number, changes, seen);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) return interrupt(); // what ran by then is the result
        if (error.kind() != ErrorKind::missing) throw;
        result_.reason = error.what();
    }
}

bool VariantTrials::may_go_on() const
{
    return !is_interrupted() && budget_->left_s() > 0;
}

void VariantTrials::note_failure(std::uint32_t number, const std::vector<std::size_t>& changes, const Seen& seen)
{
    VariantFailure failure;
    failure.number = number;
    failure.sight = seen.sight;
    failure.changes = changes.size();
    failure.different = seen.different;
    failure.first_different = seen.first;
    failure.reason = printable_text(seen.reason);
    std::vector<std::size_t> reduced;
    for (const auto& [earlier, known] : causes_)
        if (!failure.same_as && known.sight == seen.sight && std::ranges::includes(changes, known.changes)) {
            failure.same_as = earlier;
            reduced = known.changes;
        }
    if (!failure.same_as && causes_.size() < max_causes) {
        reduced = reduce(changes, failure);
        if (!failure.is_unfinished) causes_[number] = {seen.sight, reduced};
    }
    for (const std::size_t change : reduced)
        failure.reduced.push_back(program_->text().changes()[change].name);
    if (!reduced.empty()) failure.command = command_of(failure);
    result_.failures.push_back(std::move(failure));
}

std::vector<std::size_t> VariantTrials::reduce(const std::vector<std::size_t>& changes, VariantFailure& failure)
{
    return smallest_failing(changes, [&](const std::vector<std::size_t>& tried) {
        failure.is_unfinished = failure.is_unfinished || !may_go_on();
        if (failure.is_unfinished) return false;
        progress_line().show(fmt::format("reducing variant {}", failure.number), -1, -1, name());
        try {
            const Seen seen = look(tried);
            ++failure.tries;
            if (seen.sight != failure.sight) return false;
            failure.first_different = seen.first;
            failure.reason = printable_text(seen.reason);
            return true;
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::interrupted && error.kind() != ErrorKind::missing) throw;
            if (error.kind() == ErrorKind::interrupted) interrupt();
            failure.is_unfinished = true;
            return false;
        }
    });
}

std::string VariantTrials::command_of(const VariantFailure& failure) const
{
    const RowKey& key = result_.row.key;
    const Task task = key.kernel.task;
    return fmt::format("tetrace dump --backend {} --method {} --layout {}{}{} --variant {} --out case", key.backend,
                       name_of(key.kernel.method), name_of(key.kernel.layout),
                       key.kernel.math == MathMode::exact ? "" : " --math fast",
                       task == Task::trace ? "" : fmt::format(" --entry {}", name_of(task)),
                       fmt::join(failure.reduced, ","));
}

std::vector<VariantRow> run_trials(const std::vector<std::unique_ptr<VariantTrials>>& trials, const Options& options,
                                   const Budget& budget)
{
    const double all = static_cast<double>(options.variants) * static_cast<double>(trials.size());
    double done = 0;
    for (std::uint32_t number = 1; number <= options.variants; ++number)
        for (const auto& trial : trials) {
            progress_line().show("trying variants", done++ / all, -1, trial->name());
            if (trial->is_runnable() && !is_interrupted() && budget.left_s() > 0) trial->run(number);
        }
    progress_line().clear();
    std::vector<VariantRow> rows;
    for (const auto& trial : trials)
        rows.push_back(std::move(*trial).result());
    return rows;
}

} // namespace tetrace
