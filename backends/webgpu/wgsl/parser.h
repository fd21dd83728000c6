#pragma once

#include "backends/webgpu/wgsl/expression.h"
#include "backends/webgpu/wgsl/tokens.h"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tetrace::wgsl {

/// What the text has declared outside of functions.
struct Declarations {
    struct Function {
        Type result;
        std::vector<Type> parameters;
        bool has_body = false; ///< false: the prelude has it, and it is short
    };
    using Members = std::vector<std::pair<std::string, Type>>;

    std::map<std::string, Members> structs;
    std::map<std::string, Function> functions;
    std::map<std::string, Type> buffers;
    std::set<std::string> selected_structs; ///< for which a function chooses one of two

    [[nodiscard]] bool is_type(const std::string& name) const;
};

/// A local name.
struct Local {
    Type type;
    bool is_precise = false;
};

/// Reads tokens and expressions; a Translator reads the rest.
class Parser {
public:
    explicit Parser(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

protected:
    [[nodiscard]] const Token& peek(std::size_t ahead = 0) const
    {
        return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
    [[nodiscard]] bool is_next(const char* text) const { return peek().text == text && peek().kind != TokenKind::end; }
    [[nodiscard]] bool is_end() const { return peek().kind == TokenKind::end; }
    std::string take();
    void expect(const char* text);
    bool accept(const char* text);
    std::string name();
    Type type();
    [[noreturn]] void fail(const std::string& why) const;

    /// precise: of a precise local, whose value is kept.
    Expression expression(bool precise);
    /// binary() of expression.h; what does not fit is refused here.
    Expression combined(const std::string& symbol, const Expression& left, const Expression& right, bool precise) const;
    /// A value that a statement assigns to: a local, a member or an element.
    Expression place();
    [[nodiscard]] const Local* find_local(const std::string& name) const;
    [[nodiscard]] std::size_t position() const { return at_; }
    [[nodiscard]] const Token& token(std::size_t at) const { return tokens_[at]; }

    Declarations declared_;
    std::vector<std::map<std::string, Local>> scopes_; ///< the innermost last

private:
    Expression choice(const Expression& condition, bool precise);
    Expression binary_expression(std::size_t level, bool precise);
    Expression unary(bool precise);
    Expression primary(bool precise);
    /// The value followed by any number of .member and [index].
    Expression with_selections(Expression value);
    Expression named();
    Expression call(const std::string& function, bool precise);
    Expression member_of(const Expression& value);
    Expression element_of(const Expression& value);

    std::vector<Token> tokens_;
    std::size_t at_ = 0;
};

} // namespace tetrace::wgsl
