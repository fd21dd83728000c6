#pragma once

#include "core/base/error.h"

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// A journal that cannot be opened, read or written: it ends the run, not the rows that were being traced.
class JournalError : public Error {
public:
    using Error::Error;
};

/// What a long run has finished so far, so that a killed run can continue. It is a file of one JSON object a line,
/// {"checksum": ..., "entry": ...}; each is on the disk before append() returns. The checksum is hash_of() the entry's
/// text, seeded with that of the line before. The first entry, the head, identifies the run; only the same run can
/// continue from it.
class Journal {
public:
    /// Begins a journal, or continues one.
    /// head: an object that names everything that determines the entries. resume: use the entries of an existing
    /// journal; if there is none, begin one. replaces: without resume, also begin anew where a run did not end.
    /// An incomplete last line is dropped. Throws Error{usage} if there is an unfinished journal that is
    /// neither to be resumed nor replaced, if its head differs (the text names the differences), if it is older than
    /// checksums, or if another process is writing it; Error{invalid_input} naming file and line where a line is
    /// damaged, missing or out of its order, if it is not a regular file, exceeds 1 GiB, or cannot be read or written.
    Journal(std::filesystem::path path, const nlohmann::json& head, bool resume, bool replaces = false);
    /// The entries of all shards of a run, in the order in which it would have written them: a journal without a file,
    /// to which nothing is added.
    explicit Journal(std::vector<nlohmann::json> merged);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// The entries of the run that this one continues, in the order in which they were appended.
    [[nodiscard]] const std::vector<nlohmann::json>& entries() const { return entries_; }
    void append(const nlohmann::json& entry);
    /// Whether it is of merged shards.
    [[nodiscard]] bool is_merged() const { return file_ < 0; }
    /// Throws Error{usage} that says why the run cannot continue from the entries, and what to do, or why shards cannot
    /// be merged.
    [[noreturn]] void reject(const std::string& why) const;
    /// Marks the run as complete: a later run starts over without asking or, with resume, repeats its result.
    void finish();

private:
    void open_and_lock();
    [[nodiscard]] bool read(const nlohmann::json& head, bool resume, bool replaces);
    void write_line(const nlohmann::json& line);
    [[noreturn]] void fail(const char* doing) const;

    std::filesystem::path path_;
    int file_ = -1;
    bool finished_ = false;
    std::uint64_t checksum_ = 0; ///< of the last line
    std::vector<nlohmann::json> entries_;
};

/// A journal as its file has it.
struct JournalFile {
    nlohmann::json head;
    std::vector<nlohmann::json> entries;
    bool finished = false;
};
/// Reads a journal that no run continues. Throws Error{missing} if there is none, Error{invalid_input} as Journal
/// does where it is damaged.
[[nodiscard]] JournalFile read_journal(const std::filesystem::path& path);

} // namespace tetrace
