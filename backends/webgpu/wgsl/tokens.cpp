#include "backends/webgpu/wgsl/tokens.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>

namespace tetrace::wgsl {

namespace {

constexpr std::array<std::string_view, 24> long_symbols = {
    "<<=", ">>=", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
    "<<",  ">>",  "<=", ">=", "==", "!=", "&&", "||", "->", "::", "//", "/*"};
constexpr std::string_view short_symbols = "+-*/%&|^~!<>=?:;,.(){}[]";

bool is_name_character(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

class Scanner {
public:
    explicit Scanner(std::string_view text) : rest_(text) {}

    std::vector<Token> all()
    {
        std::vector<Token> tokens;
        while (skip_space()) {
            if (rest_.front() == '#')
                read_marker();
            else
                tokens.push_back(next());
        }
        tokens.push_back({TokenKind::end, "the end of the text", file_, line_});
        return tokens;
    }

private:
    bool skip_space()
    {
        while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        }
        return !rest_.empty();
    }

    /// # LINE "FILE": of the line after it. Other directives say nothing of WGSL.
    void read_marker()
    {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        const std::string line(rest_.substr(0, end));
        rest_.remove_prefix(end);
        const std::size_t open = line.find('"'), close = line.rfind('"');
        if (open == close || std::isdigit(static_cast<unsigned char>(line[2])) == 0) return;
        file_ = line.substr(open + 1, close - open - 1);
        line_ = std::stoi(line.substr(2)) - 1; // its own end of line counts
    }

    Token next()
    {
        const char first = rest_.front();
        if (std::isdigit(static_cast<unsigned char>(first)) != 0) return number();
        if (is_name_character(first)) return taken(TokenKind::name, length_of_name());
        for (const std::string_view symbol : long_symbols)
            if (rest_.starts_with(symbol)) return taken(TokenKind::symbol, symbol.size());
        if (short_symbols.find(first) == std::string_view::npos) fail(fmt::format("'{}' is not known", first));
        return taken(TokenKind::symbol, 1);
    }

    Token number()
    {
        std::size_t size = 0;
        while (size < rest_.size() && (is_name_character(rest_[size]) || rest_[size] == '.' || is_sign_at(size)))
            ++size;
        return taken(TokenKind::number, size);
    }

    /// The sign of an exponent.
    [[nodiscard]] bool is_sign_at(std::size_t at) const
    {
        return at > 0 && (rest_[at] == '-' || rest_[at] == '+') && (rest_[at - 1] == 'e' || rest_[at - 1] == 'E') &&
               !rest_.starts_with("0x");
    }

    [[nodiscard]] std::size_t length_of_name() const
    {
        return static_cast<std::size_t>(std::ranges::find_if_not(rest_, is_name_character) - rest_.begin());
    }

    Token taken(TokenKind kind, std::size_t size)
    {
        Token token = {kind, std::string(rest_.substr(0, size)), file_, line_};
        rest_.remove_prefix(size);
        return token;
    }

    [[noreturn]] void fail(const std::string& why) const
    {
        throw TranslationError(fmt::format("{}:{}: {}", file_, line_, why));
    }

    std::string_view rest_;
    std::string file_ = "the text";
    int line_ = 1;
};

} // namespace

std::vector<Token> tokens_of(std::string_view text)
{
    return Scanner(text).all();
}

} // namespace tetrace::wgsl
