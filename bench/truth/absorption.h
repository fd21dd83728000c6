#pragma once

#include "bench/truth/crossings.h"
#include "core/rays/absorbed.h"

#include <cstdint>

namespace tetrace {

/// A tet's medium (docs/spec/volume.md, S11), by its packed number.
struct Medium {
    std::uint32_t density; ///< in 16ths of a halving of the light per domain unit
    std::uint32_t value;   ///< in 256ths
};
[[nodiscard]] Medium medium_of(std::uint32_t tet);

/// What passes at a depth in units of 2^-32 of a halving, bit by bit as the kernels must have it.
[[nodiscard]] std::uint32_t transmittance_at(std::uint64_t depth);

/// The answer of task absorb that a walk makes: of its tets until too little light passes, as the kernels must have it.
[[nodiscard]] Absorbed absorption_of(const CrossedTets& walk);

} // namespace tetrace
