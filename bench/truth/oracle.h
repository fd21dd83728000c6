#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/rays/camera.h"
#include "core/rays/hit.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// A ray with a wrong answer, and everything needed to examine it.
struct WrongRay {
    std::uint32_t view = 0, x = 0, y = 0;
    Hit ours{};
    std::uint32_t reference_face = NO_HIT;
    float reference_t = 0;
    std::string reason;
};

/// Verdicts on the rays of an image; each ray is in exactly one of agreed, ties, settled, offset, wrong, lost.
struct Verdicts {
    std::uint64_t rays = 0;
    std::uint64_t agreed = 0;  ///< same triangle as Embree in robust mode, or both miss
    std::uint64_t ties = 0;    ///< another triangle, and the ray passes within tie_bound() of an edge that explains it
    std::uint64_t settled = 0; ///< another triangle, and exact arithmetic says ours is the nearest of the candidates
    std::uint64_t offset = 0;  ///< of given rays: right only for the offset origin that a BVH starts from
    std::uint64_t wrong = 0;
    std::uint64_t lost = 0;
    double largest_tie_distance = 0;     ///< in domain units, over all ties
    std::optional<WrongRay> first_wrong; ///< the first wrong or lost ray
    std::vector<std::uint32_t> flawed;   ///< of one image: pixels (y * width + x) of its wrong and lost rays, ascending

    /// Adds the counts; leaves `flawed` unchanged, because pixels of different images cannot be merged.
    void add(const Verdicts& other);
    [[nodiscard]] bool clean() const { return wrong == 0 && lost == 0; }
};

/// Judges hits. Shares only the making of primary rays with the kernels: every ray is compared with Embree in robust
/// mode, and each disagreement is settled by exact arithmetic on the original triangles.
class Oracle {
public:
    /// mesh: the scene's, kept by reference. threads: 0 is all.
    Oracle(const TriangleMesh& mesh, unsigned threads);
    ~Oracle();

    /// Judges every ray of one image; hits: row after row. Keeps Embree's answers for the last view, for the next row.
    [[nodiscard]] Verdicts judge(std::uint32_t view_number, const View& view, std::uint32_t width, std::uint32_t height,
                                 std::span<const Hit> hits);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tetrace
