#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tetrace {

/// A statement that a change may have to do with: a value that is declared, assigned or returned, perhaps after an
/// `if (condition)` without braces. Its expressions have no side effects.
struct Statement {
    enum class Kind { declaration, assignment, returning };
    Kind kind = Kind::declaration;
    std::size_t line = 0, lines = 1; ///< in KernelText::lines
    std::string indent, condition;   ///< condition: empty if there is none
    std::string qualifier, type;     ///< of a declaration; qualifier: "PRECISE " or empty
    std::string target;              ///< a name, or of an assignment a path of names: "next.exit"
    std::string value;
    bool has_else = false; ///< an `else` follows

    /// "next.exit = exit;", without its condition.
    [[nodiscard]] std::string body() const;
};

/// Where a loop without a head, `for (;;) {`, begins and ends.
struct EndlessLoop {
    std::size_t open = 0, close = 0;
};

struct Parameter {
    std::string type, name;
};

/// A function of a kernel.
struct KernelFunction {
    std::string prefix, type, name; ///< prefix: KERNEL_FN or RARE_FN
    std::vector<Parameter> parameters;
    bool has_plain_parameters = true;               ///< each a type and a name
    std::size_t signature = 0, open = 0, close = 0; ///< lines: of its first word, and of its braces
    std::vector<Statement> statements;              ///< those that are understood, in their order
    std::vector<EndlessLoop> loops;
};

/// A kernel's text as clang-format leaves it, with its includes resolved: functions begin in the first column, and a
/// statement begins on a line of its own.
struct KernelText {
    std::vector<std::string> lines;
    std::vector<KernelFunction> functions; ///< without those of the dialect, which come before the first struct
};

[[nodiscard]] KernelText read_kernel_text(const std::string& text);

/// A line without its comment, and without blanks at either end.
[[nodiscard]] std::string code_of_line(const std::string& line);

/// `a ? b : c`, at the top of an expression.
struct Choice {
    std::string condition, yes, no; ///< empty if the expression is none
};
[[nodiscard]] Choice choice_of(const std::string& expression);

/// Whether an expression or a path has this name in it.
[[nodiscard]] bool mentions(const std::string& text, const std::string& name);

} // namespace tetrace
