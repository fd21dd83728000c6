#include "core/backend.h"
#include "core/elapsed.h"
#include "core/error.h"

#include <algorithm>
#include <chrono>
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
    // Not kept: many sessions are open at a time.
    std::vector<std::uint32_t> output(2 * std::size_t{GUARD_WORDS} + HIT_WORDS * hits.size());
    const auto start = std::chrono::steady_clock::now();
    read_output(output);
    download_s_ = seconds_since(start);
    const std::span<const std::uint32_t> words = output;
    check_guard(words.first(GUARD_WORDS), "before");
    check_guard(words.last(GUARD_WORDS), "behind");
    std::memcpy(hits.data(), words.data() + GUARD_WORDS, hits.size_bytes());
}

} // namespace tetrace
