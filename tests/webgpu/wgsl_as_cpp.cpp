// wgsl_as_cpp IN OUT kept|plain|rough: rewrites WGSL, in the form that kernel_to_wgsl writes, line by line as C++ that
// wgsl_types.h makes mean the same, without the entry point. So a compiler that may contract and reassociate can be let
// loose on it. plain: keep() does nothing. rough: the device's quotients are some units off.
#include <fstream>
#include <iostream>
#include <re2/re2.h>
#include <sstream>
#include <string>
#include <vector>

namespace {

class Rewriter {
public:
    bool add(std::string line)
    {
        if (line.starts_with("override")) return false; // the entry point
        std::string name, type, access, list, rest, number;
        if (RE2::PartialMatch(line, R"(^var<private> (\w+): (\w+);)", &name, &type)) {
            body_ += "static " + type + " " + name + ";\n";
        } else if (RE2::PartialMatch(line, R"(^@group\(0\) @binding\((.*?)\) var<storage, \w+> (\w+): (.*);$)", &number,
                                     &name, &type)) {
            const bool is_array = RE2::PartialMatch(type, R"(^array<(.*)>$)", &type);
            head_ += "static " + (is_array ? "Storage<" + type + "> " : type + " ") + name + ";\n";
            setters_ += "    if (binding == " + number + ") set_storage(" + name + ", bytes);\n";
        } else if (line.starts_with("struct ")) {
            in_struct_ = true;
            head_ += line + "\n";
        } else if (in_struct_) {
            if (line == "}") in_struct_ = false;
            RE2::Replace(&line, R"(^    (\w+): (.*),$)", R"(    \2 \1;)");
            head_ += line + (in_struct_ ? "\n" : ";\n");
        } else if (RE2::PartialMatch(line, R"(^fn (\w+)\((.*)\)( -> .*)? \{$)", &name, &list, &type)) {
            RE2::GlobalReplace(&list, R"((\w+): ([\w<>]+))", R"(\2 \1)");
            const std::string head =
                "[[maybe_unused]] static " + (type.empty() ? "void" : type.substr(4)) + " " + name + "(" + list + ")";
            prototypes_ += head + ";\n";
            body_ += head + "\n{\n";
        } else {
            add_statement(line);
        }
        return true;
    }

    [[nodiscard]] std::string text() const
    {
        return "#include \"tests/webgpu/wgsl_types.h\"\n\nnamespace {\n\n" + head_ + prototypes_ + body_ +
               "\nvoid set(u32 binding, Bytes bytes)\n{\n" + setters_ +
               "}\n\n} // namespace\n\n#include \"tests/webgpu/wgsl_entry.h\"\n";
    }

private:
    void add_statement(std::string line)
    {
        std::string indent, condition;
        RE2::Replace(&line, R"(\bvar (\w+): ([\w<>]+(?:, .*>)?) =)", R"(\2 \1 =)");
        RE2::Replace(&line, R"(^( *)var (\w+): (.*);$)", R"(\1\3 \2 = {};)");
        RE2::Replace(&line, R"(^( *)let (\w+) =)", R"(\1const auto \2 =)");
        if (RE2::PartialMatch(line, R"(^( *)loop \{$)", &indent)) line = indent + "do {";
        if (RE2::PartialMatch(line, R"(^ *continuing \{$)")) return;
        if (RE2::PartialMatch(line, R"(^ *break if !\((.*)\);$)", &condition)) {
            conditions_.push_back(condition);
            closing_ = 2;
            return;
        }
        if (closing_ > 0) { // of continuing, then of loop
            if (--closing_ > 0) return;
            line += " while (" + conditions_.back() + ");";
            conditions_.pop_back();
        }
        body_ += line + "\n";
    }

    std::string head_, prototypes_, body_, setters_;
    std::vector<std::string> conditions_;
    int closing_ = 0;
    bool in_struct_ = false;
};

} // namespace

int main(int, char** argv)
{
    std::ifstream in(argv[1]);
    Rewriter rewriter;
    std::string line;
    bool goes_on = true;
    while (goes_on && std::getline(in, line)) {
        if (std::string(argv[3]) == "plain") RE2::Replace(&line, R"(bitcast<u32>\(x\) \^ zero)", "bitcast<u32>(x)");
        if (std::string(argv[3]) == "rough") RE2::Replace(&line, R"(keep\(a / b\))", "rough(a / b)");
        goes_on = rewriter.add(line);
    }
    std::ofstream out(argv[2]);
    out << rewriter.text() << std::flush;
    return in.bad() || !out ? 1 : 0;
}
