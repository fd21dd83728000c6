#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>

namespace tetrace {

/// Reads a JSON file that anyone may have written. what: what it is read as, "result". dropped: keys of its outermost
/// object that are left out. Throws Error{missing} for a missing file; Error{invalid_input} naming the file for one
/// that cannot be read, exceeds 64 MiB, 6,000,000 values or 64 levels, or is not JSON, with the place.
[[nodiscard]] nlohmann::json read_json(const std::filesystem::path& path, std::string_view what,
                                       std::initializer_list<std::string_view> dropped = {});

} // namespace tetrace
