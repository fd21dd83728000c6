#include "scenes/builder/word_reader.h"

#include <fmt/format.h>

namespace tetrace {

std::string_view WordReader::peek()
{
    if (at_ == words_.size()) {
        at_ = 0;
        lines_.next(words_);
    }
    return at_ < words_.size() ? words_[at_] : std::string_view();
}

std::string_view WordReader::next()
{
    if (peek().empty()) fail("the file ends inside it");
    return words_[at_++];
}

std::string_view WordReader::next_line()
{
    words_.clear();
    at_ = 0;
    std::string_view line;
    if (!lines_.next_raw(line)) fail("the file ends inside it");
    return line;
}

std::vector<std::string_view> WordReader::next_words()
{
    if (peek().empty()) fail("the file ends inside it");
    const std::vector<std::string_view> rest(words_.begin() + static_cast<std::ptrdiff_t>(at_), words_.end());
    at_ = words_.size();
    return rest;
}

std::int64_t WordReader::integer_of(std::string_view word) const
{
    const auto value = parse_integer(word);
    if (!value) fail(fmt::format("'{:.40}' is not a whole number", word));
    return *value;
}

Double3 WordReader::position()
{
    const double x = number(), y = number(), z = number();
    return {x, y, z};
}

std::size_t WordReader::count(const std::string& elements, std::size_t min_bytes)
{
    const std::int64_t value = integer();
    if (value < 0) fail(fmt::format("a negative number of {}, {}", elements, value));
    const std::size_t most = bytes_ / min_bytes + 1;
    if (static_cast<std::uint64_t>(value) > most)
        fail(fmt::format("it announces {} {}, but {} bytes cannot hold more than {}", value, elements, bytes_, most));
    return static_cast<std::size_t>(value);
}

void WordReader::skip_numbers()
{
    while (!peek().empty() && parse_number(peek()))
        ++at_;
}

void WordReader::skip_block()
{
    words_.clear();
    at_ = 0;
    std::string_view line;
    while (lines_.next_raw(line) && !split_words(line).empty()) {
    }
}

} // namespace tetrace
