#include "bench/variants/variant_run.h"

#include "bench/inspection/work_folder.h"
#include "bench/measuring/ray_walks.h"
#include "bench/measuring/verify.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/variants/reduction.h"
#include "bench/variants/variant_program.h"
#include "core/base/hash.h"
#include "core/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace tetrace {

namespace {

/// Of a row: failures that are reduced. Each takes tens of programs, and a defect that is met often has many causes.
constexpr std::size_t max_causes = 3;

using Indices = std::vector<std::size_t>;

/// What a set of changes led to.
struct Seen {
    VariantSight sight = VariantSight::right;
    std::uint64_t different = 0;
    std::optional<DifferingRay> first = {};
    std::string reason = {};
};

/// The variants of one row, and what is needed to run them.
class VariantRunner {
public:
    VariantRunner(RowRun& row, Verifier* verifier, const Options& options, const Budget& budget)
        : row_(&row), verifier_(verifier), options_(&options), budget_(&budget)
    {
        result_.row = record_of(row);
        const Traced* const answers = traced(row);
        if (answers == nullptr || !has_answers(row)) {
            result_.reason = fmt::format("{} with its text as it is{}", name_of(status_of(row)),
                                         reason_of(row).empty() ? "" : ": " + reason_of(row));
            result_.fails_as_it_is = status_of(row) == Status::wrong || status_of(row) == Status::error;
            return;
        }
        hashes_ = answers->view_hashes;
        try {
            program_.emplace(row.key.backend, row.key.kernel);
            result_.changes = program_->text().changes().size();
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) throw;
            result_.reason = error.what();
        }
    }

    [[nodiscard]] bool is_runnable() const { return result_.reason.empty(); }

    void run(std::uint32_t number)
    {
        const Indices changes = program_->text().choose(options_->seed.value_or(1), number);
        try {
            const Seen seen = look(changes);
            ++result_.ran;
            result_.made += changes.size();
            if (seen.sight != VariantSight::right) note_failure(number, changes, seen);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) return interrupt(); // what ran by then is the result
            if (error.kind() != ErrorKind::missing) throw;
            result_.reason = error.what();
        }
    }

    [[nodiscard]] VariantRow result() && { return std::move(result_); }

private:
    [[nodiscard]] Seen look(const Indices& changes)
    {
        row_->outcome = Traced{};
        try {
            row_->program_file = program_->write(program_->text().with(changes), folder_.path());
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::driver) throw;
            return {VariantSight::not_compiled, 0, {}, error.what()};
        }
        reopen_row(*row_, *options_);
        if (row_->session == nullptr) return {VariantSight::not_compiled, 0, {}, reason_of(*row_)};
        Seen seen;
        guarded(*row_, [&] {
            for (std::size_t view = 0; view < hashes_.size() && seen.sight == VariantSight::right; ++view)
                if (verifier_->trace(*row_, view) != hashes_[view]) seen = compare(view);
        });
        if (const auto* const failed = std::get_if<Failed>(&row_->outcome)) {
            seen.sight = failed->kind == ErrorKind::wrong_result ? VariantSight::wrong : VariantSight::not_run;
            seen.reason = failed->what;
        }
        return seen;
    }

    /// Other hits are right if they differ by what the device's self-test allows, and are the same a second time.
    [[nodiscard]] Seen compare(std::size_t view)
    {
        const std::uint64_t before = hash_of(verifier_->hits());
        const ImageVerdict image = verifier_->verify(*row_, view);
        if (image.different > 0) return {VariantSight::wrong, image.different, image.first_different, {}};
        if (image.hit_hash == before) return {};
        return {VariantSight::wrong, 0, {}, "its hits differ from one time to the next"};
    }

    [[nodiscard]] bool may_go_on() const { return !is_interrupted() && budget_->left_s() > 0; }

    void note_failure(std::uint32_t number, const Indices& changes, const Seen& seen)
    {
        VariantFailure failure;
        failure.number = number;
        failure.sight = seen.sight;
        failure.changes = changes.size();
        failure.different = seen.different;
        failure.first_different = seen.first;
        failure.reason = printable_text(seen.reason);
        Indices reduced;
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

    [[nodiscard]] Indices reduce(const Indices& changes, VariantFailure& failure)
    {
        return smallest_failing(changes, [&](const Indices& tried) {
            failure.is_unfinished = failure.is_unfinished || !may_go_on();
            if (failure.is_unfinished) return false;
            progress_line().show(fmt::format("reducing variant {}", failure.number), -1, -1, row_label(row_->key));
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

    /// A failure without a differing ray is that of the first one.
    [[nodiscard]] std::string command_of(const VariantFailure& failure) const
    {
        const DifferingRay ray = failure.first_different.value_or(DifferingRay{row_->scene->view_numbers().front()});
        const std::string trace = trace_command(*row_, ray.view, ray.x, ray.y);
        constexpr std::string_view verb = "tetrace trace";
        if (!trace.starts_with(verb)) return {};
        return fmt::format("tetrace dump{} --variant {} --out case", trace.substr(verb.size()),
                           fmt::join(failure.reduced, ","));
    }

    struct Cause {
        VariantSight sight = VariantSight::wrong;
        Indices changes;
    };

    RowRun* row_;
    Verifier* verifier_;
    const Options* options_;
    const Budget* budget_;
    WorkFolder folder_;
    std::optional<VariantProgram> program_;
    std::vector<std::uint64_t> hashes_;     ///< of the hits of each view
    std::map<std::uint32_t, Cause> causes_; ///< by the variants that were reduced
    VariantRow result_;
};

} // namespace

std::size_t VariantRow::count(VariantSight sight) const
{
    const auto failed = std::ranges::count(failures, sight, &VariantFailure::sight);
    return sight == VariantSight::right ? ran - failures.size() : static_cast<std::size_t>(failed);
}

std::vector<VariantRow> run_variants(std::vector<RowRun>& rows, const Options& options, const Budget& budget)
{
    std::map<const SceneWork*, std::unique_ptr<Verifier>> verifiers;
    std::vector<std::unique_ptr<VariantRunner>> runners;
    for (RowRun& row : rows) {
        std::unique_ptr<Verifier>& verifier = verifiers[row.scene];
        if (verifier == nullptr && row.scene != nullptr) verifier = std::make_unique<Verifier>(*row.scene, options);
        runners.push_back(std::make_unique<VariantRunner>(row, verifier.get(), options, budget));
    }
    const double all = static_cast<double>(options.variants) * static_cast<double>(runners.size());
    double done = 0;
    for (std::uint32_t number = 1; number <= options.variants; ++number)
        for (std::size_t i = 0; i < runners.size(); ++i, ++done)
            if (runners[i]->is_runnable() && !is_interrupted() && budget.left_s() > 0) {
                progress_line().show("checking variants", done / all, -1, row_label(rows[i].key));
                runners[i]->run(number);
            }
    progress_line().clear();
    std::vector<VariantRow> results;
    for (auto& runner : runners)
        results.push_back(std::move(*runner).result());
    return results;
}

} // namespace tetrace
