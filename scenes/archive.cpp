#include "scenes/archive.h"

#include "core/base/error.h"

#include <archive.h>
#include <archive_entry.h>
#include <cstdint>
#include <fmt/format.h>
#include <memory>
#include <string_view>

namespace tetrace {

namespace {

using Archive = std::unique_ptr<::archive, decltype(&archive_read_free)>;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& member, std::string_view reason)
{
    throw Error(ErrorKind::invalid_input, fmt::format("unpacking {} from {}: {}; reinstall the package of the archive",
                                                      member, path.string(), reason));
}

std::string_view reason_of(::archive* archive)
{
    const char* reason = archive_error_string(archive);
    return reason != nullptr ? reason : "damaged";
}

Archive open_archive(const std::filesystem::path& path, const std::string& member)
{
    Archive archive(archive_read_new(), &archive_read_free);
    if (archive == nullptr) fail(path, member, "not enough memory");
    archive_read_support_filter_gzip(archive.get());
    archive_read_support_format_tar(archive.get());
    if (archive_read_open_filename(archive.get(), path.c_str(), 64 * 1024) != ARCHIVE_OK)
        fail(path, member, reason_of(archive.get()));
    return archive;
}

bool is_member(archive_entry* entry, const std::string& member)
{
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr) return false;
    const std::string_view path = name;
    return path == member || (path.starts_with("./") && path.substr(2) == member);
}

} // namespace

std::vector<std::byte> read_archive_member(const std::filesystem::path& path, const std::string& member,
                                           std::size_t max_bytes)
{
    const Archive archive = open_archive(path, member);
    archive_entry* entry = nullptr;
    int status = ARCHIVE_OK;
    while ((status = archive_read_next_header(archive.get(), &entry)) == ARCHIVE_OK || status == ARCHIVE_WARN)
        if (is_member(entry, member)) break;
    if (status == ARCHIVE_EOF) fail(path, member, "the archive lacks this member");
    if (status != ARCHIVE_OK && status != ARCHIVE_WARN) fail(path, member, reason_of(archive.get()));
    if (archive_entry_filetype(entry) != AE_IFREG) fail(path, member, "it is not a regular file");
    const la_int64_t size = archive_entry_size(entry);
    if (size < 0 || static_cast<std::uint64_t>(size) > max_bytes)
        fail(path, member, fmt::format("it has {} bytes, at most {} are accepted", size, max_bytes));

    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::size_t filled = 0;
    while (filled < bytes.size()) {
        const la_ssize_t got = archive_read_data(archive.get(), bytes.data() + filled, bytes.size() - filled);
        if (got < 0) fail(path, member, reason_of(archive.get()));
        if (got == 0) fail(path, member, "the archive ends within it");
        filled += static_cast<std::size_t>(got);
    }
    return bytes;
}

} // namespace tetrace
