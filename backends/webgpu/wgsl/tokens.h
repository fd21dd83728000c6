#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace::wgsl {

/// A text that is not in the kernels' subset of C. what(): "file:line: what is wrong".
class TranslationError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

enum class TokenKind { name, number, symbol, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string text;
    std::string file;
    int line = 0; ///< from 1
};

/// The tokens of a preprocessed text, the last of kind `end`. File and line come from the preprocessor's line markers.
/// Throws TranslationError for a character that is in no token.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view text);

} // namespace tetrace::wgsl
