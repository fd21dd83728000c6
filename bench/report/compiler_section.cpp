#include "bench/report/sections.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_programs =
    "Each entry point of a kernel, compiled for a GPU that need not be there; nothing was run. Occupancy: the "
    "subgroups "
    "that a processor of the GPU holds at once, compared with an empty kernel (AMD) or with the most (NVIDIA). Fused: "
    "floating-point operations that multiply and add with one rounding. In exact mode none may decide a sign; those in "
    "box tests of BVHs decide nothing.";

std::string count_text(const ResultValue& program, const char* key)
{
    const auto value = program.find(key);
    return value ? with_commas(value->count()) : std::string();
}

std::string occupancy_of(const ResultValue& program)
{
    const auto held = program.find("subgroups"), most = program.find("most_subgroups");
    if (!held || !most || most->count() == 0) return {};
    return fmt::format("{:.0f}", 100.0 * static_cast<double>(held->count()) / static_cast<double>(most->count()));
}

/// Registers on AMD; bytes stored and loaded on NVIDIA.
std::string spills_of(const ResultValue& program)
{
    if (program.find("spilled_registers")) return count_text(program, "spilled_registers");
    if (!program.find("spill_store_bytes")) return {};
    const std::string stores = count_text(program, "spill_store_bytes"),
                      loads = count_text(program, "spill_load_bytes");
    return stores == "0" && loads == "0" ? "0" : fmt::format("{} + {} bytes", stores, loads);
}

std::string fused_of(const ResultValue& program)
{
    const auto in = program.find("fused_in");
    if (!in) return {};
    const std::string where = in->line();
    return where == "nothing" ? "none" : fmt::format("{} in {}", count_text(program, "fused"), where);
}

std::string entry_of(const ResultValue& program)
{
    const std::string entry = program.at("entry").line(), schedule = program.at("schedule").line();
    return schedule == "tiles" ? entry : entry + " " + schedule;
}

Html programs_of(const ResultValue& programs)
{
    HtmlTable table({{"target"},
                     {"kernel"},
                     {"entry"},
                     {"registers", {}, true},
                     {"spilled", {}, true},
                     {"scratch", "bytes", true},
                     {"occupancy", "%", true},
                     {"instructions", {}, true},
                     {"branches", {}, true},
                     {"loads in loops", {}, true},
                     {"fused"},
                     {"status"}});
    for (const ResultValue& program : programs.items()) {
        const std::string reason = program.text_at("reason"), status = program.at("status").line();
        const std::string kernel = program.at("method").line() + " " + program.at("layout").line() +
                                   (program.at("math").line() == "fast" ? " fast" : "");
        table.add({text(program.at("target").line()), text(kernel), text(entry_of(program)),
                   text(count_text(program, "registers")), text(spills_of(program)),
                   text(count_text(program, "scratch_bytes")), text(occupancy_of(program)),
                   text(count_text(program, "instructions")), text(count_text(program, "branches")),
                   text(count_text(program, "loads_in_loops")), text(fused_of(program)),
                   badge(status) + text(reason.empty() ? reason : ": " + reason)});
    }
    return table.html();
}

/// "radv Mesa 22.3.6, Null hardware (RADV NAVI21); nvcc 13.0", each once.
std::string compilers_of(const ResultValue& programs)
{
    std::vector<std::string> names;
    for (const ResultValue& program : programs.items())
        if (const auto compiler = program.find("compiler"))
            if (std::ranges::find(names, compiler->line()) == names.end()) names.push_back(compiler->line());
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : "; ") + name;
    return all;
}

} // namespace

Section compiler_section(const ReportInput& input)
{
    Section section{"compilers", "Compilers", {}};
    Html tables;
    for (std::size_t file = 0; file < input.files.size(); ++file)
        if (const auto programs = input.files[file].section().find("programs"))
            tables += heading(with_letter(compilers_of(*programs), file, input.files.size())) + programs_of(*programs);
    section.is_empty = tables.empty();
    section.content = tables.empty() ? paragraph("None of these results is of 'tetrace inspect --out FILE.json', which "
                                                 "asks GPUs' compilers about every kernel.")
                                     : note(how_to_read_programs) + tables;
    return section;
}

} // namespace tetrace
