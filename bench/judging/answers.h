#pragma once

#include "bench/results/npy.h"
#include "bench/truth/nearest.h"
#include "core/base/enum_names.h"
#include "core/mesh/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What an answer is. Those from `inaccurate` on are faults.
enum class AnswerVerdict {
    right,      ///< the nearest triangle, or a miss where there is none
    tie,        ///< another triangle is exactly as near
    inaccurate, ///< the nearest triangle, with a t, u or v that is not of the point
    wrong,      ///< a triangle that is not the nearest, or no triangle of the mesh
    missed,     ///< a miss, and the ray meets a triangle
    invented,   ///< a triangle, and the ray meets none
};
template <>
inline constexpr auto enum_names<AnswerVerdict> = names_up_to<AnswerVerdict::invented>("right", "tie", "inaccurate",
                                                                                       "wrong", "missed", "invented");
inline constexpr std::size_t answer_verdicts = 6;

[[nodiscard]] inline bool is_fault(AnswerVerdict verdict)
{
    return verdict >= AnswerVerdict::inaccurate;
}

/// A program's answer to a ray, as its file has it. face: -1 is a miss.
struct MeshAnswer {
    double face = -1, t = 0, u = 0, v = 0;
};

/// How far t, u and v may be from the exact ones.
struct AnswerTolerance {
    double unit_roundoff = 0x1p-24; ///< of the less precise of rays and answers
    double slack = 2;               ///< times what the kernels' formula can lose in that precision
};

/// A ray, its answer, and the truth.
struct JudgedAnswer {
    AnswerVerdict verdict = AnswerVerdict::right;
    std::vector<std::uint32_t> nearest; ///< all triangles at the least t; empty: the ray meets none
    bool is_near_edge = false;          ///< of a fault: see AnswerCounts
    std::string reason;                 ///< of a fault
};

/// What rays are judged against.
struct AnswerCase {
    const TriangleMesh& mesh;
    const NearestSearch& search;
    AnswerTolerance tolerance;
};
[[nodiscard]] JudgedAnswer judge_answer(const AnswerCase& against, const MeshRay& ray, const MeshAnswer& answer);

/// A fault in full.
struct FaultyRay {
    std::uint64_t number = 0;
    MeshRay ray;
    MeshAnswer answer;
    JudgedAnswer judged;
    std::optional<PlanePoint> met;   ///< where the ray meets the first of the nearest triangles
    std::optional<PlanePoint> named; ///< where it meets the plane of the answer's triangle; none: it runs in it
};

struct AnswerCounts {
    std::array<std::uint64_t, answer_verdicts> of{};
    /// Faults but `inaccurate` whose ray passes an edge of the nearest triangle, or of the one that the answer names,
    /// as near as u and v may be wrong: rounding may explain them.
    std::uint64_t near_edge = 0;
    std::array<std::optional<FaultyRay>, answer_verdicts> first{}; ///< of each kind of fault, by number

    [[nodiscard]] std::uint64_t count(AnswerVerdict verdict) const { return of.at(static_cast<std::size_t>(verdict)); }
    [[nodiscard]] std::uint64_t faults() const;
    /// The fault with the least number.
    [[nodiscard]] const FaultyRay* first_fault() const;
    void add(AnswerCounts other);
};

/// The rays of a file. Throws Error{invalid_input} naming the file, the row and the column for a number that is not
/// accepted (see MeshRay), a direction of zero, and a t_max below t_min.
[[nodiscard]] std::vector<MeshRay> mesh_rays_of(const NpyArray& array, const std::filesystem::path& path);

/// The answers of a file. Throws Error{invalid_input} naming the file and the row for a face that is no whole number.
[[nodiscard]] std::vector<MeshAnswer> mesh_answers_of(const NpyArray& array, const std::filesystem::path& path);

/// Called now and then with the share of the rays that is done.
using JudgingProgress = std::function<void(double)>;

/// Judges all of them. threads: 0 is all. Precondition: as many answers as rays.
[[nodiscard]] AnswerCounts judge_answers(const AnswerCase& against, const std::vector<MeshRay>& rays,
                                         const std::vector<MeshAnswer>& answers, unsigned threads,
                                         const JudgingProgress& progress);

/// The right answers, as rows of face, t, u, v: of several triangles the first; a miss is -1, 0, 0, 0.
[[nodiscard]] std::vector<float> right_answers(const NearestSearch& search, const std::vector<MeshRay>& rays,
                                               unsigned threads, const JudgingProgress& progress);

} // namespace tetrace
