#include "bench/reproduce/journal.h"

#include "core/base/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <sys/file.h>
#include <unistd.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* head_key = "journal";
const json finished_line = {{"finished", true}};

/// The differences between two heads, by their keys.
std::string differences(const json& theirs, const json& ours)
{
    std::string text;
    for (const auto& [key, value] : ours.items())
        if (!theirs.contains(key) || theirs[key] != value)
            text += fmt::format("\n  {}: {} there, {} here", key, theirs.contains(key) ? theirs[key].dump() : "none",
                                value.dump());
    return text.empty() ? "\n  it was written by another version" : text;
}

} // namespace

Journal::Journal(std::filesystem::path path, const json& head, bool resume) : path_(std::move(path))
{
    open_and_lock();
    try {
        if (read(head, resume)) return;
        if (::ftruncate(file_, 0) != 0) fail("emptying");
        write_line({{head_key, head}});
    } catch (...) {
        ::close(file_);
        throw;
    }
}

Journal::~Journal()
{
    ::close(file_);
}

void Journal::append(const json& entry)
{
    finished_ = false; // a repeated run may add what a whole run lacked: a device that could not be measured
    write_line(entry);
}

void Journal::reject(const std::string& why) const
{
    throw Error(ErrorKind::usage, fmt::format("--resume: {}; remove '{}' to begin anew", why, path_.string()));
}

void Journal::finish()
{
    if (!finished_) write_line(finished_line);
    finished_ = true;
}

void Journal::open_and_lock()
{
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file_ < 0) fail("opening");
    if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(file_);
    throw Error(ErrorKind::usage, fmt::format("the journal '{}' is being written by another run; wait for its end, or "
                                              "name another file with --out",
                                              path_.string()));
}

/// Whether there are entries to continue from.
bool Journal::read(const json& head, bool resume)
{
    std::ifstream file(path_, std::ios::binary);
    std::ostringstream whole;
    whole << file.rdbuf();
    std::string text = whole.str();
    text.erase(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1); // the last line is incomplete
    if (text.empty()) return false;
    std::istringstream lines(text);
    std::vector<json> parsed;
    for (std::string line; std::getline(lines, line);) {
        parsed.push_back(json::parse(line, nullptr, false));
        if (!parsed.back().is_object())
            throw Error(ErrorKind::invalid_input, fmt::format("line {} of the journal '{}' cannot be read; remove the "
                                                              "file to begin anew",
                                                              parsed.size(), path_.string()));
    }
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
    const std::string text = line.dump() + "\n";
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
    throw Error(ErrorKind::invalid_input, fmt::format("{} the journal '{}': {}; name another file with --out", doing,
                                                      path_.string(), std::strerror(errno)));
}

} // namespace tetrace
