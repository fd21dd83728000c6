#pragma once

#include "bench/truth/exact_ray.h"
#include "bench/truth/exact_search.h"
#include "bench/truth/witness.h"

#include <cstdint>
#include <vector>

namespace tetrace {

/// Verdict on an answer.
struct Settlement {
    enum class Kind {
        exact, ///< the exact ray meets that triangle first, or none
        tie,   ///< another answer, but a curve within the bound of the ray does; the witness is that curve
        wrong, ///< neither
    } kind = Kind::wrong;
    std::uint32_t first = NO_HIT; ///< what the exact ray meets first; edge-on triangles are left out
    Witness witness{};            ///< of a tie
    double distance = 0;          ///< of a tie: the largest distance of the witness from the ray
    const char* reason = "";
};

/// Settles by exact arithmetic whether an answer is right.
///
/// An answer is right if some curve, everywhere within the bound of the ray and never going back along it, meets that
/// triangle first; for NO_HIT, if such a curve meets none up to the end (docs/spec/numbers.md, N6). The exact ray is
/// such a curve. Any other must be found, and is checked exactly: no witness, no tie. Where any hit will do, the
/// triangle need not be the first. The end of a part is compared with a rounded t: a triangle is neither before nor
/// past it if they differ by no more than the error of t.
class Settler {
public:
    /// mesh, search: kept by reference.
    Settler(const TriangleMesh& mesh, const ExactSearch& search) : mesh_(mesh), search_(search) {}

    /// answer: a triangle's index, NO_HIT, or SOME_HIT where any hit will do. bound: in domain units.
    [[nodiscard]] Settlement settle(const ExactRay& ray, const RayPart& part, std::uint32_t answer, double bound) const;

private:
    struct Met {
        std::uint32_t triangle;
        double t;
        bool is_edge_on;
    };
    struct Case;

    [[nodiscard]] std::vector<Met> met_by(const Case& question) const;
    [[nodiscard]] bool is_before(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] Settlement settle_any(const Case& question) const;
    [[nodiscard]] Settlement settle_first(const Case& question) const;

    const TriangleMesh& mesh_;
    const ExactSearch& search_;
};

} // namespace tetrace
