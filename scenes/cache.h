#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// $XDG_CACHE_HOME/tetrace, else ~/.cache/tetrace; made when first written to.
[[nodiscard]] std::filesystem::path cache_directory();

struct CachedFile {
    std::filesystem::path path;
    std::uint64_t bytes = 0;
};
[[nodiscard]] std::vector<CachedFile> list_cache();

/// Removes what tetrace put there, and nothing else; returns how much.
std::uint64_t clear_cache();

} // namespace tetrace
