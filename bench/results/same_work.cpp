#include "bench/results/same_work.h"

#include "core/base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

std::string rays_text(const ResultScene& scene)
{
    const std::string hash = scene.camera_set_hash.empty() ? "" : " " + scene.camera_set_hash;
    return fmt::format("{} views of {}{} at {}x{}", scene.views.size(), scene.camera_set, hash, scene.width,
                       scene.height);
}

std::string other_rays(const ResultScene& a, const ResultScene& b)
{
    if (a.hash != b.hash) return fmt::format("the scene {} has hash {} in A and {} in B", a.name, a.hash, b.hash);
    if (rays_text(a) != rays_text(b)) return fmt::format("{} in A, {} in B", rays_text(a), rays_text(b));
    if (a.views != b.views) return fmt::format("other views of {} in A than in B", a.camera_set);
    return {};
}

std::string other_searches(const ResultFile& a, const ResultFile& b)
{
    if (a.search_size == b.search_size) return {};
    return fmt::format("{} searches in A, {} in B", a.search_size, b.search_size);
}

/// On a GPU, views that are traced together take less time than views with a launch each.
std::string launches_of(const ResultFile& file, const ResultRow& row)
{
    if (row.device_kind != DeviceKind::gpu || row.scene.empty()) return {};
    return row.launches == 0 || row.launches == scene_of(file, row).views.size()
               ? "a launch for each view"
               : fmt::format("all views in {} launch{}", row.launches, row.launches == 1 ? "" : "es");
}

std::string other_launches(const std::string& a, const std::string& b)
{
    return a == b ? std::string() : fmt::format("{} in A, {} in B", a, b);
}

/// Merged shards have only the hash of their views.
std::string other_answers(const ResultRow& a, const ResultRow& b)
{
    const bool have_hits = !a.hit_hash.empty() && !b.hit_hash.empty();
    const bool have_views = !a.views_hash.empty() && !b.views_hash.empty();
    const auto hash = have_views && !have_hits ? &ResultRow::views_hash : &ResultRow::hit_hash;
    if ((a.*hash).empty() || (b.*hash).empty()) return fmt::format("no hit hash in {}", (a.*hash).empty() ? "A" : "B");
    return a.*hash == b.*hash ? std::string() : fmt::format("hit hash {} in A and {} in B", a.*hash, b.*hash);
}

} // namespace

const ResultScene& scene_of(const ResultFile& file, const ResultRow& row)
{
    if (const ResultScene* scene = file.find_scene(row.scene)) return *scene;
    throw Error(ErrorKind::invalid_input,
                fmt::format("reading the result '{}': the row {} was timed on the scene '{}', which is not among "
                            "tetrace.scenes",
                            file.path.string(), row.name, row.scene));
}

std::string different_work(const ResultFile& a, const ResultRow& row_a, const ResultFile& b, const ResultRow& row_b)
{
    std::string difference =
        row_a.scene.empty() ? other_searches(a, b) : other_rays(scene_of(a, row_a), scene_of(b, row_b));
    if (difference.empty()) difference = other_launches(launches_of(a, row_a), launches_of(b, row_b));
    return difference.empty() ? other_answers(row_a, row_b) : difference;
}

std::string rays_of(const ResultFile& file, const ResultRow& row)
{
    if (row.scene.empty()) return file.search_size;
    const ResultScene& scene = scene_of(file, row);
    return fmt::format("{} {} of {}: {}", scene.hash, rays_text(scene), scene.name, fmt::join(scene.views, ","));
}

std::string work_of(const ResultFile& file, const ResultRow& row)
{
    const std::string& hash =
        row.hit_hash.empty() ? row.views_hash : row.hit_hash; // merged shards have only the latter
    return hash.empty() ? std::string()
                        : fmt::format("{} {} {} {}", row.name, hash, rays_of(file, row), launches_of(file, row));
}

} // namespace tetrace
