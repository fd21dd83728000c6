#pragma once

#include "bench/truth/exact_search.h"
#include "bench/truth/hit_point.h"
#include "bench/truth/oracle.h"
#include "bench/truth/settle.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <optional>
#include <span>
#include <vector>

namespace tetrace {

/// A ray that is judged, and what the exact ray meets first.
struct JudgedRay {
    ExactRay ray;
    ExactRay traced; ///< whose t the hit has: `ray`, or for BVHs one from an origin off the surface
    RayPart part;
    FirstHit first;
    std::uint32_t view, x, y, pixel; ///< to name it by
};

/// Why an answer is wrong.
struct Flaw {
    const char* reason;
    std::uint32_t first; ///< what the exact ray meets first
};

/// The sum of blocks, with all their flawed pixels in order.
[[nodiscard]] Verdicts sum_of(std::span<const Verdicts> blocks, std::size_t rays);

/// Calls what(verdicts, i) for each i below count, on that many threads, and sums up. Throws the first exception of
/// these calls; one that left its thread would end the program.
template <class What>
[[nodiscard]] Verdicts judge_each(int threads, std::size_t count, const What& what)
{
    constexpr std::size_t rays_at_once = 1024; // one thread judges these, one after the other
    std::vector<Verdicts> blocks((count + rays_at_once - 1) / rays_at_once);
    std::exception_ptr thrown;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        try {
            for (std::size_t i = block * rays_at_once; i < std::min((block + 1) * rays_at_once, count); ++i)
                what(blocks[block], i);
        } catch (...) {
#pragma omp critical(tetrace_judge)
            if (thrown == nullptr) thrown = std::current_exception();
        }
    }
    if (thrown != nullptr) std::rethrow_exception(thrown);
    return sum_of(blocks, count);
}

/// What the oracles of hits share: one ray's verdict, and the loop over many.
class Judge {
public:
    /// mesh: kept by reference. threads: 0 is all.
    Judge(const TriangleMesh& mesh, unsigned threads);

    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }

    /// What the part of a ray meets first, if that is clear.
    [[nodiscard]] FirstHit first(const ExactRay& ray, const RayPart& part) const;

    /// Why an answer is wrong; nothing: it is right, and has been counted.
    [[nodiscard]] std::optional<Flaw> judge(Verdicts& verdicts, const JudgedRay& judged, const Hit& hit,
                                            HitFormula formula) const;

    /// Counts a wrong or lost ray.
    void blame(Verdicts& verdicts, const JudgedRay& judged, const Hit& hit, Flaw flaw) const;

    /// judge_each() on all threads.
    template <class What>
    [[nodiscard]] Verdicts for_each(std::size_t count, const What& what) const
    {
        return judge_each(threads_, count, what);
    }

private:
    [[nodiscard]] const char* flaw_of(const JudgedRay& judged, const Hit& hit, HitFormula formula) const;

    const TriangleMesh& mesh_;
    int threads_;
    ExactSearch search_;
    Settler settler_;
};

} // namespace tetrace
