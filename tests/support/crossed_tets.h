#pragma once

#include "backends/openmp/backend.h"
#include "backends/openmp/kernels.h"
#include "bench/truth/crossings.h"
#include "core/device/given_quads.h"
#include "core/pack/packed_scene.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tetrace::test {

/// A scene packed for a kernel of a task that crosses tets, and what openmp answers and notes there.
class CrossedScene {
public:
    CrossedScene(const Scene& scene, const KernelId& kernel)
        : scene_(scene), kernel_(kernel), packed_(pack(scene, kernel.layout, TetOrder::chains)),
          mesh_of_packed_(inverse_of(packed_.packed_of_mesh))
    {
    }
    CrossedScene(const Scene& scene, Method method, Layout layout, Task task = Task::segments)
        : CrossedScene(scene, {.method = method, .layout = layout, .task = task})
    {
    }

    [[nodiscard]] const KernelId& kernel() const { return kernel_; }
    [[nodiscard]] const PackedScene& packed() const { return packed_; }
    [[nodiscard]] const std::vector<std::uint32_t>& mesh_of_packed() const { return mesh_of_packed_; }

    /// The answers of a device's session on this scene.
    [[nodiscard]] std::vector<Hit> answers(Session& session, const RaySet& set) const
    {
        session.set_rays(segment_quads(set, packed_));
        std::vector<Hit> answers(set.rays.size());
        (void)session.trace(given_job(set.rays.size(), packed_.tet_count + 1, false), answers);
        return answers;
    }
    [[nodiscard]] std::unique_ptr<Session> session(unsigned threads) const
    {
        return openmp_backend().open(0, kernel_, {&scene_.mesh, &packed_}, {.threads = threads});
    }
    [[nodiscard]] std::vector<Hit> answers(const RaySet& set) const { return answers(*session(2), set); }
    [[nodiscard]] std::vector<CrossedTets> walks(const RaySet& set) const
    {
        openmp::NoteFunction* const note = openmp::find_note_function(kernel_);
        const auto quads = segment_quads(set, packed_);
        std::vector<CrossedTets> walks;
        for (std::size_t i = 0; i < set.rays.size(); ++i) {
            openmp::Crossings noted;
            note(packed_, kernel_.task == Task::absorb, quads[i], quads[set.rays.size() + i], packed_.tet_count + 1,
                 noted);
            walks.push_back({std::move(noted.tets), std::move(noted.places)});
        }
        return walks;
    }
    [[nodiscard]] Verdicts judged(const RaySet& set, const std::vector<Hit>& answers,
                                  const std::vector<CrossedTets>& walks) const
    {
        return judge_crossings(
            kernel_.task, scene_, set, answers, mesh_of_packed_, [&](std::size_t i) { return walks[i]; }, 2);
    }

private:
    const Scene& scene_;
    KernelId kernel_;
    PackedScene packed_;
    std::vector<std::uint32_t> mesh_of_packed_;
};

/// A neighbour of a tet that the walk does not cross; NO_TET if there is none.
[[nodiscard]] inline std::uint32_t other_neighbour(const Scene& scene, const CrossedScene& tets,
                                                   const CrossedTets& walk, std::uint32_t tet)
{
    for (const std::uint32_t across : scene.tets.tets[tets.mesh_of_packed()[tet]].neighbours) {
        if (across == NO_HALF_FACE) continue;
        const std::uint32_t other = tets.packed().packed_of_mesh[half_face_tet(across)];
        if (std::ranges::find(walk.tets, other) == walk.tets.end()) return other;
    }
    return NO_TET;
}

/// Leaves out a tet of a walk, and the place where the walk leaves it.
inline void drop(CrossedTets& walk, std::size_t i)
{
    walk.tets.erase(walk.tets.begin() + static_cast<std::ptrdiff_t>(i));
    walk.places.erase(walk.places.begin() + static_cast<std::ptrdiff_t>(i) + 1);
}

} // namespace tetrace::test
