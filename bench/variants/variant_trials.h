#pragma once

#include "bench/inspection/work_folder.h"
#include "bench/measuring/budget.h"
#include "bench/options/options.h"
#include "bench/rows/row_run.h"
#include "bench/variants/variant_program.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What became of a variant.
enum class VariantSight {
    right,
    wrong,        ///< other hits than those of the unchanged kernel
    not_compiled, ///< a compiler refused it, crashed or gave no answer
    not_run,      ///< the driver failed while it ran
    fused         ///< of `inspect`: a fused operation decides a sign, and none does in the unchanged kernel
};
template <>
inline constexpr auto enum_names<VariantSight> = names_up_to<VariantSight::fused>("right", "wrong", "not compiled",
                                                                                  "not run", "fused");

/// A variant that fails.
struct VariantFailure {
    std::uint32_t number = 0; ///< of the variant, from 1
    VariantSight sight = VariantSight::wrong;
    std::size_t changes = 0;                          ///< how many it has
    std::vector<std::string> reduced;                 ///< the fewest that were seen to fail alike; empty: not reduced
    bool is_unfinished = false;                       ///< the reduction ended early: fewer changes may do
    std::optional<std::uint32_t> same_as;             ///< an earlier variant, whose reduced changes it has too
    std::uint32_t tries = 0;                          ///< of the reduction
    std::uint64_t different = 0;                      ///< rays, of the view of first_different, with all its changes
    std::optional<DifferingRay> first_different = {}; ///< with the reduced changes
    std::string reason;                               ///< what the driver said; empty if only hits differ
    std::string command;                              ///< that writes the reduced kernel; empty if no command line can
};

/// The variants of a row; of `inspect`, those of a kernel for a target.
struct VariantRow {
    RowRecord row;           ///< with the text as it is; of `inspect`, only the backend, the kernel and the device
    std::string name, label; ///< of the row, and of its device
    std::size_t changes = 0; ///< that its text can have
    std::size_t made = 0;    ///< changes of all variants that ran
    std::uint32_t ran = 0;
    std::optional<std::uint32_t> spilling; ///< of `inspect`: those that spill, if the unchanged kernel does not
    std::vector<VariantFailure> failures;
    std::string reason;          ///< why none ran; empty if they should
    bool fails_as_it_is = false; ///< the text as it is is wrong, or its driver fails; then none runs
};

/// Tries the variants of a kernel's text, and reduces those that fail.
class VariantTrials {
public:
    virtual ~VariantTrials() = default;
    VariantTrials(const VariantTrials&) = delete;
    VariantTrials& operator=(const VariantTrials&) = delete;

    [[nodiscard]] bool is_runnable() const { return result_.reason.empty(); }
    [[nodiscard]] const std::string& name() const { return result_.name; }
    /// Tries the variant of that number, from 1. Precondition: is_runnable().
    void run(std::uint32_t number);
    [[nodiscard]] VariantRow result() && { return std::move(result_); }

protected:
    /// What a set of changes led to.
    struct Seen {
        VariantSight sight = VariantSight::right;
        std::uint64_t different = 0;
        std::optional<DifferingRay> first = {};
        std::string reason = {};
        bool spills = false;
    };

    VariantTrials(RowRecord row, std::string name, std::string label, const Options& options, const Budget& budget);
    /// backend: whose text is changed. If it has none, the result's reason says so.
    void find_program(const std::string& backend);
    /// Throws Error{missing} if nothing here compiles the text, and Error{interrupted}.
    [[nodiscard]] virtual Seen look(const std::vector<std::size_t>& changes) = 0;
    /// That writes the reduced kernel; empty if no command line can.
    [[nodiscard]] virtual std::string command_of(const VariantFailure& failure) const;

    const Options* options_;
    WorkFolder folder_;
    std::optional<VariantProgram> program_;
    VariantRow result_;

private:
    [[nodiscard]] bool may_go_on() const;
    void note_failure(std::uint32_t number, const std::vector<std::size_t>& changes, const Seen& seen);
    [[nodiscard]] std::vector<std::size_t> reduce(const std::vector<std::size_t>& changes, VariantFailure& failure);

    struct Cause {
        VariantSight sight = VariantSight::wrong;
        std::vector<std::size_t> changes;
    };
    const Budget* budget_;
    std::map<std::uint32_t, Cause> causes_; ///< by the variants that were reduced
};

/// Tries Options::variants variants of each, one after the other in turn for all. Ends early when the budget is spent
/// or the user interrupts.
[[nodiscard]] std::vector<VariantRow> run_trials(const std::vector<std::unique_ptr<VariantTrials>>& trials,
                                                 const Options& options, const Budget& budget);

} // namespace tetrace
