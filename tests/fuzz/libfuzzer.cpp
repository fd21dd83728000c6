// A program of libFuzzer for one target.
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
    static const auto target = [] {
        const auto all = tetrace::fuzz::TARGETS();
        const auto found = std::ranges::find(all, TARGET, &tetrace::fuzz::Target::name);
        if (found == all.end()) std::abort();
        return found->run;
    }();
    target({reinterpret_cast<const char*>(bytes), size});
    return 0;
}
