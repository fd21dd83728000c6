#include "bench/variants/changes.h"

#include "bench/variants/kernel_text.h"
#include "core/base/error.h"
#include "core/base/random_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace tetrace {

namespace {

/// An integer of this function that only its caller knows; empty if it has none.
std::string unknown_word(const KernelFunction& function)
{
    static const std::map<std::string, const char*> words = {
        {"uint", "{}"},          {"SceneView", "{}.divisions"}, {"TraceParams", "{}.max_steps"}, {"Walker", "{}.steps"},
        {"real", "as_bits({})"}, {"Vec3", "as_bits({}.x)"},     {"Sheared", "as_bits({}.x)"}};
    for (const Parameter& parameter : function.parameters)
        if (const auto word = words.find(parameter.type); word != words.end())
            return fmt::format(fmt::runtime(word->second), parameter.name);
    return {};
}

/// Collects the changes of one function.
class FunctionChanges {
public:
    FunctionChanges(const KernelText& text, const KernelFunction& function, std::string name,
                    std::vector<Change>& changes)
        : text_(&text), function_(&function), name_(std::move(name)), changes_(&changes)
    {
        // The square of an odd number is 1 modulo 8: bit 2 of it is 0.
        if (const std::string word = unknown_word(function); !word.empty())
            zero_ = fmt::format("(({0} | 1u) * ({0} | 1u) & 4u)", word);
    }

    void collect()
    {
        for (number_ = 0; number_ < function_->statements.size(); ++number_)
            of_statement(function_->statements[number_]);
        for (number_ = 0; number_ < function_->loops.size(); ++number_)
            of_loop(function_->loops[number_]);
        if (function_->has_plain_parameters && !function_->parameters.empty() && function_->type != "void") in_struct();
    }

private:
    void add(const char* kind, std::vector<TextEdit> edits)
    {
        changes_->push_back({fmt::format("{}.{}/{}", name_, number_, kind), std::move(edits)});
    }

    void replace(const char* kind, const Statement& statement, const std::string& by)
    {
        add(kind, {{statement.line, statement.lines, statement.indent + by + "\n"}});
    }

    void of_statement(const Statement& statement)
    {
        add_zero(statement);
        make_branch(statement);
        make_select(statement);
        wrap(statement);
        add_dead_return(statement);
        if (number_ + 1 < function_->statements.size()) swap(statement, function_->statements[number_ + 1]);
    }

    void add_zero(const Statement& statement)
    {
        const bool is_integer = statement.kind == Statement::Kind::declaration
                                    ? statement.type == "uint" && statement.qualifier.empty()
                                    : statement.kind == Statement::Kind::returning && function_->type == "uint" &&
                                          statement.condition.empty();
        if (zero_.empty() || !is_integer) return;
        Statement changed = statement;
        changed.value = fmt::format("({}) + {}", statement.value, zero_);
        replace("zero", statement, changed.body());
    }

    void make_branch(const Statement& statement)
    {
        const Choice choice = choice_of(statement.value);
        if (choice.yes.empty() || !statement.condition.empty()) return;
        Statement yes = statement, no = statement;
        std::string declared;
        if (statement.kind == Statement::Kind::declaration) {
            declared =
                fmt::format("{}{} {};\n{}", statement.qualifier, statement.type, statement.target, statement.indent);
            yes.kind = no.kind = Statement::Kind::assignment;
        }
        yes.value = choice.yes;
        no.value = choice.no;
        replace("branch", statement,
                fmt::format("{0}if ({1}) {{\n{2}    {3}\n{2}}} else {{\n{2}    {4}\n{2}}}", declared, choice.condition,
                            statement.indent, yes.body(), no.body()));
    }

    /// What is selected must have a value if the condition is false.
    void make_select(const Statement& statement)
    {
        if (statement.condition.empty() || statement.has_else || statement.kind != Statement::Kind::assignment) return;
        const std::string& target = statement.target;
        const std::string root = target.substr(0, target.find('.'));
        const auto sets = [&](const Statement& earlier) {
            return earlier.line < statement.line && earlier.condition.empty() &&
                   earlier.indent.size() <= statement.indent.size() &&
                   (earlier.target == target || earlier.target == root);
        };
        const bool has_value =
            std::ranges::find(function_->parameters, root, &Parameter::name) != function_->parameters.end() ||
            std::ranges::any_of(function_->statements, sets);
        if (!has_value) return;
        Statement changed = statement;
        changed.value = fmt::format("({}) ? ({}) : {}", statement.condition, statement.value, target);
        replace("select", statement, changed.body());
    }

    void wrap(const Statement& statement)
    {
        if (statement.kind == Statement::Kind::declaration || statement.has_else) return;
        const std::string whole = statement.condition.empty()
                                      ? statement.body()
                                      : fmt::format("if ({}) {}", statement.condition, statement.body());
        const auto in = [&](const std::string& head, const std::string& tail) {
            return fmt::format("{0} {{\n{1}    {2}\n{1}}}{3}", head, statement.indent, whole, tail);
        };
        if (statement.kind == Statement::Kind::assignment || !statement.condition.empty())
            replace("once", statement, in("do", " while (false);"));
        if (zero_.empty() || statement.kind != Statement::Kind::assignment) return;
        replace("round", statement,
                in(fmt::format("for (uint variant_round = 0u; variant_round <= {}; variant_round++)", zero_), ""));
        replace("guard", statement, in(fmt::format("if ({} == 0u)", zero_), ""));
    }

    void add_dead_return(const Statement& statement)
    {
        static const std::map<std::string, const char*> values = {
            {"uint", "0u"}, {"bool", "false"}, {"real", "real(0.0f)"}};
        const auto value = values.find(function_->type);
        if (zero_.empty() || value == values.end()) return;
        add("dead",
            {{statement.line, 0, fmt::format("{}if ({} != 0u) return {};\n", statement.indent, zero_, value->second)}});
    }

    void swap(const Statement& first, const Statement& second)
    {
        if (first.line + first.lines != second.line || first.indent != second.indent || !is_movable(first) ||
            !is_movable(second) || depends(first, second) || depends(second, first))
            return;
        add("swap", {{first.line, first.lines + second.lines,
                      fmt::format("{0}{1}\n{0}{2}\n", first.indent, second.body(), first.body())}});
    }

    [[nodiscard]] static bool is_movable(const Statement& statement)
    {
        return statement.kind != Statement::Kind::returning && statement.condition.empty();
    }

    /// Whether a statement reads or writes what another one writes. Two members of a struct are apart.
    [[nodiscard]] static bool depends(const Statement& one, const Statement& other)
    {
        const std::string root = other.target.substr(0, other.target.find('.'));
        return mentions(one.value, root) || (one.target + ".").starts_with(other.target + ".");
    }

    void of_loop(const EndlessLoop& loop)
    {
        const std::string& head = text_->lines[loop.open];
        const std::string indent = head.substr(0, head.find_first_not_of(' '));
        add("once_loop", {{loop.open, 1, fmt::format("{0}do {{\n{1}\n", indent, head)},
                          {loop.close, 1, fmt::format("{0}}}\n{0}}} while (false);\n", indent)}});
        if (!zero_.empty())
            add("dead_break", {{loop.open, 1, fmt::format("{}\n{}    if ({} != 0u) break;\n", head, indent, zero_)}});
    }

    void in_struct()
    {
        const KernelFunction& function = *function_;
        std::string members, copies, given, parameters;
        for (const auto& [type, name] : function.parameters) {
            members += fmt::format("    {} of_{};\n", type, name); // in GLSL no member can be named "length"
            copies += fmt::format("    {0} {1} = variant_all.of_{1};\n", type, name);
            given += fmt::format("    variant_all.of_{0} = {0};\n", name);
            parameters += fmt::format("{}{} {}", parameters.empty() ? "" : ", ", type, name);
        }
        const std::string of = "variant_of_" + function.name;
        const std::string head = fmt::format("STRUCT({0}_all)\n{{\n{1}}};\n\n{2}{3} {0}({0}_all variant_all)\n", of,
                                             members, function.prefix, function.type);
        const std::string caller =
            fmt::format("}}\n\n{0}{1} {2}({3})\n{{\n    {4}_all variant_all;\n{5}    return {4}(variant_all);\n}}\n",
                        function.prefix, function.type, function.name, parameters, of, given);
        changes_->push_back({name_ + "/struct",
                             {{function.signature, function.open - function.signature, head},
                              {function.open, 1, "{\n" + copies},
                              {function.close, 1, caller}}});
    }

    const KernelText* text_;
    const KernelFunction* function_;
    std::string name_, zero_; ///< zero: an expression that is 0; empty: none is known
    std::vector<Change>* changes_;
    std::size_t number_ = 0;
};

/// The lines that a change needs as they are. An insertion needs the line that it is before.
std::set<std::size_t> touched(const Change& change)
{
    std::set<std::size_t> lines;
    for (const TextEdit& edit : change.edits)
        for (std::size_t i = 0; i < std::max<std::size_t>(edit.count, 1); ++i)
            lines.insert(edit.line + i);
    return lines;
}

/// Takes the lines of a change; false, and takes none, if another change has one of them.
bool take(const Change& change, std::set<std::size_t>& taken)
{
    const auto lines = touched(change);
    if (std::ranges::any_of(lines, [&](std::size_t line) { return taken.contains(line); })) return false;
    taken.insert(lines.begin(), lines.end());
    return true;
}

} // namespace

VariantText::VariantText(const std::string& text)
{
    KernelText read = read_kernel_text(text);
    std::map<std::string, int> seen; // a name may be defined again under another condition of the preprocessor
    for (const KernelFunction& function : read.functions) {
        const int before = seen[function.name]++;
        const std::string name = before == 0 ? function.name : fmt::format("{}~{}", function.name, before + 1);
        FunctionChanges(read, function, name, changes_).collect();
    }
    lines_ = std::move(read.lines);
}

std::vector<std::size_t> VariantText::choose(std::uint64_t seed, std::uint32_t number) const
{
    const auto words = [&](std::size_t place) {
        return random_words({static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), number,
                             static_cast<std::uint32_t>(place)},
                            0);
    };
    constexpr std::uint32_t of_64[] = {1, 4, 16, 64};
    const std::uint32_t chosen_of_64 = of_64[words(changes_.size())[0] % std::size(of_64)];
    std::vector<std::pair<std::uint32_t, std::size_t>> order;
    for (std::size_t i = 0; i < changes_.size(); ++i)
        if (const RandomWords drawn = words(i); drawn[0] % 64 < chosen_of_64) order.emplace_back(drawn[1], i);
    std::ranges::sort(order);
    std::set<std::size_t> taken;
    std::vector<std::size_t> chosen;
    for (const auto& [key, i] : order)
        if (take(changes_[i], taken)) chosen.push_back(i);
    std::ranges::sort(chosen);
    return chosen;
}

std::string VariantText::with(std::span<const std::size_t> changes) const
{
    std::map<std::size_t, const TextEdit*> edits; // by line
    for (const std::size_t change : changes)
        for (const TextEdit& edit : changes_[change].edits)
            edits[edit.line] = &edit;
    std::string text;
    for (std::size_t line = 0; line < lines_.size();) {
        const auto edit = edits.find(line);
        if (edit != edits.end()) text += edit->second->text;
        if (edit == edits.end() || edit->second->count == 0)
            text += lines_[line++] + "\n";
        else
            line += edit->second->count;
    }
    return text;
}

std::vector<std::size_t> VariantText::named(const std::vector<std::string>& names) const
{
    std::vector<std::size_t> found;
    std::set<std::size_t> taken;
    for (const std::string& name : names) {
        const auto change = std::ranges::find(changes_, name, &Change::name);
        if (change == changes_.end())
            throw Error(ErrorKind::usage, fmt::format("--variant: the kernel's text has no change '{}'; 'tetrace check "
                                                      "--variants' prints the names of those that matter",
                                                      name));
        if (!take(*change, taken))
            throw Error(ErrorKind::usage,
                        fmt::format("--variant: '{}' changes what another change of the list changes", name));
        found.push_back(static_cast<std::size_t>(change - changes_.begin()));
    }
    std::ranges::sort(found);
    return found;
}

} // namespace tetrace
