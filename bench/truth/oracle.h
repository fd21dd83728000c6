#pragma once

#include "bench/truth/hit_point.h"
#include "bench/truth/verdicts.h"
#include "core/mesh/triangle_mesh.h"
#include "core/rays/camera.h"

#include <cstdint>
#include <memory>
#include <span>

namespace tetrace {

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

} // namespace tetrace
