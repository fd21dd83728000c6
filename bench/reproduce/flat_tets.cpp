#include "bench/reproduce/flat_tets.h"

#include "bench/truth/walk_path.h"

#include <algorithm>

namespace tetrace {

double flatness(const TetMesh& mesh, std::size_t tet)
{
    std::array<Double3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = to_double(mesh.vertices[mesh.tets[tet].vertices[i]]);
    double longest = 0, widest = 0; // twice the area
    for (std::size_t i = 0; i < 4; ++i) {
        const Double3 a = corners[(i + 1) % 4], b = corners[(i + 2) % 4], c = corners[(i + 3) % 4];
        widest = std::max(widest, length(cross(b - a, c - a)));
        for (std::size_t j = i + 1; j < 4; ++j)
            longest = std::max(longest, length(corners[i] - corners[j]));
    }
    const Double3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], ad = corners[3] - corners[0];
    const double six_volumes = std::abs(dot(ab, cross(ac, ad)));
    return widest > 0 ? six_volumes / widest / longest : 0; // an altitude is 3 V / area
}

FlatTets::FlatTets(const SceneWork& scene) : scene_(&scene)
{
    const TetMesh& mesh = scene.loaded().scene.tets;
    for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet)
        flat_.push_back(flatness(mesh, tet) < flat_below);
    count_ = static_cast<std::uint64_t>(std::ranges::count(flat_, true));
}

FlatWalks FlatTets::walks(const RowRun& row, std::size_t view, std::span<const std::uint32_t> pixels)
{
    FlatWalks result;
    if (pixels.empty()) return result;
    const Walker& walker = walker_of(row);
    const std::size_t rays = std::min(pixels.size(), rays_looked_at);
    for (std::size_t i = 0; i < rays; ++i) {
        result.rays += 1;
        result.through_flat += passes_flat(walker, view, pixels[i * pixels.size() / rays]) ? 1 : 0;
    }
    return result;
}

FlatWalks FlatTets::walks_anywhere(const RowRun& row, std::size_t view)
{
    // A multiplicative step spreads few pixels over both axes of the image, for any width.
    constexpr std::uint64_t golden = 2654435769u; // 2^32 over the golden ratio
    std::vector<std::uint32_t> pixels;
    for (std::uint64_t i = 0; i < rays_looked_at; ++i)
        pixels.push_back(
            static_cast<std::uint32_t>(((i + 1) * golden % (std::uint64_t{1} << 32)) * scene_->rays_per_view() >> 32));
    return walks(row, view, pixels);
}

FlatTets::Walker& FlatTets::walker_of(const RowRun& row)
{
    KernelId kernel = row.key.kernel;
    kernel.schedule = Schedule::tiles;
    for (Walker& walker : walkers_)
        if (walker.kernel == kernel && walker.packed == row.packed) return walker;
    auto session =
        reference_backend().open(0, kernel, {&scene_->loaded().scene.mesh, &row.packed->data}, {.threads = 1});
    walkers_.push_back({kernel, row.packed, std::move(session)});
    std::vector<bool>& flat = flat_packed_[row.packed];
    if (flat.empty()) {
        flat.resize(flat_.size());
        for (std::size_t tet = 0; tet < flat_.size(); ++tet)
            flat[row.packed->data.packed_of_mesh[tet]] = flat_[tet];
    }
    return walkers_.back();
}

bool FlatTets::passes_flat(const Walker& walker, std::size_t view, std::uint32_t pixel) const
{
    const TraceJob job = scene_->job(view, &walker.packed->data);
    const std::vector<bool>& flat = flat_packed_.at(walker.packed);
    const auto path = walk_path(*walker.session, job, pixel % job.width, pixel / job.width, steps_looked_at);
    return std::ranges::any_of(path, [&](std::uint32_t tet) { return flat.at(tet); });
}

} // namespace tetrace
