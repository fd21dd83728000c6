#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace tetrace {

/// What a long run has finished so far: a file of JSON, a line an entry, each on the disk before append() returns, so
/// that a run which was killed goes on where it was. The first line, the head, says what the run is; only the same run
/// goes on from it.
class Journal {
public:
    /// Begins a journal, or goes on with one.
    /// head: an object that names all that decides what the entries are. resume: take the entries of a journal that is
    /// there; where there is none, begin one.
    /// A last line that was cut off is dropped. Throws Error{usage} where an unfinished journal is there and resume is
    /// not asked for, where its head is another one (the text names what differs), or where another process writes it;
    /// Error{invalid_input} naming file and line where it cannot be read or written.
    Journal(std::filesystem::path path, const nlohmann::json& head, bool resume);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// The entries of the run that this one goes on from, in the order in which they were appended.
    [[nodiscard]] const std::vector<nlohmann::json>& entries() const { return entries_; }
    void append(const nlohmann::json& entry);
    /// Throws Error{usage} with why the entries cannot be gone on from, and what to do.
    [[noreturn]] void reject(const std::string& why) const;
    /// The run is whole: a later one begins anew without asking, or with resume repeats its result.
    void finish();

private:
    void open_and_lock();
    [[nodiscard]] bool read(const nlohmann::json& head, bool resume);
    void write_line(const nlohmann::json& line);
    [[noreturn]] void fail(const char* doing) const;

    std::filesystem::path path_;
    int file_ = -1;
    bool finished_ = false;
    std::vector<nlohmann::json> entries_;
};

} // namespace tetrace
