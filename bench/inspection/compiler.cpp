#include "bench/inspection/compiler.h"

#include "core/base/error.h"
#include "core/base/printable.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace tetrace {

namespace {

constexpr double max_kernel_s = 300; // of one kernel; the slowest take 10

} // namespace

std::filesystem::path find_compiler(const char* name, const std::vector<std::filesystem::path>& folders)
{
    std::vector<std::filesystem::path> places;
    const char* const path = std::getenv("PATH");
    std::istringstream list(path != nullptr ? path : "");
    for (std::string folder; std::getline(list, folder, ':');)
        if (!folder.empty()) places.emplace_back(folder);
    places.insert(places.end(), folders.begin(), folders.end());
    for (const std::filesystem::path& folder : places)
        if (::access((folder / name).c_str(), X_OK) == 0) return folder / name;
    return {};
}

ChildOutcome run_compiler(const std::filesystem::path& program, const std::vector<std::string>& arguments)
{
    ChildOutcome outcome = run_child(program, arguments, {.time_s = max_kernel_s});
    if (outcome.end == ChildOutcome::End::interrupted) throw Error(ErrorKind::interrupted, "inspect: interrupted");
    return outcome;
}

bool succeeded(const ChildOutcome& outcome)
{
    return outcome.end == ChildOutcome::End::exited && outcome.code == 0;
}

std::string first_line(const std::string& text)
{
    return printable_line(text.substr(0, std::min<std::size_t>(text.find('\n'), 300)));
}

} // namespace tetrace
