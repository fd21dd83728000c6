// The self-test: compiled once per math mode (CMakeLists.txt), which is given by PROBE_SYMBOL.
#include "backends/openmp/probe.h"

#include <bit>
#include <cassert>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace {
#include "kernels/language/dialect_cpp.h"

#include "kernels/probe.h"
} // namespace

namespace tetrace::openmp {

std::vector<std::uint32_t> PROBE_SYMBOL(std::span<const Quad> operations)
{
    std::fenv_t environment;
    std::fegetenv(&environment);
    std::fesetenv(FE_DFL_ENV); // the same setting as in the kernels' threads
    std::vector<std::uint32_t> results;
    for (const Quad& quad : operations)
        results.push_back(probe(quad.x, quad.y, quad.z, quad.w));
    std::fesetenv(&environment);
    return results;
}

} // namespace tetrace::openmp
