#include "bench/debugging/ray_steps.h"

#include "bench/measuring/verify.h"
#include "bench/rows/ray_store.h"
#include "bench/rows/row_tracing.h"
#include "bench/terminal/progress.h"
#include "bench/truth/walk_path.h"
#include "core/device/given_quads.h"
#include "core/mesh/tet_mesh.h"
#include "core/rays/ray_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tetrace {

namespace {

using Numbers = std::vector<float>;

std::uint32_t bits(float number)
{
    return std::bit_cast<std::uint32_t>(number);
}

/// Sums and products of many pairs of numbers, by the device.
class Arithmetic {
public:
    explicit Arithmetic(const RunOperations& run) : run_(run) {}

    [[nodiscard]] Numbers sum(const Numbers& a, const Numbers& b) const
    {
        return each(a, b, [](float x, float y) { return Quad{PROBE_ADD, bits(x), bits(y), 0}; });
    }
    /// -b is exact on the host.
    [[nodiscard]] Numbers difference(const Numbers& a, const Numbers& b) const
    {
        return each(a, b, [](float x, float y) { return Quad{PROBE_ADD, bits(x), bits(-y), 0}; });
    }
    [[nodiscard]] Numbers product(const Numbers& a, const Numbers& b) const
    {
        return each(a, b, [](float x, float y) { return Quad{PROBE_MULTIPLY, bits(x), 0, bits(y)}; });
    }

private:
    template <class Operation>
    [[nodiscard]] Numbers each(const Numbers& a, const Numbers& b, const Operation& operation) const
    {
        std::vector<Quad> quads;
        for (std::size_t i = 0; i < a.size(); ++i)
            quads.push_back(operation(a[i], b[i]));
        Numbers results;
        for (const std::uint32_t word : run_(quads))
            results.push_back(std::bit_cast<float>(word));
        results.resize(a.size());
        return results;
    }

    const RunOperations& run_;
};

/// The vectors after one another, so that one program computes them all.
Numbers joined(const std::vector<Numbers>& parts)
{
    Numbers all;
    for (const Numbers& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Numbers> parted(const Numbers& all, std::size_t parts)
{
    std::vector<Numbers> result;
    const auto size = static_cast<std::ptrdiff_t>(all.size() / parts);
    for (std::size_t i = 0; i < parts; ++i) {
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(i) * size;
        result.emplace_back(first, first + size);
    }
    return result;
}

} // namespace

std::vector<float> side_products(const Float3& origin, const Float3& direction, const std::vector<PassedEdge>& edges,
                                 const RunOperations& run)
{
    if (edges.empty()) return {};
    const Arithmetic device(run);
    std::vector<Numbers> ends, origins, directions; // a.x, a.y, a.z, b.x, b.y, b.z
    for (const auto end : {&PassedEdge::a, &PassedEdge::b})
        for (int axis = 0; axis < 3; ++axis) {
            Numbers& numbers = ends.emplace_back();
            for (const PassedEdge& edge : edges)
                numbers.push_back((edge.*end)[axis]);
            origins.emplace_back(edges.size(), origin[axis]);
        }
    for (int axis = 0; axis < 3; ++axis)
        directions.emplace_back(edges.size(), direction[axis]);
    const auto p = parted(device.difference(joined(ends), joined(origins)), 6);
    // The products of p x q: y z, z x, x y, then z y, x z, y x.
    const Numbers left = joined({p[1], p[2], p[0], p[2], p[0], p[1]}),
                  right = joined({p[5], p[3], p[4], p[4], p[5], p[3]});
    const auto terms = parted(device.product(left, right), 2);
    const Numbers cross = device.difference(terms[0], terms[1]);
    const auto weighted = parted(device.product(joined(directions), cross), 3);
    return device.sum(device.sum(weighted[0], weighted[1]), weighted[2]);
}

namespace {

/// The scene's tet at a position of the packed scene.
std::optional<std::uint32_t> tet_of_mesh(const PackedScene& packed, std::uint32_t position)
{
    const auto found = std::ranges::find(packed.packed_of_mesh, position);
    if (found == packed.packed_of_mesh.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - packed.packed_of_mesh.begin());
}

std::optional<std::uint32_t> face_towards(const Tet& tet, std::uint32_t next)
{
    for (std::uint32_t face = 0; face < 4; ++face)
        if (tet.neighbours[face] != NO_HALF_FACE && half_face_tet(tet.neighbours[face]) == next) return face;
    return std::nullopt;
}

/// The face of the walk's last tet, from its hit. has_end: the ray may end inside the tet.
void end_with(RayStep& step, const Tet& tet, const Hit& hit, bool has_end, const Scene& scene)
{
    if (hit.face_id == LOST) {
        step.beyond = "the ray is lost here";
        return;
    }
    const bool hits = hit.face_id != NO_HIT;
    step.beyond = hits ? fmt::format("triangle {}", source_triangle(scene, hit.face_id)) : "outside";
    std::uint32_t count = 0;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const bool fits = hits ? tet.faces[face] == hit.face_id : tet.neighbours[face] == NO_HALF_FACE;
        if (!fits) continue;
        step.face = face;
        ++count;
    }
    const bool may_end_here = has_end && !hits;
    if (may_end_here) step.beyond = count > 0 ? "outside, or the ray ends here" : "the ray ends here";
    // Several faces of the tet lie in the triangle or on the boundary.
    if (count > 1 || may_end_here) step.face.reset();
}

std::vector<RayStep> steps_of(const std::vector<std::uint32_t>& path, const Hit& hit, bool is_cut, bool has_end,
                              const PackedScene& packed, const Scene& scene)
{
    const TetMesh& mesh = scene.tets;
    std::vector<RayStep> steps;
    for (const std::uint32_t position : path) {
        RayStep& step = steps.emplace_back();
        step.tet = tet_of_mesh(packed, position);
        if (!step.tet) step.beyond = fmt::format("{} is not a tet of the scene", position);
    }
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        RayStep& step = steps[i];
        if (!step.tet) continue;
        if (steps[i + 1].tet) step.face = face_towards(mesh.tets[*step.tet], *steps[i + 1].tet);
        step.beyond = step.face ? fmt::format("tet {}", *steps[i + 1].tet) : "no neighbour of the next tet";
    }
    if (steps.empty() || !steps.back().tet) return steps;
    if (is_cut)
        steps.back().beyond = "not followed further";
    else
        end_with(steps.back(), mesh.tets[*steps.back().tet], hit, has_end, scene);
    return steps;
}

/// The edges of the steps' faces, three per step that has a face.
std::vector<PassedEdge> edges_of(const std::vector<RayStep>& steps, const TetMesh& mesh)
{
    std::vector<PassedEdge> edges;
    for (const RayStep& step : steps) {
        if (!step.face) continue;
        const auto corner = [&](std::size_t i) {
            return mesh.vertices[mesh.tets[*step.tet].vertices[face_corners[*step.face][i % 3]]];
        };
        for (std::size_t i = 0; i < 3; ++i)
            edges.push_back({corner(i), corner(i + 1)});
    }
    return edges;
}

void add_products(RayOnDevice& ray, const PixelRay& line, const TetMesh& mesh)
{
    const RowRun& row = *ray.row;
    const auto products =
        side_products(line.origin, line.direction, edges_of(ray.steps, mesh), [&](std::span<const Quad> operations) {
            return row.backend->probe(row.key.device, row.key.kernel.math, operations);
        });
    auto next = products.begin();
    for (RayStep& step : ray.steps)
        if (step.face)
            for (float& product : step.products)
                product = *next++;
}

float flush_tiny(float component)
{
    return std::fabs(component) < 0x1p-20f ? 0.0f : component; // as in kernels/ray.h
}

} // namespace

const RaySet& rays_of(SceneWork& scene, const RowKey& key, std::size_t view)
{
    return scene.given_rays().set(scene, key.rays, key.ray_order, view);
}

std::size_t number_of_ray(SceneWork& scene, const RowKey& key, std::size_t view, const ImagePixel& pixel)
{
    const std::uint32_t number = pixel.y * scene.width() + pixel.x;
    if (!traits_of(key.kernel.task).takes_rays) return number;
    const auto& rays = rays_of(scene, key, view).rays;
    const auto found = std::ranges::find(rays, number, &GivenRay::pixel);
    if (found == rays.end())
        throw Error(ErrorKind::usage,
                    fmt::format("--pixel: {},{} makes no {} ray: its primary ray hits nothing, or meets the surface so "
                                "flat that none starts there (docs/spec/given-rays.md)",
                                pixel.x, pixel.y, name_of(key.rays)));
    return static_cast<std::size_t>(found - rays.begin());
}

namespace {

/// A single pixel, or as few rays as a session takes, all of them this one. The session has other rays afterwards.
Hit trace_alone(RowRun& row, const TraceJob& image, std::size_t view, std::size_t number, const ImagePixel& pixel)
{
    if (!traits_of(row.key.kernel.task).takes_rays) {
        Hit hit{};
        static_cast<void>(row.session->trace(single_pixel(image, pixel.x, pixel.y), {&hit, 1}));
        return hit;
    }
    RaySet set = rays_of(*row.scene, row.key, view);
    set.rays.assign(TILE_WIDTH, GivenRay(set.rays[number]));
    row.views_of_rays.clear();
    row.session->set_rays(row.key.kernel.structure == Structure::cdt
                              ? given_quads(set, row.packed->data)
                              : given_quads_offset(set, row.scene->loaded().scene.mesh));
    std::vector<Hit> hits(TILE_WIDTH);
    static_cast<void>(row.session->trace(given_job(hits.size(), image.max_steps, set.any_hit), hits));
    return hits.front();
}

} // namespace

PixelRay ray_of(const View& view, const ImagePixel& pixel)
{
    TraceJob job;
    job.view = view;
    PixelRay ray{view.origin, single_pixel(job, pixel.x, pixel.y).view.corner};
    for (int axis = 0; axis < 3; ++axis)
        ray.direction[axis] = flush_tiny(ray.direction[axis]);
    return ray;
}

PixelRay ray_of(SceneWork& scene, const RowKey& key, std::size_t view, const ImagePixel& pixel)
{
    if (!traits_of(key.kernel.task).takes_rays) return ray_of(scene.views()[view], pixel);
    const GivenRay& ray = rays_of(scene, key, view).rays[number_of_ray(scene, key, view, pixel)];
    const bool is_offset = key.kernel.structure != Structure::cdt;
    return {is_offset ? offset_origin(ray, scene.loaded().scene.mesh) : ray.origin, ray.direction, ray};
}

RayOnDevice follow_ray(RowRun& row, std::size_t view, const ImagePixel& pixel)
{
    const std::size_t number = number_of_ray(*row.scene, row.key, view, pixel);
    const PixelRay line = ray_of(*row.scene, row.key, view, pixel);
    const TraceJob image = prepare_view(row, view);
    std::vector<Hit> hits(ray_count(row, view));
    RayOnDevice ray;
    ray.row = &row;
    const auto trace = [&](std::uint32_t cap) {
        TraceJob job = image;
        job.max_steps = cap;
        const std::uint32_t shown = std::min(ray.hit.steps, max_shown_steps); // 0 at first: not known
        progress_line().show("following the ray on " + row.backend->name(),
                             shown == 0 ? -1 : static_cast<double>(cap) / shown);
        static_cast<void>(row.session->trace(job, hits));
        return hits[number];
    };
    ray.hit = trace(image.max_steps);
    if (row.key.kernel.structure == Structure::cdt) {
        const bool has_end = line.given && line.given->end < NO_END;
        const auto path = walk_path(ray.hit, image.max_steps, trace, max_shown_steps);
        ray.is_cut = ray.hit.steps > max_shown_steps;
        ray.steps = steps_of(path, ray.hit, ray.is_cut, has_end, row.packed->data, row.scene->loaded().scene);
        add_products(ray, line, row.scene->loaded().scene.tets);
    } else
        ray.visits = count_visits_of_ray(row, view, hits, number, row.scene->threads());
    ray.alone = trace_alone(row, image, view, number, pixel);
    for (Hit* hit : {&ray.hit, &ray.alone})
        hit->tet = tet_of_mesh(row.packed->data, hit->tet).value_or(NO_TET);
    progress_line().clear();
    return ray;
}

std::optional<std::size_t> first_difference(const RayOnDevice& a, const RayOnDevice& b)
{
    for (std::size_t i = 0; i < std::max(a.steps.size(), b.steps.size()); ++i)
        if (i >= a.steps.size() || i >= b.steps.size() || a.steps[i].tet != b.steps[i].tet ||
            a.steps[i].face != b.steps[i].face)
            return i;
    return std::nullopt;
}

} // namespace tetrace
