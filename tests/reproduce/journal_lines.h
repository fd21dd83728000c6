#pragma once

#include "core/base/hash.h"

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace tetrace::test {

/// The entries of a journal's lines, the head's first.
inline std::vector<nlohmann::json> entries_of(const std::string& journal)
{
    std::vector<nlohmann::json> entries;
    std::istringstream lines(journal);
    for (std::string line; std::getline(lines, line);)
        entries.push_back(nlohmann::json::parse(line).at("entry"));
    return entries;
}

/// A journal of these entries, with the right checksums, as one who damages it on purpose would write it.
inline std::string journal_of(const std::vector<nlohmann::json>& entries)
{
    std::string text;
    std::uint64_t checksum = 0;
    for (const nlohmann::json& entry : entries) {
        checksum = hash_of(entry.dump(), checksum);
        text += R"({"checksum":")" + hash_text(checksum) + R"(","entry":)" + entry.dump() + "}\n";
    }
    return text;
}

} // namespace tetrace::test
