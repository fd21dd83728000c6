#include "bench/variants/variant_run.h"

#include "bench/measuring/ray_walks.h"
#include "bench/measuring/verify.h"
#include "bench/terminal/interrupts.h"
#include "core/base/hash.h"
#include "core/base/printable.h"
#include "core/device/defects.h"
#include "core/isolation/isolation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace tetrace {

namespace {

/// The variants of one row, and what is needed to run them.
class VariantRunner : public VariantTrials {
public:
    VariantRunner(RowRun& row, Verifier* verifier, const Options& options, const Budget& budget)
        : VariantTrials(record_of(row), row_name(row.key), device_label(row.key), options, budget), row_(&row),
          verifier_(verifier)
    {
        const Traced* const answers = traced(row);
        if (answers == nullptr || !has_answers(row)) {
            result_.reason = fmt::format("{} with its text as it is{}", name_of(status_of(row)),
                                         reason_of(row).empty() ? "" : ": " + reason_of(row));
            result_.fails_as_it_is = status_of(row) == Status::wrong || status_of(row) == Status::error;
            return;
        }
        hashes_ = answers->view_hashes;
        find_program(row.key.backend);
        if (is_runnable()) try_as_it_is();
    }

private:
    /// The unchanged text, compiled as variants are, by another compiler than the row's or into another form: if that
    /// fails, no change is to blame.
    void try_as_it_is()
    try {
        const Seen seen = look({});
        if (seen.sight == VariantSight::right) return;
        result_.reason = fmt::format("{} with its text as it is, compiled as variants are{}{}", name_of(seen.sight),
                                     seen.reason.empty() ? "" : ": ", printable_text(seen.reason));
        result_.fails_as_it_is = true;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) return interrupt();
        if (error.kind() != ErrorKind::missing) throw;
        result_.reason = error.what();
    }

    [[nodiscard]] Seen look(const std::vector<std::size_t>& changes) override
    {
        row_->outcome = Traced{};
        try {
            row_->program_file = program_->write(program_->text().with(changes), folder_.path());
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::driver) throw;
            return {VariantSight::not_compiled, 0, {}, error.what(), false};
        }
        reopen_row(*row_, *options_);
        if (row_->session == nullptr) return {VariantSight::not_compiled, 0, {}, reason_of(*row_), false};
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
        if (image.different > 0) return {VariantSight::wrong, image.different, image.first_different, {}, false};
        if (image.hit_hash == before) return {};
        return {VariantSight::wrong, 0, {}, "its hits differ from one time to the next", false};
    }

    /// A failure without a differing ray is that of the first one.
    [[nodiscard]] std::string command_of(const VariantFailure& failure) const override
    {
        if (!has_case_host(backend_named(row_->key.backend, direct_backends())))
            return VariantTrials::command_of(failure); // no case of a ray
        const DifferingRay ray = failure.first_different.value_or(DifferingRay{row_->scene->view_numbers().front()});
        const std::string dump = dump_command(*row_, ray.view, ray.x, ray.y);
        if (dump.empty()) return {};
        return fmt::format("{} --variant {} --out case", dump, fmt::join(failure.reduced, ","));
    }

    RowRun* row_;
    Verifier* verifier_;
    std::vector<std::uint64_t> hashes_; ///< of the hits of each view
};

} // namespace

std::vector<VariantRow> run_variants(std::vector<RowRun>& rows, const Options& options, const Budget& budget)
{
    std::map<const SceneWork*, std::unique_ptr<Verifier>> verifiers;
    std::vector<std::unique_ptr<VariantTrials>> trials;
    for (RowRun& row : rows) {
        std::unique_ptr<Verifier>& verifier = verifiers[row.scene];
        if (verifier == nullptr && row.scene != nullptr) verifier = std::make_unique<Verifier>(*row.scene, options);
        trials.push_back(std::make_unique<VariantRunner>(row, verifier.get(), options, budget));
    }
    return run_trials(trials, options, budget);
}

} // namespace tetrace
