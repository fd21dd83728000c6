#include "bench/variants/kernel_text.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <regex>

namespace tetrace {

namespace {

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

bool is_name(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

int depth_change(char c)
{
    return c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
}

bool is_balanced(const std::string& text)
{
    int depth = 0;
    for (const char c : text)
        depth += depth_change(c);
    return depth == 0;
}

/// The place of a character outside all brackets, from `from` on; npos if there is none.
std::size_t find_at_top(const std::string& text, char wanted, std::size_t from = 0)
{
    int depth = 0;
    for (std::size_t i = from; i < text.size(); ++i) {
        if (depth == 0 && text[i] == wanted) return i;
        depth += depth_change(text[i]);
    }
    return std::string::npos;
}

/// Whether it can be moved, left out or evaluated again.
bool is_pure(const std::string& value)
{
    static const std::regex changing("[^=!<>]=[^=]|\\+\\+|--|atomic|barrier");
    return !std::regex_search(value, changing) && find_at_top(value, ',') == std::string::npos &&
           value.find('{') == std::string::npos;
}

/// Of a text that has no `if`.
std::optional<Statement> simple_statement(const std::string& text)
{
    static const std::regex declaration("((?:PRECISE )?)([A-Za-z]\\w*) ([a-z]\\w*) = (.*);"),
        assignment("([a-z]\\w*(?:\\.[a-z]\\w*)*) = (.*);"), returning("return (.*);");
    Statement statement;
    std::smatch found;
    if (std::regex_match(text, found, returning)) {
        statement.kind = Statement::Kind::returning;
        statement.value = found[1];
    } else if (std::regex_match(text, found, assignment)) {
        statement.kind = Statement::Kind::assignment;
        statement.target = found[1];
        statement.value = found[2];
    } else if (std::regex_match(text, found, declaration) && found[2] != "else") {
        statement.qualifier = found[1];
        statement.type = found[2];
        statement.target = found[3];
        statement.value = found[4];
    } else {
        return std::nullopt;
    }
    if (!is_pure(statement.value)) return std::nullopt;
    return statement;
}

std::optional<Statement> statement_of(const std::string& text)
{
    constexpr std::string_view conditional = "if (";
    if (!text.starts_with(conditional)) return simple_statement(text);
    const std::size_t end = find_at_top(text, ')', conditional.size());
    if (end == std::string::npos || end + 2 >= text.size()) return std::nullopt;
    auto statement = simple_statement(text.substr(end + 2));
    if (!statement || statement->kind == Statement::Kind::declaration) return std::nullopt;
    statement->condition = text.substr(conditional.size(), end - conditional.size());
    if (!is_pure(statement->condition)) return std::nullopt;
    return statement;
}

/// Reads the body of a function, line by line.
class BodyReader {
public:
    BodyReader(const std::vector<std::string>& lines, KernelFunction& function)
        : lines_(&lines), function_(&function), line_(function.open + 1)
    {
    }

    void read()
    {
        while (line_ < function_->close) {
            const std::string code = code_of_line((*lines_)[line_]);
            if (code.starts_with("else") && !function_->statements.empty())
                function_->statements.back().has_else = true;
            if (code == "for (;;) {") open_loop();
            if (code.empty() || code.starts_with('#') || code.starts_with('}') || code.ends_with('{'))
                ++line_;
            else
                take_statement();
        }
    }

private:
    /// The loop ends where a brace has its indentation.
    void open_loop()
    {
        const std::string& head = (*lines_)[line_];
        const std::string brace = head.substr(0, head.find_first_not_of(' ')) + "}";
        for (std::size_t line = line_; line < function_->close; ++line)
            if ((*lines_)[line] == brace) return function_->loops.push_back({line_, line});
    }

    void take_statement()
    {
        const std::size_t first = line_;
        std::string text;
        bool is_whole = false;
        while (line_ < function_->close && !is_whole) {
            const std::string code = code_of_line((*lines_)[line_]);
            if (code.starts_with('#')) return; // a statement in several forms
            ++line_;
            if (code.empty()) continue;
            text += (text.empty() ? "" : " ") + code;
            is_whole = code.ends_with('{') || code.ends_with('}') || (code.ends_with(';') && is_balanced(text));
        }
        if (text.ends_with('{')) return;
        auto statement = statement_of(text);
        if (!statement) return;
        statement->line = first;
        statement->lines = line_ - first;
        const std::string& line = (*lines_)[first];
        statement->indent = line.substr(0, line.find_first_not_of(' '));
        function_->statements.push_back(std::move(*statement));
    }

    const std::vector<std::string>* lines_;
    KernelFunction* function_;
    std::size_t line_;
};

/// Of a signature without its prefix: "uint exit_to(uint record)". False if it is none.
bool read_signature(const std::string& signature, KernelFunction& function)
{
    static const std::regex form("([A-Za-z]\\w*) ([a-z]\\w*)\\((.*)\\)"), plain("([A-Za-z]\\w*) ([a-z]\\w*)");
    std::smatch found;
    if (!std::regex_match(signature, found, form)) return false;
    function.type = found[1];
    function.name = found[2];
    const std::string parameters = found[3];
    for (std::size_t begin = 0; begin < parameters.size();) {
        const std::size_t end = std::min(parameters.find(", ", begin), parameters.size());
        const std::string one = parameters.substr(begin, end - begin);
        if (std::regex_match(one, found, plain) && std::ranges::any_of(found.str(1), [](unsigned char c) {
                return std::islower(c) != 0; // a macro may stand for anything
            }))
            function.parameters.push_back({found[1], found[2]});
        else
            function.has_plain_parameters = false;
        begin = end + 2;
    }
    return true;
}

/// The line of the brace that closes the one of a line; 0 if there is none before the next function, as there is where
/// conditions of the preprocessor open more braces than they close.
std::size_t end_of_block(const std::vector<std::string>& lines, std::size_t line)
{
    std::ptrdiff_t depth = 0;
    for (; line < lines.size() && !lines[line].starts_with("KERNEL_FN"); ++line) {
        const std::string code = code_of_line(lines[line]);
        if (code.starts_with('#')) continue;
        depth += std::ranges::count(code, '{') - std::ranges::count(code, '}');
        if (depth == 0) return lines[line] == "}" ? line : 0;
    }
    return 0;
}

/// The function that begins at a line; empty if none does.
std::optional<KernelFunction> function_at(const std::vector<std::string>& lines, std::size_t line)
{
    KernelFunction function;
    for (const char* const prefix : {"KERNEL_FN ", "RARE_FN "})
        if (lines[line].starts_with(prefix)) function.prefix = prefix;
    if (function.prefix.empty()) return std::nullopt;
    std::string signature = code_of_line(lines[line]).substr(function.prefix.size());
    function.signature = line;
    for (++line; line < lines.size() && lines[line] != "{"; ++line)
        signature += " " + code_of_line(lines[line]);
    function.open = line;
    function.close = end_of_block(lines, line);
    if (function.close == 0 || !read_signature(signature, function)) return std::nullopt;
    return function;
}

} // namespace

std::string code_of_line(const std::string& line)
{
    const std::string code = line.substr(0, line.find("//"));
    const std::size_t begin = code.find_first_not_of(' ');
    return begin == std::string::npos ? std::string() : code.substr(begin, code.find_last_not_of(' ') + 1 - begin);
}

std::string Statement::body() const
{
    if (kind == Kind::returning) return "return " + value + ";";
    return (kind == Kind::declaration ? qualifier + type + " " : std::string()) + target + " = " + value + ";";
}

KernelText read_kernel_text(const std::string& text)
{
    KernelText read{lines_of(text), {}};
    bool is_dialect = true;
    for (std::size_t line = 0; line < read.lines.size(); ++line) {
        if (read.lines[line].starts_with("STRUCT(")) is_dialect = false;
        auto function = is_dialect ? std::nullopt : function_at(read.lines, line);
        if (!function) continue;
        BodyReader(read.lines, *function).read();
        line = function->close;
        read.functions.push_back(std::move(*function));
    }
    return read;
}

Choice choice_of(const std::string& expression)
{
    const std::size_t question = find_at_top(expression, '?');
    if (question == std::string::npos) return {};
    int open = 0; // choices within the first value
    for (std::size_t i = question + 1; i < expression.size(); ++i) {
        const std::size_t next = std::min(find_at_top(expression, '?', i), find_at_top(expression, ':', i));
        if (next == std::string::npos) return {};
        i = next;
        open += expression[i] == '?' ? 1 : -1;
        if (open < 0)
            return {expression.substr(0, question - 1), expression.substr(question + 2, i - question - 3),
                    expression.substr(i + 2)};
    }
    return {};
}

bool mentions(const std::string& text, const std::string& name)
{
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
        const bool begins = at == 0 || (!is_name(text[at - 1]) && text[at - 1] != '.');
        const std::size_t end = at + name.size();
        if (begins && (end == text.size() || !is_name(text[end]))) return true;
    }
    return false;
}

} // namespace tetrace
