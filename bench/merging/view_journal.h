#pragma once

#include "bench/measuring/verify.h"
#include "bench/options/options.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace tetrace {

/// What merging needs of each image of a shard of `bench` and `check`, whose rows have only sums over views: written
/// as a journal next to the result, with the entries that `reproduce` writes. Does nothing for a whole run.
class ViewJournal {
public:
    /// options: whose result has a file, if they are of a shard.
    explicit ViewJournal(const Options& options) : options_(&options) {}

    void see(const SeenImage& image);
    /// Writes the journal. Throws what Journal throws.
    void write() const;

private:
    const Options* options_;
    std::map<std::pair<std::string, std::uint32_t>, nlohmann::json> entries_; ///< by scene and view
};

} // namespace tetrace
