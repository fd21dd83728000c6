#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/rays/hit.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tetrace {

/// A ray for exact arithmetic: its float coordinates, taken literally.
struct ExactRay {
    Float3 origin, direction;
};

/// Which part of a ray counts, and which answer is wanted.
struct RayPart {
    std::uint32_t start = NO_HIT; ///< the triangle that it starts on and does not meet again; NO_HIT: none
    float end = NO_END;           ///< ray parameter of its end
    bool any_hit = false;         ///< ours need not be nearest

    [[nodiscard]] bool is_whole() const { return start == NO_HIT && end >= NO_END; }
};

/// Verdict on a disagreement between two answers.
struct Settlement {
    enum class Kind {
        ours,  ///< exact arithmetic finds our answer the nearest of the candidates
        tie,   ///< the ray passes an edge so closely that float32 may decide either way
        wrong, ///< neither
    } kind = Kind::wrong;
    double distance = 0; ///< of a tie: distance from the ray, or its start or end, to what explains it
    const char* reason = "";
};

/// Settles disagreements about which triangle a ray meets first, by exact arithmetic on the triangles concerned.
///
/// The candidates are the triangles of both answers and all triangles that share a vertex with them. Our answer stands
/// if it is the nearest candidate that the exact ray meets. It is a tie if the ray is within the bound of our triangle,
/// and the ray can escape, within the bound, every candidate that it exactly meets before ours. It can escape over an
/// edge or vertex shared with our triangle, or over a silhouette (an edge whose triangles all lie on one side as seen
/// along the ray, or that has only one triangle). Two triangles that continue each other leave no gap to slip through:
/// that answer is wrong. A ray that starts or ends on a triangle is also a tie where a triangle is within the bound of
/// its start, or within the bound times hit_condition() of its end, which is compared with a rounded t.
class Settler {
public:
    explicit Settler(const TriangleMesh& mesh);

    /// ours, reference: triangle indices, or NO_HIT. bound: in domain units.
    [[nodiscard]] Settlement settle(const ExactRay& ray, std::uint32_t ours, std::uint32_t reference,
                                    double bound) const;
    [[nodiscard]] Settlement settle(const ExactRay& ray, const RayPart& part, std::uint32_t ours,
                                    std::uint32_t reference, double bound) const;

private:
    [[nodiscard]] std::vector<std::uint32_t> candidates(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] std::array<Float3, 3> corners(std::uint32_t triangle) const;
    [[nodiscard]] bool meets(const ExactRay& ray, const RayPart& part, std::uint32_t triangle) const;
    [[nodiscard]] double excess(const ExactRay& ray, const RayPart& part, std::uint32_t triangle, double bound) const;
    [[nodiscard]] double distance_to_limits(const ExactRay& ray, const RayPart& part, std::uint32_t triangle,
                                            double bound) const;
    [[nodiscard]] bool is_before(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] double distance_to_edge(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] double distance_to_outline(const ExactRay& ray, std::uint32_t triangle) const;
    [[nodiscard]] bool is_silhouette(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] double escape_distance(const ExactRay& ray, std::uint32_t triangle, std::uint32_t ours,
                                         double bound) const;
    [[nodiscard]] std::vector<std::uint32_t> triangles_at(std::uint32_t vertex) const
    {
        return {incident_.begin() + ranges_[vertex], incident_.begin() + ranges_[vertex + 1]};
    }

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> ranges_;   // per vertex, into incident_
    std::vector<std::uint32_t> incident_; // triangles
};

} // namespace tetrace
