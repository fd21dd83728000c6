#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// Lines in place of others. Without others, they are inserted.
struct TextEdit {
    std::size_t line = 0, count = 0; ///< the first one that is replaced, and how many
    std::string text;                ///< lines, each with its line end
};

/// A change of a kernel's text that keeps its meaning: the same bits for every ray. Only integers and control flow
/// change, no rounding.
struct Change {
    std::string name; ///< "next_face.4/branch": the function, the statement's number in it, the kind
    std::vector<TextEdit> edits;
};

/// A kernel's text, and all changes of it that are known.
///
/// | kind | what changes |
/// |---|---|
/// | zero | an integer gets `+ 0`, where the 0 is an expression that a compiler does not see through |
/// | branch | a select, `a ? b : c`, becomes a branch |
/// | select | a branch becomes a select |
/// | once | a statement or a loop is the body of `do { } while (false)` |
/// | round | a statement is the body of a loop whose one round a compiler does not see |
/// | guard | a statement has a condition that is always true |
/// | dead | a return, or in a loop a break, has a condition that is never true |
/// | swap | two statements change places, of which neither reads what the other writes |
/// | struct | a function's arguments are passed in a struct |
class VariantText {
public:
    explicit VariantText(const std::string& text);

    [[nodiscard]] const std::vector<Change>& changes() const { return changes_; }

    /// The changes of a variant, as ascending indices: a random choice, of one in 64, 16 or 4 places or of all.
    [[nodiscard]] std::vector<std::size_t> choose(std::uint64_t seed, std::uint32_t number) const;

    /// The text with these changes. Precondition: they are a part of what choose() returned, or one by itself.
    [[nodiscard]] std::string with(std::span<const std::size_t> changes) const;

    /// The changes of these names. Throws Error{usage} if there is none of a name, or two cannot be made together.
    [[nodiscard]] std::vector<std::size_t> named(const std::vector<std::string>& names) const;

private:
    std::vector<std::string> lines_;
    std::vector<Change> changes_;
};

} // namespace tetrace
