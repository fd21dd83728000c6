#include "core/device/program_cache.h"

#include "core/base/error.h"
#include "core/base/files.h"

#include <cstring>
#include <string>

namespace tetrace {

std::optional<std::vector<unsigned char>> ProgramCache::find(std::uint64_t key) const
{
    if (folder_.empty()) return std::nullopt;
    const std::optional<std::string> file = file_bytes(path_of(key));
    std::uint64_t hash = 0;
    if (!file || file->size() <= sizeof(hash)) return std::nullopt;
    std::memcpy(&hash, file->data(), sizeof(hash));
    std::vector<unsigned char> program(file->begin() + sizeof(hash), file->end());
    if (hash != hash_of(program)) return std::nullopt;
    return program;
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
