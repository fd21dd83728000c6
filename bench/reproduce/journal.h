#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace tetrace {

/// What a long run has finished so far, so that a killed run can continue. It is a JSON file with one entry a line;
/// each entry is on the disk before append() returns. The first line, the head, identifies the run; only the same run
/// can continue from it.
class Journal {
public:
    /// Begins a journal, or continues one.
    /// head: an object that names everything that determines the entries. resume: use the entries of an existing
    /// journal; if there is none, begin one.
    /// An incomplete last line is dropped. Throws Error{usage} where there is an unfinished journal and resume is
    /// false, where its head differs (the text names the differences), or where another process is writing it;
    /// Error{invalid_input} naming file and line where it cannot be read or written.
    Journal(std::filesystem::path path, const nlohmann::json& head, bool resume);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// The entries of the run that this one continues, in the order in which they were appended.
    [[nodiscard]] const std::vector<nlohmann::json>& entries() const { return entries_; }
    void append(const nlohmann::json& entry);
    /// Throws Error{usage} that says why the run cannot continue from the entries, and what to do.
    [[noreturn]] void reject(const std::string& why) const;
    /// Marks the run as complete: a later run starts over without asking or, with resume, repeats its result.
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
