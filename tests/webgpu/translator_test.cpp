// The translator of the kernels' C to WGSL: each form of the subset, and each refusal.
#include "backends/webgpu/wgsl/translator.h"

#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

using tetrace::wgsl::translate;
using tetrace::wgsl::TranslationError;

namespace {

/// The functions of the prelude that the texts below call.
constexpr const char* declared = "real magnitude(real value); uint length_of(uint a) { return a; }\n"
                                 "struct Pair { real x; real type; };\nstorage(2) uint lines[];\n";

std::string without_spaces(std::string text)
{
    std::string result;
    for (const char c : text)
        if (c != '\n')
            result += c == ' ' && (result.empty() || result.back() == ' ') ? std::string() : std::string(1, c);
    return result;
}

/// What a function with this body becomes, on one line.
std::string body_of(const std::string& body, const std::string& head = "void f(real a, real b, uint n, bool c)")
{
    const std::string text = translate(declared + head + " {" + body + "}\n");
    return without_spaces(text.substr(text.find("fn f(")));
}

std::string reason_of(const std::string& text)
{
    try {
        static_cast<void>(translate(text));
    } catch (const TranslationError& error) {
        return error.what();
    }
    return "translated";
}

} // namespace

TEST(WgslTranslator, translates_each_form_of_the_kernels_language)
{
    const std::string f = "fn f(a: f32, b: f32, n: u32, c: bool) {";
    const std::vector<std::pair<std::string, std::string>> forms = {
        {"real x = a + b * a;", f + " var x: f32 = a + (b * a);}"},
        {"real x = a, y;", f + " var x: f32 = a; var y: f32;}"},
        {"uint w[4u + 2u]; w[n] = 3u; ++w[0u];", f + " var w: array<u32, 4u + 2u>; w[n] = 3u; w[0u] += 1u;}"},
        {"uint m = n; m <<= 2u; m--;", f + " var m: u32 = n; m = m << 2u; m -= 1u;}"},
        {"uint m = n & 3u | 1u << n;", f + " var m: u32 = (n & 3u) | (1u << n);}"},
        {"real x = c ? a : b;", f + " var x: f32 = select(b, a, c);}"},
        {"uint x = c ? length_of(n) : 0u;", f + " var x: u32; if (c) { x = length_of(n); } else { x = 0u; }}"},
        {"if (c) return; else { return; }", f + " if (c) { return; } else { return; }}"},
        {"if (c) { } else if (!c) return;", f + " if (c) { } else if (!c) { return; }}"},
        {"for (uint i = 0u; i < n; ++i) { if (c) continue; }",
         f + " for (var i: u32 = 0u; i < n; i += 1u) { if (c) { continue; } }}"},
        {"for (;;) break;", f + " while (true) { break; }}"},
        {"while (c) { }", f + " while (c) { }}"},
        {"uint i = 0u; do { ++i; } while (i < n);",
         f + " var i: u32 = 0u; loop { i += 1u; continuing { break if !(i < n); } }}"},
        {"Pair p; p.type = a; Pair q = Pair(a, b); q = c ? p : q;",
         f + " var p: Pair; p.type_ = a; var q: Pair = Pair(a, b); q = select_Pair(q, p, c);}"},
        {"uint4 q = uint4(n, 1u, 2u, lines[n]); uint m = q.w;",
         f + " var q: vec4<u32> = vec4<u32>(n, 1u, 2u, lines[n]); var m: u32 = q.w;}"},
        {"real x = real(-2.5e-3f) * a;", f + " var x: f32 = (-2.5e-3f) * a;}"},
        {"const uint from = ~n;", f + " var from_: u32 = ~n;}"},
        {"{ length_of(n); ; }", f + " { length_of(n); }}"}};
    for (const auto& [text, expected] : forms) {
        const std::string found = body_of(text);
        EXPECT_EQ(found.substr(0, expected.size()), expected) << text;
    }
}

TEST(WgslTranslator, copies_parameters_that_are_assigned_to)
{
    EXPECT_EQ(body_of("n += 1u; return n;", "uint f(uint n, uint m)"),
              "fn f(n_in: u32, m: u32) -> u32 { var n: u32 = n_in; n = n + 1u; return n;}");
}

TEST(WgslTranslator, keeps_each_rounded_value_of_a_precise_expression)
{
    const std::vector<std::pair<std::string, std::string>> forms = {
        {"a * b", "keep(a * b)"},
        {"a * b + a", "keep(keep(a * b) + a)"},
        {"(a + b) - b", "keep(keep((a + b)) - b)"},
        {"a * real(3.0f) * real(5.0f)", "keep(keep(a * 3.0f) * 5.0f)"},
        {"-(a * b)", "keep(-(a * b))"},
        {"a / b", "divided(a, b)"},
        {"a * b / (a - b)", "divided(keep(a * b), keep((a - b)))"},
        {"c ? a * b : magnitude(a - b)", "select(magnitude(keep(a - b)), keep(a * b), c)"},
        {"a * b < a ? a : b", "select(b, a, keep(a * b) < a)"},
        {"a", "a"}};
    for (const auto& [text, expected] : forms) {
        const std::string found = body_of("precise real x = " + text + ";");
        EXPECT_NE(found.find("var x: f32 = " + expected + ";"), std::string::npos) << text << "\n" << found;
    }
    const std::string assigned = body_of("precise real x = a; x = a * b; x += a * b;");
    EXPECT_NE(assigned.find("x = keep(a * b); x = keep(x + keep(a * b));"), std::string::npos) << assigned;
    EXPECT_EQ(body_of("real x = a * b + a;").find("keep"), std::string::npos) << "not asked for";
}

TEST(WgslTranslator, refuses_everything_else_with_file_and_line)
{
    const std::vector<std::pair<std::string, std::string>> refused = {
        {"int f() { return 1; }", "'int' is not a type of the kernels' language"},
        {"void f() { uint i = 1; }", "'1' is neither a uint (1u) nor a real (1.0f)"},
        {"void f() { real x = 1.0; }", "'1.0' is neither a uint (1u) nor a real (1.0f)"},
        {"void f() { x = 1u; }", "'x' is not declared"},
        {"void f(uint a) { real x = a; }", "a uint is assigned to a real"},
        {"void f(uint a, real b) { real x = a * b; }", "operator * has a uint and a real"},
        {"void f(real a) { a %= a; }", "operator % has a real and a real"},
        {"void f(uint a) { if (a) return; }", "a condition is a uint"},
        {"void f(uint a) { switch (a) { } }", "'switch' is not in the kernels' language"},
        {"void f(uint a) { uint b = c(a); }", "'c' is not a function"},
        {"uint g(uint a); void f(real a) { uint b = g(a); }", "the arguments of 'g' are not those that it takes"},
        {"uint f(real a) { return a; }", "a real is returned as a uint"},
        {"void f(uint4 q) { uint b = q.xy; }", "a uint4 has no member 'xy'"},
        {"void f(uint a) { a[0u] = 1u; }", "'a' is no array"},
        {"void f(uint a) { uint b[2u]; b[1.0f] = a; }", "an index is a real"},
        {"void f(uint* a) { }", "',' is expected instead of '*'"},
        {"void f(uint a) { a = a++; }", "';' is expected instead of '++'"},
        {"void f() { {", "a block has no end"},
        {"void f() { \"text\"; }", "'\"' is not known"},
        {"void f(bool a) { real x = -a; }", "operator - has a bool"},
        {"void f(bool a) { ++a; }", "++ has a bool"},
        {"void f(bool c, uint a, real b) { b = c ? a : b; }", "? chooses a uint or a real"}};
    for (const auto& [text, reason] : refused)
        EXPECT_EQ(reason_of("# 41 \"kernels/some.h\"\n\n" + text), "kernels/some.h:42: " + reason) << text;
}
