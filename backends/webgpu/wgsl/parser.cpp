#include "backends/webgpu/wgsl/parser.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace::wgsl {

namespace {

/// C's binary operators, those that bind least first.
const std::vector<std::vector<std::string>>& precedence()
{
    static const std::vector<std::vector<std::string>> levels = {
        {"||"},       {"&&"},     {"|"},          {"^"}, {"&"}, {"==", "!="}, {"<", ">", "<=", ">="},
        {"<<", ">>"}, {"+", "-"}, {"*", "/", "%"}};
    return levels;
}

bool is_uint(const std::string& number)
{
    return number.back() == 'u' && number.find('.') == std::string::npos;
}

/// 1.5f, 3.0e38f.
bool is_real(const std::string& number)
{
    return number.back() == 'f' && number.find('.') != std::string::npos &&
           number.find_first_not_of("0123456789.e-+f") == std::string::npos;
}

} // namespace

bool Declarations::is_type(const std::string& name) const
{
    return name == "real" || name == "uint" || name == "uint4" || name == "bool" || name == "void" ||
           structs.contains(name);
}

std::string Parser::take()
{
    const std::string text = peek().text;
    if (!is_end()) ++at_;
    return text;
}

void Parser::expect(const char* text)
{
    if (!accept(text)) fail(fmt::format("'{}' is expected instead of '{}'", text, peek().text));
}

bool Parser::accept(const char* text)
{
    if (!is_next(text)) return false;
    ++at_;
    return true;
}

std::string Parser::name()
{
    if (peek().kind != TokenKind::name) fail("a name is expected instead of '" + peek().text + "'");
    return take();
}

Type Parser::type()
{
    if (!declared_.is_type(peek().text)) fail("'" + peek().text + "' is not a type of the kernels' language");
    return {take()};
}

void Parser::fail(const std::string& why) const
{
    throw TranslationError(fmt::format("{}:{}: {}", peek().file, peek().line, why));
}

const Local* Parser::find_local(const std::string& name) const
{
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
        if (const auto found = scope->find(name); found != scope->end()) return &found->second;
    return nullptr;
}

Expression Parser::expression(bool precise)
{
    Expression value = binary_expression(0, precise);
    if (precise) value = kept(value);
    return accept("?") ? choice(value, precise) : value;
}

Expression Parser::combined(const std::string& symbol, const Expression& left, const Expression& right,
                            bool precise) const
{
    try {
        return binary(symbol, left, right, precise);
    } catch (const std::invalid_argument& error) {
        fail(error.what());
    }
}

Expression Parser::choice(const Expression& condition, bool precise)
{
    if (condition.type != Type{"bool"}) fail("the condition of ? is a " + condition.type.name);
    const Expression yes = expression(precise);
    expect(":");
    const Expression no = expression(precise);
    if (yes.type != no.type) fail("? chooses a " + yes.type.name + " or a " + no.type.name);
    std::string function = "select";
    if (declared_.structs.contains(yes.type.name)) {
        declared_.selected_structs.insert(yes.type.name);
        function += "_" + yes.type.name;
    }
    return {function + "(" + no.text + ", " + yes.text + ", " + condition.text + ")",
            yes.type,
            true,
            condition.is_long || yes.is_long || no.is_long,
            false,
            std::make_shared<Choice>(Choice{condition, yes, no})};
}

Expression Parser::binary_expression(std::size_t level, bool precise)
{
    if (level == precedence().size()) return unary(precise);
    Expression left = binary_expression(level + 1, precise);
    while (peek().kind == TokenKind::symbol && std::ranges::count(precedence()[level], peek().text) != 0) {
        const std::string symbol = take();
        const Expression right = binary_expression(level + 1, precise);
        left = combined(symbol, left, right, precise);
    }
    return left;
}

Expression Parser::unary(bool precise)
{
    for (const auto& [symbol, accepted] : {std::pair("-", "real"), std::pair("!", "bool"), std::pair("~", "uint")})
        if (accept(symbol)) {
            Expression value = unary(precise);
            if (value.type != Type{accepted}) fail(fmt::format("operator {} has a {}", symbol, value.type.name));
            value.text = fmt::format("{}{}", symbol, value.operand());
            value.is_atom = false;
            value.choice = nullptr;
            return value;
        }
    return with_selections(primary(precise));
}

Expression Parser::place()
{
    return with_selections(named());
}

Expression Parser::with_selections(Expression value)
{
    for (;;) {
        if (accept("."))
            value = member_of(value);
        else if (accept("["))
            value = element_of(value);
        else
            return value;
    }
}

Expression Parser::primary(bool precise)
{
    if (accept("(")) {
        Expression value = binary_expression(0, precise);
        if (accept("?")) value = choice(precise ? kept(value) : value, precise);
        expect(")");
        value.text = value.operand();
        value.is_atom = true;
        return value;
    }
    if (peek().kind == TokenKind::number) {
        if (!is_uint(peek().text) && !is_real(peek().text))
            fail("'" + peek().text + "' is neither a uint (1u) nor a real (1.0f)");
        const std::string text = take();
        return {text, {text.back() == 'u' ? "uint" : "real"}, true, false, false, nullptr};
    }
    if (is_next("true") || is_next("false")) return {take(), {"bool"}, true, false, false, nullptr};
    if (peek().kind == TokenKind::name && peek(1).text == "(") {
        const std::string function = take();
        return call(function, precise);
    }
    return named();
}

Expression Parser::named()
{
    const std::string word = name();
    if (const Local* const local = find_local(word)) return {wgsl_name(word), local->type, true, false, false, nullptr};
    const auto buffer = declared_.buffers.find(word);
    if (buffer == declared_.buffers.end()) fail("'" + word + "' is not declared");
    return {wgsl_name(word), buffer->second, true, false, false, nullptr};
}

Expression Parser::call(const std::string& function, bool precise)
{
    expect("(");
    std::vector<Expression> arguments;
    while (!accept(")")) {
        if (!arguments.empty()) expect(",");
        arguments.push_back(expression(precise));
    }
    std::string text;
    bool is_long = false;
    for (const Expression& argument : arguments) {
        text += (text.empty() ? "" : ", ") + argument.text;
        is_long = is_long || argument.is_long;
    }
    // Only numbers are written so; what converts has a name of its own.
    if (function == "real" && arguments.size() == 1 && arguments[0].type == Type{"real"})
        return {text, {"real"}, is_real(text) && text.front() != '-', is_long, arguments[0].is_rounded, nullptr};
    std::vector<Type> parameters;
    Type result = {function};
    if (const auto found = declared_.structs.find(function); found != declared_.structs.end()) {
        for (const auto& member : found->second)
            parameters.push_back(member.second);
    } else if (const auto known = declared_.functions.find(function); known != declared_.functions.end()) {
        parameters = known->second.parameters;
        result = known->second.result;
        is_long = is_long || known->second.has_body;
    } else if (function == "uint4") {
        parameters.assign(4, {"uint"});
    } else {
        fail("'" + function + "' is not a function");
    }
    const bool fits = std::ranges::equal(parameters, arguments, {}, {}, &Expression::type);
    if (!fits) fail("the arguments of '" + function + "' are not those that it takes");
    return {wgsl_type(function) + "(" + text + ")", result, true, is_long, false, nullptr};
}

Expression Parser::member_of(const Expression& value)
{
    const std::string member = name();
    if (value.type == Type{"uint4"} && member.size() == 1 && std::string("xyzw").find(member) != std::string::npos)
        return {value.text + "." + member, {"uint"}, true, value.is_long, false, nullptr};
    const auto found = declared_.structs.find(value.type.name);
    if (found != declared_.structs.end() && !value.type.is_array)
        for (const auto& [known, type] : found->second)
            if (known == member)
                return {value.text + "." + wgsl_name(member), type, true, value.is_long, false, nullptr};
    fail("a " + value.type.name + " has no member '" + member + "'");
}

Expression Parser::element_of(const Expression& value)
{
    if (!value.type.is_array) fail("'" + value.text + "' is no array");
    const Expression index = expression(false);
    if (index.type != Type{"uint"}) fail("an index is a " + index.type.name);
    expect("]");
    return {value.text + "[" + index.text + "]", {value.type.name}, true, true, false, nullptr};
}

} // namespace tetrace::wgsl
