#include "bench/report/sections.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_programs =
    "Each entry point of a kernel, compiled for a GPU that need not be here, or by a driver of the machine; nothing "
    "was run. Occupancy: the subgroups resident on a multiprocessor of the GPU, relative to an empty kernel (AMD) or "
    "to the maximum (NVIDIA). Latency and cycles per subgroup: estimates by AMD's compiler of one pass through all "
    "instructions, "
    "and of how often one can begin. Fused: floating-point operations that multiply and add with one rounding, with "
    "the first of them. In exact mode none may decide a sign; those in box tests of BVHs decide nothing.";

std::string count_text(const ResultValue& program, const char* key)
{
    const auto value = program.find(key);
    return value ? with_commas(value->count()) : std::string();
}

std::string cycles_text(const ResultValue& program, const char* key)
{
    const auto value = program.find(key);
    return value ? with_commas(static_cast<std::uint64_t>(std::llround(std::max(0.0, value->number()))))
                 : std::string();
}

std::string occupancy_of(const ResultValue& program)
{
    const auto held = program.find("subgroups"), max = program.find("most_subgroups");
    if (!held || !max || max->count() == 0) return {};
    return fmt::format("{:.0f}", 100.0 * static_cast<double>(held->count()) / static_cast<double>(max->count()));
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

/// How many and where; below it, in small letters, the first.
Html fused_of(const ResultValue& program)
{
    const auto in = program.find("fused_in");
    if (!in) return {};
    const std::string where = in->line();
    if (where == "nothing") return text("none");
    const auto first = program.find("first_fused");
    return text(fmt::format("{} in {}", count_text(program, "fused"), where)) +
           (first ? text_element("small", "", first->line()) : Html());
}

std::string entry_of(const ResultValue& program)
{
    const std::string entry = program.at("entry").line(), schedule = program.at("schedule").line();
    return schedule == "tiles" ? entry : entry + " " + schedule;
}

/// Whether a sentence of "skipped_targets", "sm_90: no nvcc", is about the program's target.
bool is_told(const std::vector<std::string>& skipped, const ResultValue& program)
{
    const std::string begin = program.at("target").line() + ": ";
    return std::ranges::any_of(skipped, [&](const std::string& sentence) { return sentence.starts_with(begin); });
}

/// Programs of skipped targets are left out.
Html programs_of(const ResultValue& programs, const std::vector<std::string>& skipped)
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
                     {"latency", "cycles", true},
                     {"per subgroup", "cycles", true},
                     {"fused"},
                     {"status"}});
    for (const ResultValue& program : programs.items()) {
        if (is_told(skipped, program)) continue;
        const std::string reason = program.text_at("reason"), status = program.at("status").line();
        const std::string kernel = program.at("method").line() + " " + program.at("layout").line() +
                                   (program.at("math").line() == "fast" ? " fast" : "");
        table.add({text(program.at("target").line()), text(kernel), text(entry_of(program)),
                   text(count_text(program, "registers")), text(spills_of(program)),
                   text(count_text(program, "scratch_bytes")), text(occupancy_of(program)),
                   text(count_text(program, "instructions")), text(count_text(program, "branches")),
                   text(count_text(program, "loads_in_loops")), text(cycles_text(program, "latency_cycles")),
                   text(cycles_text(program, "cycles_a_subgroup")), fused_of(program),
                   badge(status) + text(reason.empty() ? reason : ": " + reason)});
    }
    return table.html();
}

/// Why targets were skipped, a sentence each.
std::vector<std::string> skipped_of(const ResultFile& file)
{
    std::vector<std::string> sentences;
    if (const auto skipped = file.section().find("skipped_targets"))
        for (const ResultValue& sentence : skipped->items())
            sentences.push_back(sentence.line());
    return sentences;
}

Html skipped_list(const std::vector<std::string>& skipped)
{
    Html items;
    for (const std::string& sentence : skipped)
        items += text_element("li", "", "skipped: " + sentence);
    return items.empty() ? items : element("ul", {{"class", "missing"}}, items);
}

/// "radv Mesa 22.3.6, Null hardware (RADV NAVI21); nvcc 13.0", each once.
std::string compilers_of(const ResultValue& programs)
{
    std::vector<std::string> names;
    for (const ResultValue& program : programs.items())
        if (const auto compiler = program.find("compiler"))
            if (std::ranges::find(names, compiler->line()) == names.end()) names.push_back(compiler->line());
    return names.empty() ? "no compiler" : fmt::format("{}", fmt::join(names, "; "));
}

} // namespace

Section compiler_section(const ReportInput& input)
{
    Section section{"compilers", "Compilers", {}};
    Html tables;
    for (std::size_t file = 0; file < input.files.size(); ++file)
        if (const auto programs = input.files[file].section().find("programs")) {
            const auto skipped = skipped_of(input.files[file]);
            tables += heading(with_letter(compilers_of(*programs), file, input.files.size())) + skipped_list(skipped) +
                      programs_of(*programs, skipped);
        }
    if (!tables.empty()) section.content = note(how_to_read_programs) + tables;
    return section;
}

} // namespace tetrace
