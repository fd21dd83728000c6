#include "core/backend.h"
#include "core/error.h"

#include <algorithm>
#include <cstring>

namespace tetrace {

namespace {

void check_guard(std::span<const std::uint32_t> guard, const char* where)
{
    const auto intact = [](std::uint32_t word) { return word == POISON; };
    if (std::all_of(guard.begin(), guard.end(), intact)) return;
    throw Error(ErrorKind::wrong_result,
                std::string("the kernel wrote ") + where + " its hits: the guard words there are overwritten");
}

} // namespace

void Session::read_back(std::span<Hit> hits)
{
    static_assert(sizeof(Hit) == HIT_WORDS * sizeof(std::uint32_t));
    output_.resize(2 * std::size_t{GUARD_WORDS} + HIT_WORDS * hits.size());
    read_output(output_);
    const std::span<const std::uint32_t> words = output_;
    check_guard(words.first(GUARD_WORDS), "before");
    check_guard(words.last(GUARD_WORDS), "behind");
    std::memcpy(hits.data(), words.data() + GUARD_WORDS, hits.size_bytes());
}

} // namespace tetrace
