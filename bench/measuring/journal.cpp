#include "bench/measuring/journal.h"

#include "core/base/files.h"
#include "core/base/hash.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* head_key = "journal";
const json finished_line = {{"finished", true}};

constexpr std::string_view before_checksum = R"({"checksum":")", before_entry = R"(","entry":)";
constexpr std::size_t max_journal = std::size_t{1} << 30;

/// In one line; what is not UTF-8, such as a path may be, is replaced.
std::string json_text(const json& value)
{
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Of an entry's text after the line with this checksum.
std::uint64_t checksum(std::string_view entry, std::uint64_t before)
{
    return hash_of(entry, before);
}

std::string line_of(std::string_view entry, std::uint64_t checksum)
{
    return fmt::format("{}{}{}{}}}", before_checksum, hash_text(checksum), before_entry, entry);
}

/// The text of a line's entry; empty if the line is none of a journal.
std::string_view entry_of(std::string_view line)
{
    const std::size_t place = before_checksum.size() + 16 + before_entry.size();
    return line.size() > place && line.ends_with('}') ? line.substr(place, line.size() - place - 1)
                                                      : std::string_view();
}

/// Before lines had checksums, the head was the first line itself.
bool is_old(std::string_view text)
{
    return text.starts_with(R"({"journal":)");
}

/// The differences between two heads, by their keys.
std::string differences(const json& theirs, const json& ours)
{
    std::string text;
    for (const auto& [key, value] : ours.items())
        if (!theirs.contains(key) || theirs[key] != value)
            text += fmt::format("\n  {}: {} there, {} here", key,
                                theirs.contains(key) ? json_text(theirs[key]) : "none", json_text(value));
    return text.empty() ? "\n  it was written by another version" : text;
}

[[noreturn]] void fail_at(const char* doing, const std::filesystem::path& path)
{
    throw JournalError(ErrorKind::invalid_input, fmt::format("{} the journal '{}': {}; name another file with --out",
                                                             doing, path.string(), std::strerror(errno)));
}

/// The whole file.
std::string read_text(int file, const std::filesystem::path& path)
{
    struct stat found {};
    if (::fstat(file, &found) != 0) fail_at("reading", path);
    auto size = static_cast<std::size_t>(found.st_size);
    if (size > max_journal)
        throw Error(ErrorKind::invalid_input, fmt::format("the journal '{}' is larger than 1 GiB, which no journal is; "
                                                          "remove the file to begin anew",
                                                          path.string()));
    std::string text(size, '\0');
    for (std::size_t done = 0; done < size;) {
        const ssize_t read = ::pread(file, text.data() + done, size - done, static_cast<off_t>(done));
        if (read < 0 && errno == EINTR) continue;
        if (read < 0) fail_at("reading", path);
        if (read == 0) text.resize(size = done);
        done += static_cast<std::size_t>(read);
    }
    return text;
}

/// Without the last line where that is incomplete.
std::string whole_lines(std::string text)
{
    text.erase(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
    return text;
}

/// The value of a text; none if it is not JSON, or nested deeper than any entry: the library writes a value by a call a
/// level, so that a deep one would exhaust the stack.
json parsed_entry(std::string_view text)
{
    constexpr int deepest = 64;
    bool is_deep = false;
    json entry = json::parse(
        text,
        [&](int depth, json::parse_event_t, const json&) {
            is_deep = is_deep || depth > deepest;
            return !is_deep;
        },
        false);
    return is_deep ? json() : entry;
}

/// The entries of whole lines. last: the last one's checksum.
std::vector<json> parse(std::string_view text, const std::filesystem::path& path, std::uint64_t& last)
{
    std::vector<json> parsed;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(line.size() + 1);
        const std::string_view entry = entry_of(line);
        last = checksum(entry, last);
        const bool is_sound = line == line_of(entry, last);
        parsed.push_back(is_sound ? parsed_entry(entry) : json());
        if (!parsed.back().is_object())
            throw Error(ErrorKind::invalid_input,
                        fmt::format("line {} of the journal '{}' is damaged, or one before it is missing: its checksum "
                                    "is another; remove the file to begin anew",
                                    parsed.size(), path.string()));
    }
    return parsed;
}

/// Closes it at the end.
struct OpenFile {
    int number = -1;
    ~OpenFile() { ::close(number); }
};

} // namespace

Journal::Journal(std::filesystem::path path, const json& asked, bool resume, bool replaces) : path_(std::move(path))
{
    const json head = json::parse(json_text(asked)); // as it comes back from the file
    open_and_lock();
    try {
        if (read(head, resume, replaces)) return;
        checksum_ = 0;
        if (::ftruncate(file_, 0) != 0) fail("emptying");
        write_line({{head_key, head}});
    } catch (...) {
        ::close(file_);
        throw;
    }
}

Journal::Journal(std::vector<json> merged) : finished_(true), entries_(std::move(merged)) {}

Journal::~Journal()
{
    if (file_ >= 0) ::close(file_);
}

void Journal::append(const json& entry)
{
    if (is_merged()) return;
    finished_ = false; // a repeated run may add what a whole run lacked: a device that could not be measured
    write_line(entry);
}

void Journal::reject(const std::string& why) const
{
    if (is_merged()) throw Error(ErrorKind::usage, fmt::format("merging shards: {}", why));
    throw Error(ErrorKind::usage, fmt::format("--resume: {}; remove '{}' to begin anew", why, path_.string()));
}

void Journal::finish()
{
    if (!finished_) write_line(finished_line);
    finished_ = true;
}

void Journal::open_and_lock()
{
    // A pipe would wait for its other end, and /dev/zero has none: looked at before it is opened, and after.
    struct stat found {};
    const auto require_regular = [&] {
        if (!S_ISREG(found.st_mode))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the journal '{}' is not a regular file but a folder, a pipe or a device; name "
                                    "another file with --out",
                                    path_.string()));
    };
    if (::stat(path_.c_str(), &found) == 0) require_regular();
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
    if (file_ < 0 || ::fstat(file_, &found) != 0) fail("opening");
    require_regular();
    const LockAttempt attempt = try_lock(file_);
    if (attempt == LockAttempt::taken) return;
    if (attempt == LockAttempt::failed) fail("locking");
    ::close(file_);
    throw Error(ErrorKind::usage, fmt::format("the journal '{}' is being written by another run; wait for its end, or "
                                              "name another file with --out",
                                              path_.string()));
}

/// Whether there are entries to continue from.
bool Journal::read(const json& head, bool resume, bool replaces)
{
    std::string text = read_text(file_, path_);
    if (replaces && !resume) {
        const std::size_t known = std::min(text.size(), before_checksum.size()); // a killed run may have written less
        if (text.starts_with(before_checksum.substr(0, known)) || is_old(text)) return false;
        throw Error(ErrorKind::usage, fmt::format("'{}' is not a journal of tetrace and would be replaced by one; move "
                                                  "it away, or name another file with --out",
                                                  path_.string()));
    }
    text = whole_lines(std::move(text));
    if (text.empty()) return false;
    if (is_old(text)) {
        if (!resume && text.ends_with("\n" + finished_line.dump() + "\n")) return false;
        throw Error(ErrorKind::usage, fmt::format("'{}' is the journal of an older tetrace, whose lines lack "
                                                  "checksums; end that run with its program, or remove the file to "
                                                  "begin anew",
                                                  path_.string()));
    }
    const std::vector<json> parsed = parse(text, path_, checksum_);
    finished_ = parsed.back() == finished_line;
    if (!resume && finished_) {
        finished_ = false;
        return false;
    }
    if (!resume)
        throw Error(ErrorKind::usage, fmt::format("'{}' is the journal of a run that did not end; go on with it by "
                                                  "--resume, or remove it to begin anew",
                                                  path_.string()));
    if (!parsed.front().contains(head_key) || parsed.front()[head_key] != head)
        throw Error(ErrorKind::usage,
                    fmt::format("--resume: the journal '{}' is of another run:{}\nrepeat that run's command line with "
                                "its program, or remove the file to begin anew",
                                path_.string(), differences(parsed.front().value(head_key, json::object()), head)));
    if (::ftruncate(file_, static_cast<off_t>(text.size())) != 0) fail("cutting off the last line of");
    std::copy_if(parsed.begin() + 1, parsed.end(), std::back_inserter(entries_),
                 [](const json& line) { return line != finished_line; });
    return true;
}

void Journal::write_line(const json& line)
{
    const std::string entry = json_text(line);
    checksum_ = checksum(entry, checksum_);
    const std::string text = line_of(entry, checksum_) + "\n";
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t written = ::write(file_, text.data() + done, text.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("writing");
        done += static_cast<std::size_t>(written);
    }
    if (::fdatasync(file_) != 0) fail("writing");
}

void Journal::fail(const char* doing) const
{
    fail_at(doing, path_);
}

JournalFile read_journal(const std::filesystem::path& path)
{
    const OpenFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.number < 0)
        throw Error(ErrorKind::missing,
                    fmt::format("the journal '{}' cannot be read: {}; it belongs to the result, and "
                                "goes where that goes",
                                path.string(), std::strerror(errno)));
    std::uint64_t last = 0;
    std::vector<json> lines = parse(whole_lines(read_text(file.number, path)), path, last);
    if (lines.empty() || !lines.front().contains(head_key))
        throw Error(ErrorKind::invalid_input, fmt::format("'{}' is not a journal of this tetrace", path.string()));
    JournalFile journal{lines.front()[head_key], {}, lines.back() == finished_line};
    std::copy_if(lines.begin() + 1, lines.end(), std::back_inserter(journal.entries),
                 [](const json& line) { return line != finished_line; });
    return journal;
}

} // namespace tetrace
