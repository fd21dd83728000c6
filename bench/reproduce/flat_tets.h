#pragma once

#include "bench/measuring/image_record.h"
#include "bench/rows/scene_work.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace tetrace {

/// A tet is flat where its flatness is below this value.
inline constexpr double flat_below = 1e-3;

/// A tet's shortest altitude over its longest edge: about 0.82 for a regular tet, 0 for one without volume.
[[nodiscard]] double flatness(const TetMesh& mesh, std::size_t tet);

/// Finds which tets of a scene are flat, and which walks pass through them.
class FlatTets {
public:
    explicit FlatTets(const SceneWork& scene);

    [[nodiscard]] std::uint64_t count() const { return count_; }

    /// Counts the rays that pass a flat tet in their first steps_looked_at steps, among the rays through these pixels
    /// (y * width + x). Looks at no more than rays_looked_at rays, spread over the pixels. openmp traces the walks.
    /// row: of structure cdt, opened.
    [[nodiscard]] FlatWalks walks(const RowRun& row, std::size_t view, std::span<const std::uint32_t> pixels);
    /// The same for rays over the whole image.
    [[nodiscard]] FlatWalks walks_anywhere(const RowRun& row, std::size_t view);

    static constexpr std::size_t rays_looked_at = 32;
    static constexpr std::uint32_t steps_looked_at = 200;

private:
    struct Walker {
        KernelId kernel;
        const Packed* packed;
        std::unique_ptr<Session> session;
    };
    [[nodiscard]] Walker& walker_of(const RowRun& row);
    [[nodiscard]] bool passes_flat(const Walker& walker, std::size_t view, std::uint32_t pixel) const;

    const SceneWork* scene_;
    std::vector<bool> flat_;
    std::uint64_t count_ = 0;
    std::vector<Walker> walkers_;
    std::map<const Packed*, std::vector<bool>> flat_packed_; ///< by position in the packed scene
};

} // namespace tetrace
