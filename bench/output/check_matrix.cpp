#include "bench/output/check_matrix.h"

#include "bench/measuring/conformity.h"
#include "bench/rows/answer_form.h"
#include "bench/terminal/sheet.h"
#include "bench/terminal/text.h"
#include "core/base/hash.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using Pointers = std::vector<const RowRecord*>;

/// The distinct texts that `name` gives for the rows, in order of first appearance.
template <class Name>
std::vector<std::string> names_of(const Pointers& rows, const Name& name)
{
    std::vector<std::string> names;
    for (const RowRecord* row : rows)
        if (std::ranges::find(names, name(row->key)) == names.end()) names.push_back(name(row->key));
    return names;
}

const RowRecord* row_at(const Pointers& rows, const std::string& kernel, const std::string& device)
{
    for (const RowRecord* row : rows)
        if (kernel_title(row->key) == kernel && device_label(row->key) == device) return row;
    return nullptr;
}

/// Of all hits; of merged shards, of their views' hashes.
std::uint64_t hash_of_answers(const RowRecord& row)
{
    const Traced& result = *traced(row);
    return result.hit_hash != 0 ? result.hit_hash : result.views_hash;
}

/// Rows of one kernel that gave the same hits.
struct Answer {
    std::string kernel, devices;
    const RowRecord* first = nullptr;
    std::size_t rows = 1;
};

std::vector<Answer> answers_of(const Pointers& rows)
{
    std::vector<Answer> answers;
    for (const RowRecord* row : rows) {
        if (traced(*row) == nullptr) continue;
        const auto known = std::ranges::find_if(answers, [&](const Answer& answer) {
            return answer.kernel == kernel_title(row->key) && hash_of_answers(*answer.first) == hash_of_answers(*row);
        });
        if (known != answers.end()) {
            known->devices += ", " + device_label(row->key);
            ++known->rows;
        } else
            answers.push_back({kernel_title(row->key), device_label(row->key), row});
    }
    return answers;
}

/// The devices' names; their number where all devices that traced the kernel agree, which keeps the line short.
std::string devices_of(const Answer& answer, const Pointers& rows)
{
    const auto all = static_cast<std::size_t>(std::ranges::count_if(rows, [&](const RowRecord* row) {
        return traced(*row) != nullptr && kernel_title(row->key) == answer.kernel;
    }));
    return answer.rows == all && all > 2 ? fmt::format("all {} devices", all) : answer.devices;
}

} // namespace

Table matrix_table(const std::string& scene, const std::vector<RowRecord>& all)
{
    const Pointers rows = rows_of(scene, all);
    const auto devices = names_of(rows, device_label);
    std::vector<Column> columns = {{"row", "row"}};
    for (const std::string& device : devices)
        columns.push_back({.key = device, .title = device, .coloured = true, .rank = 0});
    Table table(columns);
    for (const std::string& kernel : names_of(rows, kernel_title)) {
        std::vector<Cell> cells = {kernel};
        for (const std::string& device : devices) {
            const RowRecord* row = row_at(rows, kernel, device);
            cells.push_back(row != nullptr ? Cell(conformity_text(*row)) : Cell());
        }
        table.add(std::move(cells));
    }
    return table;
}

std::vector<std::string> check_columns_of(const std::vector<RowKey>& keys)
{
    Sheet sheet;
    std::vector<Column> devices = {{"row", "row"}};
    for (const RowKey& key : keys)
        devices.push_back({device_label(key), device_label(key)});
    sheet.table(Table(std::move(devices)));
    sheet.table(answers_table({}, {}));
    sheet.table(self_test_table({}));
    return sheet.column_keys();
}

Table answers_table(const std::string& scene, const std::vector<RowRecord>& all)
{
    Table table({{"row", "row"},
                 {.key = "hits", .title = "hit hash", .rank = 2},
                 {"rays", "rays"},
                 {"agreed", "agreed"},
                 {"ties", "ties"},
                 {"largest", "largest"},
                 {"settled", "settled"},
                 {"offset", "offset"},
                 {.key = "wrong", .title = "wrong", .rank = 0},
                 {.key = "lost", .title = "lost", .rank = 0},
                 {"devices", "from"}});
    const Pointers rows = rows_of(scene, all);
    for (const Answer& answer : answers_of(rows)) {
        const Traced& result = *traced(*answer.first);
        const Verdicts& verdicts = result.verdicts;
        table.add({answer.kernel, hash_text(hash_of_answers(*answer.first)), verdicts.rays, verdicts.agreed,
                   verdicts.ties, verdicts.ties > 0 ? Cell(fmt::format("{:.1e}", verdicts.max_tie_distance)) : Cell(),
                   verdicts.settled, verdicts.offset, verdicts.wrong, verdicts.lost, devices_of(answer, rows)});
    }
    return table;
}

namespace {

/// The device's name, and if another driver's device has the same, the driver's library.
std::string distinct_name(const Device& device, const std::vector<RowRecord>& rows)
{
    const bool is_shared = std::ranges::any_of(rows, [&](const RowRecord& other) {
        return other.device.name == device.name && other.device.library != device.library;
    });
    return is_shared && !device.library.empty() ? fmt::format("{} ({})", device.name, device.library) : device.name;
}

} // namespace

Table self_test_table(const std::vector<RowRecord>& rows)
{
    Table table({{"label", "device"},
                 {"name", "name"},
                 {"type", "type"},
                 {.key = "self_test", .title = "self-test, exact mode", .rank = 0}});
    std::vector<std::string> told;
    for (const RowRecord& row : rows) {
        const std::string label = device_label(row.key);
        if (row.device.name.empty() || !row.device.usable || row.key.kernel.math != MathMode::exact ||
            std::ranges::find(told, label) != told.end())
            continue;
        told.push_back(label);
        table.add({label, distinct_name(row.device, rows), std::string(name_of(row.device.kind)),
                   row.self_test ? Cell(row.self_test->brief()) : Cell()});
    }
    return table;
}

nlohmann::json matrix_json(const std::vector<RowRecord>& rows)
{
    nlohmann::json matrix = nlohmann::json::object();
    for (const RowRecord& row : rows) {
        auto& cell = matrix[row.key.scene][kernel_title(row.key)][device_label(row.key)];
        cell["cell"] = conformity_text(row);
        cell["conformity"] = name_of(conformity_of(row));
        const Traced* result = traced(row);
        if (result != nullptr && result->hit_hash != 0) cell["hit_hash"] = hash_text(result->hit_hash);
    }
    return matrix;
}

namespace {

using Path = std::vector<std::uint32_t>;

constexpr std::size_t shown_tets = 200;

std::string path_text(const char* title, const Path& path)
{
    if (path.empty()) return {};
    std::string text = fmt::format("  {}:", title);
    for (std::size_t i = 0; i < std::min(path.size(), shown_tets); ++i)
        text += fmt::format(" {}", path[i]);
    if (path.size() > shown_tets) text += fmt::format(" ... ({} in all)", path.size());
    return wrapped(text, 110, 2);
}

/// Where two walks diverge; empty if they do not.
std::string parting_text(const Path& ours, const Path& openmps)
{
    if (ours.empty() || openmps.empty()) return {};
    const auto [own, other] = std::mismatch(ours.begin(), ours.end(), openmps.begin(), openmps.end());
    if (own == ours.end() || other == openmps.end()) return {};
    return fmt::format("  The walks part at step {}: tet {} here, tet {} with openmp.\n", own - ours.begin() + 1, *own,
                       *other);
}

/// "  Step by step: tetrace trace ...", in a line of its own, ready to paste.
std::string command_text(const std::string& command)
{
    return command.empty() ? std::string() : fmt::format("  Step by step: {}\n", command);
}

std::string different_text(const RowRecord& row, const DifferingRay& ray)
{
    const RayWalk& walk = traced(row)->walk_of_different;
    return fmt::format("{}: {} rays differ from openmp's, the first at view {}, pixel ({}, {})\n  this row: {}\n"
                       "  openmp:   {}\n{}{}{}{}\n",
                       row_name(row.key), traced(row)->different, ray.view, ray.x, ray.y,
                       answers_of(ray.task).text(ray.ours), answers_of(ray.task).text(ray.openmp),
                       path_text("tets of this row", walk.own), path_text("tets of openmp", walk.openmp),
                       parting_text(walk.own, walk.openmp), command_text(walk.command));
}

std::string wrong_text(const RowRecord& row, const WrongRay& ray)
{
    const std::string exact =
        traits_of(ray.task).finds_hits
            ? fmt::format("  exact ray: {}, t {:.9g}\n", face_text(ray.reference_face), ray.reference_t)
            : std::string();
    return fmt::format("{}: first wrong ray: view {}, pixel ({}, {}): {}\n  this row:  {}\n{}{}{}\n", row_name(row.key),
                       ray.view, ray.x, ray.y, ray.reason, answers_of(ray.task).text(ray.ours), exact,
                       path_text("tets of openmp", traced(row)->walk_of_wrong.openmp),
                       command_text(traced(row)->walk_of_wrong.command));
}

} // namespace

std::string differences_text(const RowRecord& row)
{
    const Traced* result = traced(row);
    if (result == nullptr) return {};
    std::string text;
    if (const auto& ray = result->first_different) text += different_text(row, *ray);
    if (const auto& ray = result->verdicts.first_wrong) text += wrong_text(row, *ray);
    return text;
}

} // namespace tetrace
