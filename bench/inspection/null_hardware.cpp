#include "bench/inspection/null_hardware.h"

#include "bench/inspection/work_folder.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"
#include "core/device/backend.h"
#include "scenes/child_process.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tetrace {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* no_radv = "RADV, Mesa's Vulkan driver for AMD's GPUs, is missing; install mesa-vulkan-drivers";
constexpr double max_child_s = 600; // of a child; all programs of a target take about a minute

/// RADV's file among those that the Vulkan loader reads; empty if there is none.
fs::path driver_file()
{
    std::vector<fs::path> files;
    for (const char* const name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
        const char* const set = std::getenv(name);
        std::istringstream list(set != nullptr ? set : "");
        for (std::string file; std::getline(list, file, ':');)
            files.emplace_back(file);
    }
    for (const char* const folder : {"/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d",
                                     "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
        std::error_code not_there;
        for (const auto& entry : fs::directory_iterator(folder, not_there))
            files.push_back(entry.path());
    }
    const auto found = std::ranges::find_if(files, [](const fs::path& file) {
        return file.filename().string().starts_with("radeon_icd") && fs::exists(file);
    });
    return found == files.end() ? fs::path() : *found;
}

json figures_json(const CodeFigures& figures)
{
    return {{"branches", figures.branches},
            {"loads", figures.loads},
            {"loads_in_loops", figures.loads_in_loops},
            {"fused", figures.fused},
            {"first_fused", figures.first_fused},
            {"instructions", figures.instructions}};
}

json compiled_json(const Backend& source, std::size_t device, const EntryPoint& point, const fs::path& code,
                   const fs::path& program)
try {
    const CompiledCode compiled = source.compiled(device, point.kernel, point.entry == Entry::outside, program);
    if (!code.empty()) write_whole(code, compiled.text);
    json line = {{"compiler", compiled.compiler}, {"lanes", compiled.lanes}, {"statistics", compiled.statistics}};
    if (!compiled.text.empty()) line["code"] = figures_json(read_amd(compiled.text));
    return line;
} catch (const Error& error) {
    return {{"error", error.what()}};
}

/// The device that the variable makes RADV offer.
struct NullDevice {
    const Backend* source = nullptr;
    std::size_t index = 0;
    std::string reason; ///< why there is none
};

NullDevice find_null_device()
{
    NullDevice found{nullptr, 0, "this build lacks Vulkan"};
    for (const Backend* backend : all_backends()) {
        if (!backend->shows_code()) continue;
        const auto& devices = backend->devices();
        found.reason = devices.front().reason;
        for (std::size_t i = 0; i < devices.size(); ++i)
            if (devices[i].compile_only) return {backend, i, {}};
    }
    return found;
}

Inspected::Count count_of(const json& object, const char* key)
{
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    return static_cast<std::uint64_t>(std::max(0.0, found->get<double>()));
}

void take_line(Inspected& row, const json& line)
{
    if (line.contains("error")) {
        row.status = InspectedStatus::error;
        row.reason = printable_line(line["error"].get<std::string>());
        return;
    }
    row.status = InspectedStatus::ok;
    row.reason.clear();
    row.compiler = printable_line(line.at("compiler").get<std::string>());
    row.lanes = count_of(line, "lanes");
    take_statistics(row, line.at("statistics").get<std::map<std::string, double>>());
    const auto code = line.find("code");
    if (code == line.end()) return;
    row.loads = count_of(*code, "loads");
    row.loads_in_loops = count_of(*code, "loads_in_loops");
    row.fused = count_of(*code, "fused");
    row.first_fused = printable_line(code->at("first_fused").get<std::string>());
}

/// What the child says on standard error after each program.
constexpr const char* compiled_word = "compiled";

std::string last_line(const std::string& text)
{
    std::istringstream stream(text);
    std::string last;
    for (std::string line; std::getline(stream, line);)
        if (!line.empty() && line != compiled_word) last = printable_line(line.substr(0, 300));
    return last;
}

/// What a child reported; `reason` where it could not begin.
struct Answer {
    std::vector<Inspected> rows;
    std::string reason;
};

Answer ask_family(const std::string& family, const fs::path& driver, const std::vector<Inspected>& unknown,
                  const std::vector<std::size_t>& numbers, const fs::path& code, const fs::path& program,
                  const PartDone& tell)
{
    const WorkFolder folder;
    const fs::path report = folder.path() / "report";
    std::vector<std::string> arguments = {null_hardware_word,
                                          family,
                                          driver.string(),
                                          report.string(),
                                          code.empty() ? "-" : (code / unknown.front().target.name).string(),
                                          program.empty() ? "-" : program.string()};
    for (const std::size_t number : numbers)
        arguments.push_back(std::to_string(number));
    double done = 0;
    const auto count = [&](const std::string& line) { done += line == compiled_word ? 1 : 0; };
    const ChildOutcome outcome = run_child(fs::read_symlink("/proc/self/exe"), arguments, {.time_s = max_child_s},
                                           count, [&](double) { tell(done / static_cast<double>(numbers.size())); });
    if (outcome.end == ChildOutcome::End::interrupted) throw Error(ErrorKind::interrupted, "inspect: interrupted");
    Answer answer{unknown, {}};
    Inspected::Count most;
    std::size_t taken = 0;
    std::ifstream lines(report);
    for (std::string text; std::getline(lines, text);) {
        const json line = json::parse(text, nullptr, false);
        if (line.is_discarded()) break; // the child died while it wrote
        if (line.contains("reason")) return {{}, printable_line(line["reason"].get<std::string>())};
        if (line.contains("most_subgroups"))
            most = count_of(line, "most_subgroups");
        else if (taken < answer.rows.size())
            take_line(answer.rows[taken++], line);
    }
    const std::string words = last_line(outcome.errors);
    if (!most) return {{}, words.empty() ? "the driver reported nothing" : words};
    for (Inspected& row : answer.rows) {
        row.max_subgroups = most;
        if (row.status == InspectedStatus::skipped) {
            row.status = InspectedStatus::error;
            row.reason = "the driver ended before this program" + (words.empty() ? "" : ": " + words);
        }
    }
    return answer;
}

std::vector<std::size_t> numbers_of(const std::vector<EntryPoint>& points)
{
    const auto all = all_entry_points(Maker::amd);
    std::vector<std::size_t> numbers;
    for (const EntryPoint& point : points)
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i].kernel == point.kernel && all[i].entry == point.entry) numbers.push_back(i);
    return numbers;
}

} // namespace

std::vector<Inspected> ask_null_hardware(const Target& target, const std::vector<EntryPoint>& points,
                                         const fs::path& code, const PartDone& tell, const fs::path& program)
{
    const fs::path driver = driver_file();
    if (driver.empty()) return unasked(target, points, no_radv);
    const auto unknown = unasked(target, points, "not compiled");
    const auto numbers = numbers_of(points);
    std::string first_reason;
    for (const std::string& family : family_names(target.name)) {
        Answer answer = ask_family(family, driver, unknown, numbers, code, program, tell);
        if (answer.reason.empty()) return answer.rows;
        if (first_reason.empty()) first_reason = answer.reason;
    }
    return unasked(target, points, first_reason);
}

int run_null_hardware(const std::vector<std::string>& arguments)
{
    constexpr std::size_t before_numbers = 5;
    if (arguments.size() < before_numbers) return exit_code(ErrorKind::usage);
    const std::string &family = arguments[0], &driver = arguments[1];
    const std::string code = arguments[3] == "-" ? "" : arguments[3];
    const std::string program = arguments[4] == "-" ? "" : arguments[4];
    ::setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
    ::setenv("VK_DRIVER_FILES", driver.c_str(), 1);  // of loaders from 1.3.207 on
    ::setenv("VK_ICD_FILENAMES", driver.c_str(), 1); // of all others
    ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    std::ofstream report(arguments[2]);
    const NullDevice device = find_null_device();
    if (device.source == nullptr) {
        report << json{{"reason", device.reason}}.dump() << std::endl;
        return exit_code(ErrorKind::missing);
    }
    const auto all = all_entry_points(Maker::amd);
    const CompiledCode nothing = device.source->compiled(device.index, std::nullopt, true, {});
    const auto most = nothing.statistics.find("Subgroups per SIMD");
    report << json{{"most_subgroups", most == nothing.statistics.end() ? 0.0 : most->second}}.dump() << std::endl;
    for (std::size_t i = before_numbers; i < arguments.size(); ++i) {
        std::size_t number = 0;
        std::from_chars(arguments[i].data(), arguments[i].data() + arguments[i].size(), number);
        const EntryPoint& point = all.at(number);
        const json line = compiled_json(*device.source, device.index, point,
                                        code.empty() ? code : code + code_file_name(point), program);
        report << line.dump(-1, ' ', false, json::error_handler_t::replace) << std::endl;
        std::fprintf(stderr, "%s\n", compiled_word);
    }
    return 0;
}

} // namespace tetrace
