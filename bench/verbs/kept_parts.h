#pragma once

#include "bench/measuring/journal.h"
#include "bench/measuring/measure.h"
#include "bench/options/options.h"
#include "bench/rows/row_record.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A part of a run that is a result in itself: a repetition of `check`, a scene of `reproduce ladder` or `volume`.
struct KeptPart {
    std::vector<RowRecord> rows;
    std::vector<nlohmann::json> scenes;     ///< as results record them
    std::optional<Measurement> measurement; ///< of a part that is timed
};

/// Parts that were finished, kept in a run's journal until all of them are.
class KeptParts {
public:
    /// journal: may be null; then nothing is kept. Both must outlive this object. Throws Error{usage} where the journal
    /// is damaged.
    KeptParts(Journal* journal, const Options& options);

    /// The part, if an earlier process of the run finished it. rows: those that it must have. read: of a part that is
    /// timed; gets the extra data that its verb kept, and may throw JSON's exceptions and std::logic_error. Throws as
    /// the constructor does.
    [[nodiscard]] std::optional<KeptPart> find(const std::string& name, const std::vector<RowKey>& rows,
                                               const std::function<void(const nlohmann::json&)>& read = {}) const;
    /// A part of which a scene could not be loaded is not kept: it is tried again.
    void keep(const std::string& name, const KeptPart& part, nlohmann::json extra = {});
    /// Throws Error{usage} if one of these scenes has the name of one of the others, and another hash.
    void require_same(const std::vector<nlohmann::json>& scenes, const std::vector<nlohmann::json>& others) const;

    /// For what is measured: it goes on after the last part of earlier processes.
    [[nodiscard]] const Clock& clock() const { return clock_; }

private:
    Journal* journal_;
    const Options* options_;
    Clock clock_;
};

} // namespace tetrace
