#include "bench/results/result_folder.h"

#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder)
{
    std::vector<fs::path> files;
    try {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
            if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry.path());
    } catch (const fs::filesystem_error& problem) {
        throw Error(ErrorKind::invalid_input,
                    fmt::format("reading the folder '{}': {}", folder.string(), problem.code().message()));
    }
    if (files.empty())
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("reading the folder '{}': it has no .json file, nor has any subfolder", folder.string()));
    std::ranges::sort(files);
    return files;
}

} // namespace

bool has_folder(const std::vector<fs::path>& paths)
{
    return std::ranges::any_of(paths, [](const fs::path& path) {
        std::error_code ignored;
        return fs::is_directory(path, ignored);
    });
}

std::vector<fs::path> files_below(const std::vector<fs::path>& paths)
{
    std::vector<fs::path> files;
    for (const fs::path& path : paths) {
        std::error_code ignored;
        if (!fs::exists(path, ignored))
            throw Error(ErrorKind::missing, fmt::format("'{}': the file or folder does not exist", path.string()));
        for (fs::path& file : fs::is_directory(path, ignored) ? files_in(path) : std::vector{path})
            if (std::ranges::find(files, file) == files.end()) files.push_back(std::move(file));
    }
    return files;
}

} // namespace tetrace
