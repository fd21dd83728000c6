#pragma once

#include "bench/truth/hit_point.h"
#include "core/mesh/triangle_mesh.h"
#include "core/rays/camera.h"
#include "core/rays/hit.h"
#include "core/rays/ray_set.h"

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
    Task task = Task::trace; ///< says how `ours` is read; segments have no reference
};

/// Verdicts on the rays of an image; each ray is in exactly one of agreed, ties, settled, offset, wrong, lost.
struct Verdicts {
    std::uint64_t rays = 0;
    std::uint64_t agreed = 0;  ///< the exact ray's answer, and no edge or other triangle is within tie_bound() of it
    std::uint64_t settled = 0; ///< the exact ray's answer, although some do
    std::uint64_t ties = 0;    ///< another answer, that of a curve within tie_bound() of the ray: its witness
    std::uint64_t offset = 0;  ///< of given rays: right only for the offset origin that a BVH starts from
    std::uint64_t wrong = 0;
    std::uint64_t lost = 0;
    double max_tie_distance = 0;         ///< in domain units, of all ties' witnesses from their rays
    std::optional<WrongRay> first_wrong; ///< the first wrong or lost ray
    std::vector<std::uint32_t> flawed;   ///< of one image: pixels (y * width + x) of its wrong and lost rays, ascending

    /// Adds the counts; leaves `flawed` unchanged, because pixels of different images cannot be merged.
    void add(const Verdicts& other);
    [[nodiscard]] bool clean() const { return wrong == 0 && lost == 0; }
};

/// Judges hits. Shares only the making of primary rays with the kernels: what each ray meets first is found by exact
/// arithmetic on the original triangles, and any other answer needs a witness.
class Oracle {
public:
    /// mesh: the scene's, kept by reference. threads: 0 is all.
    Oracle(const TriangleMesh& mesh, unsigned threads);
    ~Oracle();

    /// Judges every ray of one image; hits: row after row. Keeps the exact answers for the last view, for the next row.
    [[nodiscard]] Verdicts judge(std::uint32_t view_number, const View& view, std::uint32_t width, std::uint32_t height,
                                 std::span<const Hit> hits, HitFormula formula = HitFormula::kernels);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Where the traced rays started: at the set's origins (given_quads), or offset, as BVHs get them (given_quads_offset).
enum class Origins { own, offset };

/// Judges the answers to given rays, as Oracle judges those to primary rays, by the set's own origins. The triangle
/// that a ray starts on is left out. For any-hit kinds, the triangle in the answer must be met before the ray's end.
class GivenOracle {
public:
    /// mesh: the scene's, kept by reference. threads: 0 is all.
    GivenOracle(const TriangleMesh& mesh, unsigned threads);
    ~GivenOracle();

    /// hits: by ray, in the set's order. Verdicts::flawed has pixels as in an image of the set's width. Keeps the exact
    /// answers for the last set, for the next row.
    [[nodiscard]] Verdicts judge(const RaySet& set, std::span<const Hit> hits, Origins origins,
                                 HitFormula formula = HitFormula::kernels);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tetrace
