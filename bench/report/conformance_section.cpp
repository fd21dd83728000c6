#include "bench/report/sections.h"
#include "core/device/backend.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

const char* const how_to_read_matrices =
    "Exact mode: all bits of all hits, compared with openmp's for the same method and layout. Within N ulp: only t, "
    "u and v differ, by no more than the device's self-test allows. Not exact: the hits are openmp's, but the "
    "device contracts or rounds differently.";

/// Devices in order of appearance; those with the reference come first.
std::vector<std::string> devices_of(const ResultValue& scene)
{
    std::vector<std::string> devices;
    for (const auto& [kernel, cells] : scene.members())
        for (const auto& [device, cell] : cells.members())
            if (std::ranges::find(devices, device) == devices.end()) devices.push_back(device);
    std::stable_partition(devices.begin(), devices.end(),
                          [](const std::string& name) { return name == reference_backend().name(); });
    return devices;
}

/// The row of a result that a cell of its matrix is about; null if none has a reason.
const ReportRow* find_row(const ReportInput& input, std::size_t file, const std::array<std::string, 3>& cell)
{
    std::string kernel = cell[1];
    if (const std::size_t order = kernel.find(" order"); order != std::string::npos) kernel.erase(order, 6);
    const auto found = std::ranges::find_if(input.rows, [&](const ReportRow& row) {
        return row.file == file && !row.row->reason.empty() && row.row->scene == cell[0] &&
               row.kernel_and_rays() == kernel && row.api == cell[2];
    });
    return found == input.rows.end() ? nullptr : &*found;
}

/// What is wrong leads to its row and the reason.
Html matrix_of(const ReportInput& input, std::size_t file, const std::string& scene_name, const ResultValue& scene)
{
    const auto devices = devices_of(scene);
    std::vector<HtmlColumn> columns = {{"row"}};
    for (const std::string& device : devices)
        columns.push_back({device});
    HtmlTable table(columns);
    for (const auto& [kernel, cells] : scene.members()) {
        std::vector<Html> row = {text(kernel)};
        for (const std::string& device : devices) {
            const auto cell = cells.find(device);
            const Html shown = cell ? badge(cell->at("cell").text()) : Html();
            const ReportRow* const told = find_row(input, file, {scene_name, kernel, device});
            row.push_back(cell && told != nullptr ? row_link(*told, shown) : shown);
        }
        table.add(std::move(row));
    }
    return table.html();
}

/// What a check was expected to show, and whether it did; nothing for a result without expectations.
Html expectations_of(const ResultFile& file, const std::string& letter)
{
    const auto expectations = file.section().find("expectations");
    if (!expectations) return {};
    HtmlTable table({{"result"}, {"what"}, {"device"}, {"expected"}, {"shown"}, {"judgement"}});
    for (const ResultValue& one : expectations->at("deviations").items())
        table.add({text(letter), text(one.at("name").line()), text(one.at("device").line()),
                   text(one.at("expected").line()), text(one.at("shown").line()), badge(one.at("judgement").line())});
    std::vector<std::string> files;
    if (const auto names = expectations->find("files"))
        for (const ResultValue& name : names->items())
            files.push_back(name.line());
    std::string sentence = files.empty() ? "Judged by expectations."
                                         : fmt::format("Judged by the expectations of {}.", fmt::join(files, ", "));
    if (table.empty()) sentence += " All is as expected.";
    for (const ResultValue& implementation : expectations->at("unmentioned").items())
        sentence += fmt::format(" None mentions {}, which is expected to conform.", implementation.line());
    if (const auto unknown = expectations->find("unknown"))
        for (const ResultValue& one : unknown->items())
            sentence += " " + one.line() + ".";
    const std::string title = letter.empty() ? "Expectations" : "Expectations · " + letter;
    return heading(title) + note(sentence) + table.html();
}

/// Rows of `check` results that have more to report than their cell.
Html reasons_of(const ReportInput& input)
{
    std::vector<const ReportRow*> rows;
    for (const ReportRow& row : input.rows)
        if (input.files.at(row.file).head.verb == "check" && !row.row->reason.empty()) rows.push_back(&row);
    return rows.empty() ? Html() : heading("What is wrong") + reason_table(rows, input.files.size());
}

} // namespace

Section conformance_section(const ReportInput& input)
{
    Section section{"conformance", "Conformance", {}};
    Html matrices;
    for (std::size_t file = 0; file < input.files.size(); ++file) {
        if (const auto matrix = input.files[file].section().find("matrix"))
            for (const auto& [scene, cells] : matrix->members())
                matrices +=
                    heading(with_letter(scene, file, input.files.size())) + matrix_of(input, file, scene, cells);
    }
    if (!matrices.empty()) section.content = note(how_to_read_matrices) + matrices;
    for (std::size_t file = 0; file < input.files.size(); ++file)
        section.content += expectations_of(input.files[file], file_letter(file, input.files.size()));
    section.content += reasons_of(input);
    return section;
}

} // namespace tetrace
