#include "bench/inspection/machine_code.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <vector>

namespace tetrace {

namespace {

/// A line of code: a label, or an instruction with the label that it may go to.
struct CodeLine {
    std::string label;
    std::string text;
    std::string goes_to;
};

/// How one language marks the kind of an instruction.
struct Language {
    bool (*is_load)(const std::string& text);
    bool (*is_fused)(const std::string& text);
};

constexpr std::string_view blanks = " \t\r";

std::string trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

std::vector<std::string> words_of(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}

bool has(std::string_view text, std::string_view part)
{
    return text.find(part) != std::string_view::npos;
}

/// Lines that some backward branch leads back to.
std::vector<bool> lines_in_loops(const std::vector<CodeLine>& lines)
{
    std::map<std::string, std::size_t> labels;
    std::vector<bool> looped(lines.size(), false);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].label.empty()) labels[lines[i].label] = i;
        if (const auto back = labels.find(lines[i].goes_to); back != labels.end())
            std::fill(looped.begin() + static_cast<std::ptrdiff_t>(back->second),
                      looped.begin() + static_cast<std::ptrdiff_t>(i) + 1, true);
    }
    return looped;
}

CodeFigures figures_of(const std::vector<CodeLine>& lines, const Language& language)
{
    const std::vector<bool> looped = lines_in_loops(lines);
    CodeFigures figures;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string& text = lines[i].text;
        if (text.empty()) continue;
        ++figures.instructions;
        if (!lines[i].goes_to.empty()) ++figures.branches;
        if (language.is_load(text)) {
            ++figures.loads;
            if (looped[i]) ++figures.loads_in_loops;
        }
        if (!language.is_fused(text)) continue;
        if (figures.fused++ == 0) figures.first_fused = text;
    }
    return figures;
}

bool is_amd_load(const std::string& text)
{
    const std::string name = text.substr(0, text.find_first_of(" \t"));
    return has(name, "_load") && !name.starts_with("s_") && !name.starts_with("scratch_") && !name.starts_with("ds_");
}

/// Also the second half of an instruction that does two things (v_dual_...), and ACO's own form, in which the name
/// follows an assignment.
bool is_amd_fused(const std::string& text)
{
    return std::ranges::any_of(words_of(text), [](const std::string& word) {
        const bool is_instruction = word.starts_with("v_") || word.starts_with("s_");
        const bool is_float = has(word, "_f16") || has(word, "_f32") || has(word, "_f64");
        return is_instruction && is_float && (has(word, "_fma") || has(word, "_dot2")) && !has(word, "div_fmas");
    });
}

/// The entry's lines: from the line that names it to the closing brace.
std::vector<std::string> ptx_lines(std::string_view text, const std::string& entry)
{
    std::istringstream stream{std::string(text)};
    std::vector<std::string> lines;
    bool inside = false;
    for (std::string line; std::getline(stream, line);) {
        const bool begins = has(line, ".entry ") || has(line, ".func ");
        // A function that was not inlined may be called by any entry.
        if (begins) inside = has(line, ".func ") || words_of(line).back().starts_with(entry + "(");
        if (inside) lines.push_back(trimmed(line));
        if (line.starts_with("}")) inside = false;
    }
    return lines;
}

/// "@%p1 bra $L__BB0_2;" without what it depends on.
std::string without_predicate(const std::string& text)
{
    return text.starts_with("@") ? trimmed(text.substr(std::min(text.size(), text.find(' ')))) : text;
}

CodeLine ptx_line(const std::string& text)
{
    if (text.starts_with("$") && text.ends_with(":")) return {text.substr(0, text.size() - 1), {}, {}};
    if (!text.ends_with(";") || text.starts_with(".")) return {};
    const std::string instruction = without_predicate(text);
    CodeLine line{{}, instruction, {}};
    if (instruction.starts_with("bra")) {
        line.goes_to = words_of(instruction).back();
        line.goes_to.pop_back();
    }
    return line;
}

bool is_ptx_load(const std::string& text)
{
    return text.starts_with("ld.global");
}

std::string name_of_ptx(const std::string& text)
{
    return text.substr(0, text.find_first_of(" \t"));
}

bool is_float_ptx(const std::string& name)
{
    return has(name, ".f32") || has(name, ".f64") || has(name, ".f16");
}

/// Whether ptxas may make it a part of a fused operation.
bool is_ptx_unrounded(const std::string& text)
{
    const std::string name = name_of_ptx(text);
    if (!is_float_ptx(name)) return false;
    const bool can_be_fused = name.starts_with("add.") || name.starts_with("sub.") || name.starts_with("mul.");
    constexpr std::array roundings = {".rn", ".rz", ".rm", ".rp"};
    return can_be_fused && std::ranges::none_of(roundings, [&](const char* rounding) { return has(name, rounding); });
}

bool is_ptx_fused(const std::string& text)
{
    const std::string name = name_of_ptx(text);
    const bool is_one = is_float_ptx(name) && (name.starts_with("fma.") || name.starts_with("mad."));
    return is_one || is_ptx_unrounded(text);
}

bool is_ptx_division(const std::string& text)
{
    const std::string name = name_of_ptx(text);
    return has(name, ".f32") && (name.starts_with("div.") || name.starts_with("sqrt.") || name.starts_with("rcp."));
}

bool is_sass_load(const std::string& text)
{
    return text.starts_with("LDG") || text.starts_with("LD.");
}

bool is_sass_fused(const std::string& text)
{
    return text.starts_with("FFMA") || text.starts_with("DFMA");
}

/// "        /*0010*/              @!P0 BRA `(.L_x_2) ;"
CodeLine sass_line(const std::string& text)
{
    if (text.starts_with(".L_") && text.ends_with(":")) return {text.substr(0, text.size() - 1), {}, {}};
    const std::size_t address_end = text.find("*/");
    if (!text.starts_with("/*") || address_end == std::string::npos || !has(text, ";")) return {};
    const std::string instruction =
        without_predicate(trimmed(text.substr(address_end + 2, text.find(';') - address_end - 2)));
    CodeLine line{{}, instruction, {}};
    const std::size_t target = instruction.find("`(");
    if (instruction.starts_with("BRA") && target != std::string::npos)
        line.goes_to = instruction.substr(target + 2, instruction.find(')') - target - 2);
    return line;
}

} // namespace

CodeFigures read_amd(std::string_view text)
{
    std::istringstream stream{std::string(text)};
    std::vector<CodeLine> lines;
    for (std::string raw; std::getline(stream, raw);) {
        const std::string line = trimmed(std::string_view(raw).substr(0, raw.find(';')));
        if (line.empty()) continue;
        const bool is_label = line.starts_with("BB") || line.starts_with(".LBB");
        if (is_label && line.ends_with(":")) {
            lines.push_back({line.substr(0, line.size() - 1), {}, {}});
            continue;
        }
        const auto words = words_of(line);
        const bool branches = words.front().starts_with("s_branch") || words.front().starts_with("s_cbranch");
        lines.push_back({{}, line, branches ? words.back() : std::string()});
    }
    return figures_of(lines, {is_amd_load, is_amd_fused});
}

CodeFigures read_hip(std::string_view text, const std::string& entry)
{
    std::istringstream stream{std::string(text)};
    std::string code, halves; // of instructions that do two things
    std::uint64_t divisions = 0;
    bool inside = false;
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with(entry + ":")) inside = true;
        if (line.starts_with(".Lfunc_end")) inside = false;
        const std::string instruction = trimmed(line);
        if (!inside || (instruction.starts_with(".") && !instruction.starts_with(".LBB"))) continue;
        if (line.starts_with(entry)) continue;
        code += line + "\n";
        halves += line.substr(0, line.find("::")) + "\n";
        if (has(line, "::")) halves += line.substr(line.find("::") + 2) + "\n";
        if (instruction.starts_with("v_div_fmas_f32")) ++divisions;
    }
    CodeFigures figures = read_amd(code);
    figures.fused = read_amd(halves).fused;
    figures.divisions = divisions;
    constexpr std::uint64_t fused_of_division = 5;
    if (figures.fused >= fused_of_division * divisions) figures.fused -= fused_of_division * divisions;
    if (figures.fused == 0 || divisions > 0) figures.first_fused.clear(); // the first is perhaps a division's
    return figures;
}

CodeFigures read_ptx(std::string_view text, const std::string& entry)
{
    std::vector<CodeLine> lines;
    std::uint64_t divisions = 0, unrounded = 0;
    for (const std::string& line : ptx_lines(text, entry)) {
        lines.push_back(ptx_line(line));
        if (is_ptx_division(lines.back().text)) ++divisions;
        if (is_ptx_unrounded(lines.back().text)) ++unrounded;
    }
    CodeFigures figures = figures_of(lines, {is_ptx_load, is_ptx_fused});
    figures.instructions = 0;
    figures.branches = 0;
    figures.divisions = divisions;
    figures.unrounded = unrounded;
    return figures;
}

CodeFigures read_sass(std::string_view text, const std::string& entry)
{
    std::istringstream stream{std::string(text)};
    std::vector<CodeLine> lines;
    bool inside = false;
    for (std::string raw; std::getline(stream, raw);) {
        const std::string line = trimmed(raw);
        if (line.starts_with(".text.") && line.ends_with(":")) inside = line == ".text." + entry + ":";
        if (line.starts_with("//---")) inside = false;
        if (inside) lines.push_back(sass_line(line));
    }
    return figures_of(lines, {is_sass_load, is_sass_fused});
}

} // namespace tetrace
