#include "backends/webgpu/wgsl/translator.h"

#include "backends/webgpu/wgsl/parser.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace tetrace::wgsl {

namespace {

bool is_assignment(const std::string& symbol)
{
    return symbol == "=" || (symbol.size() > 1 && symbol.back() == '=' && symbol != "==" && symbol != "!=" &&
                             symbol != "<=" && symbol != ">=");
}

std::string padding(int depth)
{
    return std::string(static_cast<std::size_t>(depth) * 4, ' ');
}

class Translator : public Parser {
public:
    using Parser::Parser;

    std::string text()
    {
        while (!is_end()) {
            if (accept(";")) continue;
            if (accept("struct"))
                declare_struct();
            else if (accept("storage"))
                declare_buffer("read");
            else if (accept("storage_written"))
                declare_buffer("read_write");
            else
                declare_function();
        }
        for (const std::string& name : declared_.selected_structs) {
            const std::string type = wgsl_type(name);
            out_ += "fn select_" + name + "(no: " + type + ", yes: " + type + ", is_yes: bool) -> " + type +
                    " {\n    if (is_yes) {\n        return yes;\n    }\n    return no;\n}\n";
        }
        return out_;
    }

private:
    void declare_struct()
    {
        const std::string struct_name = name();
        expect("{");
        Declarations::Members members;
        out_ += fmt::format("struct {} {{\n", wgsl_name(struct_name));
        while (!accept("}")) {
            const Type member_type = type();
            const std::string member = name();
            expect(";");
            out_ += fmt::format("    {}: {},\n", wgsl_name(member), wgsl_type(member_type.name));
            members.emplace_back(member, member_type);
        }
        declared_.structs[struct_name] = members;
        out_ += "}\n";
    }

    /// storage(2) uint lines[]; or, of one value, storage(8) LaunchWords launch_words;
    void declare_buffer(const std::string& access)
    {
        expect("(");
        const std::string binding = peek(1).text == ")" ? take() : expression(false).text;
        expect(")");
        Type element = type();
        const std::string buffer = name();
        if (accept("[")) {
            expect("]");
            element.is_array = true;
        }
        expect(";");
        declared_.buffers[buffer] = element;
        const std::string value = wgsl_type(element.name);
        out_ += "@group(0) @binding(" + binding + ") var<storage, " + access + "> " + wgsl_name(buffer) + ": " +
                (element.is_array ? "array<" + value + ">" : value) + ";\n";
    }

    void declare_function()
    {
        const Type result = type();
        const std::string function = name();
        expect("(");
        std::vector<std::pair<std::string, Type>> parameters;
        while (!accept(")")) {
            if (!parameters.empty()) expect(",");
            const Type parameter = type();
            parameters.emplace_back(peek().kind == TokenKind::name ? name() : std::string(), parameter);
        }
        auto& declared = declared_.functions[function];
        declared.result = result;
        declared.parameters.clear();
        for (const auto& parameter : parameters)
            declared.parameters.push_back(parameter.second);
        if (accept(";")) return;
        declared.has_body = true;
        result_ = result;
        define_function(function, parameters);
    }

    /// WGSL's parameters cannot be assigned to; those that are get a copy.
    void define_function(const std::string& function, const std::vector<std::pair<std::string, Type>>& parameters)
    {
        scopes_ = {{}};
        std::string list, copies;
        for (const auto& [parameter, parameter_type] : parameters) {
            scopes_.back()[parameter] = {parameter_type, false};
            const std::string local = wgsl_name(parameter), type = wgsl_type(parameter_type.name);
            const bool assigned = is_assigned_in_body(parameter);
            list += (list.empty() ? "" : ", ") + local + (assigned ? "_in" : "") + ": " + type;
            if (assigned) copies += "    var " + local + ": " + type + " = " + local + "_in;\n";
        }
        const std::string result = result_ == Type{"void"} ? "" : fmt::format(" -> {}", wgsl_type(result_.name));
        const std::string body = block(1);
        out_ += fmt::format("fn {}({}){} {{\n{}{}}}\n", wgsl_name(function), list, result, copies, body);
    }

    [[nodiscard]] bool is_assigned_in_body(const std::string& parameter) const
    {
        int depth = 0;
        for (std::size_t at = position(); token(at).kind != TokenKind::end; ++at) {
            const std::string& text = token(at).text;
            depth += text == "{" ? 1 : text == "}" ? -1 : 0;
            if (depth == 0) return false;
            if (text != parameter || token(at - 1).text == ".") continue;
            std::size_t behind = at + 1;
            while (token(behind).text == ".")
                behind += 2;
            const std::string &before = token(at - 1).text, &after = token(behind).text;
            if (before == "++" || before == "--" || after == "++" || after == "--" || is_assignment(after)) return true;
        }
        return false;
    }

    std::string block(int depth)
    {
        expect("{");
        scopes_.emplace_back();
        std::string text;
        while (!accept("}")) {
            if (is_end()) fail("a block has no end");
            text += statement(depth);
        }
        scopes_.pop_back();
        return text;
    }

    /// A block, or one statement as the content of a block.
    std::string body(int depth)
    {
        if (is_next("{")) return block(depth);
        scopes_.emplace_back();
        std::string text = statement(depth);
        scopes_.pop_back();
        return text;
    }

    std::string statement(int depth)
    {
        const std::string pad = padding(depth);
        if (accept(";")) return {};
        if (is_next("{")) return pad + "{\n" + block(depth + 1) + pad + "}\n";
        if (accept("if")) return if_statement(depth);
        if (accept("for")) return for_statement(depth);
        if (accept("while")) {
            const std::string condition = condition_in_parentheses();
            return pad + "while (" + condition + ") {\n" + body(depth + 1) + pad + "}\n";
        }
        if (accept("do")) return do_statement(depth);
        for (const char* const word : {"break", "continue"})
            if (accept(word)) {
                expect(";");
                return pad + word + ";\n";
            }
        if (accept("return")) return return_statement(depth);
        for (const char* const word : {"switch", "goto", "struct", "static"})
            if (is_next(word)) fail(fmt::format("'{}' is not in the kernels' language", word));
        std::string text = simple_statement(depth);
        expect(";");
        return text;
    }

    std::string return_statement(int depth)
    {
        if (accept(";")) return padding(depth) + "return;\n";
        const Expression value = expression(false);
        expect(";");
        if (value.type != result_) fail("a " + value.type.name + " is returned as a " + result_.name);
        return given_to("return ", value, depth);
    }

    std::string condition_in_parentheses()
    {
        expect("(");
        const Expression condition = expression(false);
        if (condition.type != Type{"bool"}) fail("a condition is a " + condition.type.name);
        expect(")");
        return condition.text;
    }

    std::string if_statement(int depth)
    {
        const std::string pad = padding(depth), condition = condition_in_parentheses();
        std::string text = pad + "if (" + condition + ") {\n" + body(depth + 1) + pad + "}";
        if (!accept("else")) return text + "\n";
        if (accept("if")) return text + " else " + if_statement(depth).substr(pad.size());
        return text + " else {\n" + body(depth + 1) + pad + "}\n";
    }

    /// continue goes to the condition, as in C.
    std::string do_statement(int depth)
    {
        const std::string pad = padding(depth), content = body(depth + 1);
        expect("while");
        const std::string condition = condition_in_parentheses();
        expect(";");
        return pad + "loop {\n" + content + pad + "    continuing {\n" + pad + "        break if !(" + condition +
               ");\n" + pad + "    }\n" + pad + "}\n";
    }

    std::string for_statement(int depth)
    {
        const std::string pad = padding(depth);
        expect("(");
        scopes_.emplace_back();
        const std::string first = is_next(";") ? "" : part_of_for();
        expect(";");
        const std::string condition = is_next(";") ? "" : expression(false).text;
        expect(";");
        const std::string step = is_next(")") ? "" : part_of_for();
        expect(")");
        const std::string content = body(depth + 1);
        scopes_.pop_back();
        if (first.empty() && condition.empty() && step.empty()) return pad + "while (true) {\n" + content + pad + "}\n";
        return pad + "for (" + first + "; " + condition + "; " + step + ") {\n" + content + pad + "}\n";
    }

    std::string part_of_for()
    {
        std::string text = simple_statement(0);
        if (std::ranges::count(text, '\n') != 1) fail("a part of for( ; ; ) is more than one statement");
        return text.substr(0, text.size() - 2); // without ";\n"
    }

    /// A declaration, an assignment or a call, without its semicolon.
    std::string simple_statement(int depth)
    {
        const bool precise = accept("precise");
        const bool constant = accept("const");
        if (precise || constant || (declared_.is_type(peek().text) && peek(1).kind == TokenKind::name))
            return declarations(depth, precise);
        for (const char* const step : {"++", "--"})
            if (accept(step)) return padding(depth) + counted(place(), step);
        if (peek().kind == TokenKind::name && peek(1).text == "(")
            return padding(depth) + expression(false).text + ";\n";
        const std::string local = peek().text;
        const Expression target = place();
        for (const char* const step : {"++", "--"})
            if (accept(step)) return padding(depth) + counted(target, step);
        if (!is_assignment(peek().text)) fail("'" + peek().text + "' begins no statement of the kernels' language");
        const Local* const found = find_local(local);
        return assignment(target, found != nullptr && found->is_precise, depth);
    }

    std::string counted(const Expression& target, const char* step)
    {
        if (target.type != Type{"uint"}) fail(std::string(step) + " has a " + target.type.name);
        return target.text + " " + step[0] + "= 1u;\n";
    }

    std::string assignment(const Expression& target, bool precise, int depth)
    {
        const std::string symbol = take();
        const Expression value = expression(precise);
        if (value.type != target.type && symbol != "<<=" && symbol != ">>=")
            fail("a " + value.type.name + " is assigned to a " + target.type.name);
        if (symbol == "=") return given_to(target.text + " = ", value, depth);
        const Expression sum = combined(symbol.substr(0, symbol.size() - 1), target, value, precise);
        return given_to(target.text + " = ", precise ? kept(sum) : sum, depth);
    }

    std::string declarations(int depth, bool precise)
    {
        const Type declared_type = type();
        std::string text;
        do
            text += declaration(declared_type, precise, depth);
        while (accept(","));
        return text;
    }

    std::string declaration(const Type& declared_type, bool precise, int depth)
    {
        const std::string local = name(), head = padding(depth) + "var " + wgsl_name(local) + ": ";
        const std::string type_text = wgsl_type(declared_type.name);
        if (accept("[")) {
            const Expression size = expression(false);
            expect("]");
            scopes_.back()[local] = {{declared_type.name, true}, false};
            return head + "array<" + type_text + ", " + size.text + ">;\n";
        }
        std::optional<Expression> value;
        if (accept("=")) value = expression(precise);
        scopes_.back()[local] = {declared_type, precise};
        if (!value) return head + type_text + ";\n";
        if (value->type != declared_type) fail("a " + value->type.name + " is assigned to a " + declared_type.name);
        if (!value->choice || !value->is_long) return head + type_text + " = " + value->text + ";\n";
        return head + type_text + ";\n" + given_to(wgsl_name(local) + " = ", *value, depth);
    }

    /// `left` value; of a choice with a long side only the chosen side is computed.
    std::string given_to(const std::string& left, const Expression& value, int depth)
    {
        const std::string pad = padding(depth);
        if (!value.choice || !value.is_long) return pad + left + value.text + ";\n";
        const Choice& choice = *value.choice;
        return pad + "if (" + choice.condition.text + ") {\n" + given_to(left, choice.yes, depth + 1) + pad +
               "} else {\n" + given_to(left, choice.no, depth + 1) + pad + "}\n";
    }

    Type result_;
    std::string out_;
};

} // namespace

std::string translate(std::string_view preprocessed)
{
    return Translator(tokens_of(preprocessed)).text();
}

} // namespace tetrace::wgsl
