// wgsl/: the translator of the kernels' C to WGSL, a program of the build. This file: an expression.
#pragma once

#include <memory>
#include <string>

namespace tetrace::wgsl {

/// Of a name or a value: real, uint, uint4, bool, void, or a struct's name; an array has its elements'.
struct Type {
    std::string name;
    bool is_array = false;

    friend bool operator==(const Type&, const Type&) = default;
};

struct Choice;

/// An expression that is translated.
struct Expression {
    std::string text;
    Type type;
    bool is_atom = true;     ///< needs no parentheses as an operand
    bool is_long = false;    ///< has a call or a load, which a select would make although it is not chosen
    bool is_rounded = false; ///< the value of an operation in a precise expression that keep() has not got yet

    std::shared_ptr<const Choice> choice; ///< of a ? b : c; null of any other

    [[nodiscard]] std::string operand() const { return is_atom ? text : "(" + text + ")"; }
};

/// condition ? yes : no. As a statement it becomes an if where a side is long.
struct Choice {
    Expression condition, yes, no;
};

/// The value in the one form that a compiler must compute as it is written: an exclusive or with a word that it does
/// not know to be 0, so nothing can be contracted, reassociated or removed across it.
[[nodiscard]] Expression kept(const Expression& value);

/// left SYMBOL right. precise: operands are kept, and so will the result be. Throws std::invalid_argument with the
/// reason if the types do not fit the operator.
[[nodiscard]] Expression binary(const std::string& symbol, const Expression& left, const Expression& right,
                                bool precise);

/// The name as WGSL may have it: reserved words get an underscore.
[[nodiscard]] std::string wgsl_name(const std::string& name);

/// Of a type that is no array.
[[nodiscard]] std::string wgsl_type(const std::string& name);

} // namespace tetrace::wgsl
