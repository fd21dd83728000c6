#include "bench/expectations/expectation_files.h"

#include "bench/results/json_file.h"
#include "bench/results/result_folder.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* file_kind = "expectations";

bool is_file_name(const fs::path& path)
{
    return path.extension() == ".json";
}

/// Those of compilers, which `tetrace inspect` is compared with, are in the same folder.
bool is_of_compiler(const json& file)
{
    return file.is_object() && file.contains("programs");
}

/// An object by implementation has only objects.
bool is_single(const json& file)
{
    constexpr const char* keys[] = {"self_test", "rows", "exceptions", "defects", "flakes"};
    return file.is_object() && std::ranges::any_of(keys, [&](const char* key) { return file.contains(key); });
}

void read_file(Expectations& all, const fs::path& path, bool is_in_folder)
{
    const json file = read_json(path, file_kind);
    if (is_in_folder && is_of_compiler(file)) return;
    const ResultValue value(file, path.string(), file_kind);
    if (is_single(file)) {
        all[path.stem().string()] = expectation_from(value);
        all[path.stem().string()].file = path.string();
        return;
    }
    for (const auto& [implementation, one] : value.members()) {
        all[implementation] = expectation_from(one);
        all[implementation].file = path.string();
    }
}

void read_path(Expectations& all, const fs::path& path)
{
    const bool is_folder = fs::is_directory(path);
    if (!is_folder) return read_file(all, path, false);
    for (const fs::path& file : files_below({path}))
        read_file(all, file, true);
}

std::string text_of(const json& value)
{
    return value.dump(2) + "\n";
}

/// What the run did not do is kept.
void update(Expectation& kept, const Expectation& shown)
{
    for (const auto& [name, status] : shown.defects)
        kept.defects[name] = status;
    if (!shown.defects.empty()) return;
    if (!shown.self_test.empty()) kept.self_test = shown.self_test;
    for (const auto& [schedule, status] : shown.rows)
        kept.rows[schedule] = status;
    std::erase_if(kept.exceptions, [&](const auto& exception) { return shown.judged.contains(exception.first); });
    for (const auto& [name, status] : shown.exceptions)
        kept.exceptions[name] = status;
    for (const Expectation::Flakes& some : shown.flakes)
        if (std::ranges::find(kept.flakes, some.expression, &Expectation::Flakes::expression) == kept.flakes.end())
            kept.flakes.push_back(some);
}

} // namespace

Expectations read_expectations(const std::vector<fs::path>& paths)
{
    Expectations all;
    for (const fs::path& path : paths)
        read_path(all, path);
    return all;
}

ExpectationTarget::ExpectationTarget(fs::path path)
    : path_(std::move(path)), is_folder_(fs::is_directory(path_) || !is_file_name(path_))
{
    std::error_code problem;
    if (is_folder_) fs::create_directories(path_, problem);
    if (is_folder_ && !fs::is_directory(path_))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--write-expect: the folder '{}' cannot be made: {}; name another one, or a .json file",
                                path_.string(), problem ? problem.message() : "a file has that name"));
    if (!is_folder_) require_writable(path_);
    if (is_folder_ ? !fs::is_empty(path_) : fs::exists(path_)) read_path(all_, path_);
}

std::vector<fs::path> ExpectationTarget::write(const Expectations& shown)
{
    std::vector<fs::path> files;
    for (const auto& [implementation, one] : shown) {
        update(all_[implementation], one);
        if (is_folder_) {
            files.push_back(path_ / (implementation + ".json"));
            write_whole(files.back(), text_of(expectation_json(all_[implementation])));
        }
    }
    if (is_folder_) return files;
    const bool is_alone = all_.size() == 1 && all_.begin()->first == path_.stem();
    json object = json::object();
    for (const auto& [implementation, one] : all_)
        object[implementation] = expectation_json(one);
    write_whole(path_, text_of(is_alone ? expectation_json(all_.begin()->second) : object));
    return {path_};
}

} // namespace tetrace
