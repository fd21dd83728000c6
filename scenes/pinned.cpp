#include "scenes/pinned.h"

#include <algorithm>
#include <array>

#ifdef TETRACE_WITHOUT_STORED_TETS
#define STORED(symbol, file) static const unsigned char stored_##symbol[1] = {}, *stored_end_##symbol = stored_##symbol
#else
// The assembler reads the file. clang-format off
#define STORED(symbol, file)                                                                                           \
    asm(".pushsection .rodata\n.globl stored_" #symbol ", stored_end_" #symbol "\n.hidden stored_" #symbol             \
        ", stored_end_" #symbol "\nstored_" #symbol ":\n.incbin \"" TETRACE_PINNED_FOLDER "/" file                     \
        "\"\nstored_end_" #symbol ":\n.popsection");                                                                   \
    extern "C" __attribute__((visibility("hidden"))) const unsigned char stored_##symbol[], stored_end_##symbol[]
// clang-format on
#endif

STORED(bunny_1, "bunny-1.tets.xz");
STORED(armadillo_1, "armadillo-1.tets.xz");
STORED(atrium_1, "atrium-1.tets.xz");

namespace tetrace {

namespace {

std::span<const std::byte> bytes_between(const unsigned char* first, const unsigned char* last)
{
    return std::as_bytes(std::span(first, last));
}

constexpr const char* tool_1 = "tetrace-builder 0.1.0, TetGen 1.5.0, CGAL 5.5.1"; // of all of version 1

} // namespace

std::span<const PinnedScene> pinned_scenes()
{
    static const std::array<PinnedScene, 3> scenes = {{
        {"bunny-1", "bunny", 0x78924a553c61dc43, 0xb549bf42bca0e25c, 0x02e9d84d743616a3, 0x37628cf5dd37d8c1, 4, tool_1,
         41.308799301776602, 14.504171213204627, bytes_between(stored_bunny_1, stored_end_bunny_1)},
        {"armadillo-1", "armadillo", 0xcfd9a20c2f3456b8, 0xe7858ea90dc957f8, 0xfb7915c52b00caa0, 0x6200f9bf329e150e, 4,
         tool_1, 41.852296584244129, 15.106004767161773, bytes_between(stored_armadillo_1, stored_end_armadillo_1)},
        {"atrium-1", "atrium", 0x38cdffb476727d79, 0x6b422b1a4e4bdad3, 0x26606013fe03f4f9, 0x48e31d41dc59126f, 3,
         tool_1, 92.696192842220398, 42.546285487618633, bytes_between(stored_atrium_1, stored_end_atrium_1)},
    }};
    return scenes;
}

const PinnedScene* find_pinned(std::string_view name)
{
    const auto found = std::ranges::find(pinned_scenes(), name, &PinnedScene::name);
    return found != pinned_scenes().end() ? &*found : nullptr;
}

const PinnedScene* pinned_with(std::uint64_t scene_hash)
{
    const auto found = std::ranges::find(pinned_scenes(), scene_hash, &PinnedScene::scene_hash);
    return found != pinned_scenes().end() ? &*found : nullptr;
}

} // namespace tetrace
