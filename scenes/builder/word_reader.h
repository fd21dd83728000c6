#pragma once

#include "scenes/builder/mesh_source.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// The words of a text that runs on from line to line, as formats of tets have them. Failures name the element that is
/// being read, and the line.
class WordReader {
public:
    /// has_lines: whether the file's own lines are read, so that messages may count them.
    WordReader(const MeshSource& source, std::string_view text, bool has_lines = true)
        : source_(source), lines_(text), bytes_(text.size()), has_lines_(has_lines)
    {
    }

    /// Of what comes next, for messages.
    void begin(std::string element) { element_ = std::move(element); }
    [[nodiscard]] std::string place() const { return has_lines_ ? lines_.place(element_) : element_; }
    [[noreturn]] void fail(const std::string& problem) const { source_.fail(place(), problem); }
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const
    {
        source_.fail(place(), problem, remedy);
    }

    /// The next word, which stays; empty at the end of the text.
    [[nodiscard]] std::string_view peek();
    /// The next word; fails at the end of the text.
    std::string_view next();
    /// The rest of the line as it is, or the next line.
    std::string_view next_line();
    /// The words of the next line that is not blank, or of the rest of this one; fails at the end of the text.
    std::vector<std::string_view> next_words();
    /// Fails unless the word is such a number.
    std::int64_t integer() { return integer_of(next()); }
    double number() { return parse_coordinate(source_, next(), place()); }
    [[nodiscard]] std::int64_t integer_of(std::string_view word) const;
    Double3 position();
    /// A number of elements, each of which takes at least so many bytes.
    std::size_t count(const std::string& elements, std::size_t min_bytes);
    /// Passes over numbers, to the next other word.
    void skip_numbers();
    /// Passes over this line and those after it, up to a blank one.
    void skip_block();
    [[nodiscard]] std::size_t line() const { return lines_.line(); }

private:
    const MeshSource& source_;
    LineReader lines_;
    std::size_t bytes_;
    bool has_lines_;
    std::string element_ = "header";
    std::vector<std::string_view> words_;
    std::size_t at_ = 0;
};

} // namespace tetrace
