#include "core/device/program_cache.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"

#include <cstring>
#include <fstream>
#include <iterator>

namespace tetrace {

std::optional<std::vector<unsigned char>> ProgramCache::find(std::uint64_t key) const
{
    if (folder_.empty()) return std::nullopt;
    std::ifstream file(path_of(key), std::ios::binary);
    std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
    std::uint64_t hash = 0;
    if (bytes.size() <= sizeof(hash)) return std::nullopt;
    std::memcpy(&hash, bytes.data(), sizeof(hash));
    bytes.erase(bytes.begin(), bytes.begin() + sizeof(hash));
    if (hash != hash_of(bytes)) return std::nullopt;
    return bytes;
}

void ProgramCache::keep(std::uint64_t key, std::span<const unsigned char> program) const
{
    if (folder_.empty()) return;
    std::error_code failure; // if this fails, writing fails too
    std::filesystem::create_directories(folder_, failure);
    try {
        const std::uint64_t hash = hash_of(program);
        AtomicFile file(path_of(key));
        file.write(std::as_bytes(std::span(&hash, 1)));
        file.write(std::as_bytes(program));
        file.commit();
    } catch (const Error&) {
        return; // on failure the next run compiles again
    }
}

} // namespace tetrace
