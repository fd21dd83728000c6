#include "bench/inspection/occupancy.h"

#include <algorithm>
#include <array>

namespace tetrace {

namespace {

struct Multiprocessor {
    unsigned capability;
    std::uint64_t warps, blocks, shared_kib; ///< the most
};

constexpr std::array multiprocessors = {
    Multiprocessor{70, 64, 32, 96},   Multiprocessor{72, 64, 32, 96},   Multiprocessor{75, 32, 16, 64},
    Multiprocessor{80, 64, 32, 164},  Multiprocessor{86, 48, 16, 100},  Multiprocessor{87, 48, 16, 164},
    Multiprocessor{89, 48, 24, 100},  Multiprocessor{90, 64, 32, 228},  Multiprocessor{100, 64, 32, 228},
    Multiprocessor{103, 64, 32, 228}, Multiprocessor{110, 48, 24, 228}, Multiprocessor{120, 48, 24, 100},
    Multiprocessor{121, 48, 24, 100},
};

constexpr std::uint64_t registers_of_part = 65'536 / 4;

} // namespace

std::optional<Warps> resident_warps(unsigned capability, std::uint64_t registers, std::uint64_t block,
                                    std::uint64_t shared_bytes)
{
    const auto found = std::ranges::find(multiprocessors, capability, &Multiprocessor::capability);
    if (found == multiprocessors.end() || registers == 0 || block == 0) return std::nullopt;
    constexpr std::uint64_t lanes = 32, unit = 256, parts = 4;
    const std::uint64_t of_warp = (registers * lanes + unit - 1) / unit * unit;
    const std::uint64_t by_registers = registers_of_part / of_warp * parts;
    const std::uint64_t of_block = (block + lanes - 1) / lanes;
    const std::uint64_t reserved = capability >= 80 ? 1024 : 0;
    const std::uint64_t by_shared =
        shared_bytes == 0 ? found->blocks : found->shared_kib * 1024 / (shared_bytes + reserved);
    const std::uint64_t blocks = std::min({by_registers / of_block, found->blocks, by_shared});
    return Warps{std::min(blocks * of_block, found->warps / of_block * of_block), found->warps};
}

} // namespace tetrace
