#pragma once

#include <memory>
#include <string>

namespace re2 {
class RE2;
}

namespace tetrace {

/// Which names are kept: those in which a regular expression has a match. The expressions are RE2's: Perl's without
/// back references and look-around, so that the time of a match is linear in the name's length, and no expression
/// exhausts the stack. Many names may be asked about at once.
class NameFilter {
public:
    /// option: the option that the expression is from, for the message. expression: empty keeps all.
    /// Throws Error{usage} if it is not a regular expression, or one that takes too much memory.
    NameFilter(const std::string& option, const std::string& expression);
    [[nodiscard]] bool keeps(const std::string& name) const;

private:
    std::shared_ptr<const re2::RE2> expression_; ///< null: all are kept
};

} // namespace tetrace
