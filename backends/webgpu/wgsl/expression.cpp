#include "backends/webgpu/wgsl/expression.h"

#include <set>
#include <stdexcept>

namespace tetrace::wgsl {

namespace {

/// Keywords and reserved words of WGSL, W3C Candidate Recommendation, sections 16.1 and 16.2, that C++ leaves to names.
const std::set<std::string>& reserved_words()
{
    static const std::set<std::string> words = {
        "NULL",        "Self",     "abstract", "active",     "alias",    "as",           "asm_fragment",  "async",
        "attribute",   "await",    "become",   "cast",       "coherent", "column_major", "common",        "compile",
        "crate",       "debugger", "demote",   "diagnostic", "discard",  "enable",       "extends",       "external",
        "fallthrough", "filter",   "final",    "finally",    "fn",       "from",         "fxgroup",       "get",
        "groupshared", "highp",    "impl",     "implements", "import",   "instanceof",   "interface",     "layout",
        "let",         "loop",     "lowp",     "macro",      "match",    "mediump",      "meta",          "mod",
        "module",      "move",     "mut",      "nil",        "noinline", "noncoherent",  "noperspective", "null",
        "of",          "override", "package",  "packoffset", "partial",  "pass",         "patch",         "precision",
        "premerge",    "priv",     "pub",      "readonly",   "ref",      "regardless",   "require",       "requires",
        "resource",    "restrict", "self",     "set",        "shared",   "smooth",       "snorm",         "std",
        "subroutine",  "super",    "target",   "trait",      "type",     "unless",       "unorm",         "unsafe",
        "unsized",     "use",      "var",      "varying",    "wgsl",     "where",        "with",          "writeonly",
        "yield"};
    return words;
}

bool is_one_of(const std::string& symbol, std::initializer_list<const char*> symbols)
{
    for (const char* const each : symbols)
        if (symbol == each) return true;
    return false;
}

std::string result_type(const std::string& symbol, const Expression& left, const Expression& right)
{
    const std::string &a = left.type.name, &b = right.type.name;
    const bool is_logical = is_one_of(symbol, {"&&", "||"}), is_shift = is_one_of(symbol, {"<<", ">>"});
    const bool is_comparison = is_one_of(symbol, {"<", ">", "<=", ">="}), is_equality = is_one_of(symbol, {"==", "!="});
    const bool is_bitwise = is_one_of(symbol, {"&", "|", "^"}), is_arithmetic = is_one_of(symbol, {"+", "-", "*", "/"});
    const bool fits = a == b && (is_logical                       ? a == "bool"
                                 : is_shift || symbol == "%"      ? a == "uint"
                                 : is_comparison || is_arithmetic ? a == "uint" || a == "real"
                                 : is_bitwise                     ? a == "uint" || a == "bool"
                                              : is_equality && (a == "uint" || a == "real" || a == "bool"));
    if (!fits || left.type.is_array || right.type.is_array)
        throw std::invalid_argument("operator " + symbol + " has a " + a + " and a " + b);
    return is_logical || is_comparison || is_equality ? "bool" : a;
}

} // namespace

Expression kept(const Expression& value)
{
    if (!value.is_rounded) return value;
    return {"keep(" + value.text + ")", value.type, true, value.is_long, false, nullptr};
}

Expression binary(const std::string& symbol, const Expression& left, const Expression& right, bool precise)
{
    const std::string type = result_type(symbol, left, right);
    const Expression a = kept(left), b = kept(right);
    Expression result = {
        a.operand() + " " + symbol + " " + b.operand(), {type}, false, a.is_long || b.is_long, false, nullptr};
    if (!precise || type != "real") return result;
    if (symbol == "/") return {"divided(" + a.text + ", " + b.text + ")", {type}, true, true, false, nullptr};
    result.is_rounded = true;
    return result;
}

std::string wgsl_name(const std::string& name)
{
    return reserved_words().contains(name) ? name + "_" : name;
}

std::string wgsl_type(const std::string& name)
{
    if (name == "real") return "f32";
    if (name == "uint") return "u32";
    if (name == "uint4") return "vec4<u32>";
    return wgsl_name(name);
}

} // namespace tetrace::wgsl
