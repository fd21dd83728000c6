#include "bench/output/check_differences.h"

#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using Path = std::vector<std::uint32_t>;

constexpr std::size_t shown_tets = 200;

std::string face_text(std::uint32_t face)
{
    if (face == NO_HIT) return "no hit";
    if (face == LOST) return "lost";
    return fmt::format("triangle {}", face);
}

std::string hit_text(const Hit& hit)
{
    const std::string tet = hit.tet == NO_TET ? "no tet" : fmt::format("tet {}", hit.tet);
    return fmt::format("{}, t {:.9g}, u {:.9g}, v {:.9g}, {}, {} steps", face_text(hit.face_id), hit.t, hit.u, hit.v,
                       tet, hit.steps);
}

std::string path_text(const char* title, const Path& path)
{
    if (path.empty()) return {};
    std::string text = fmt::format("  {}:", title);
    for (std::size_t i = 0; i < std::min(path.size(), shown_tets); ++i)
        text += fmt::format(" {}", path[i]);
    if (path.size() > shown_tets) text += fmt::format(" ... ({} in all)", path.size());
    return wrapped(text, 110, 2);
}

/// Where two walks diverge; empty if they do not.
std::string parting_text(const Path& ours, const Path& openmps)
{
    if (ours.empty() || openmps.empty()) return {};
    const auto [own, other] = std::mismatch(ours.begin(), ours.end(), openmps.begin(), openmps.end());
    if (own == ours.end() || other == openmps.end()) return {};
    return fmt::format("  The walks part at step {}: tet {} here, tet {} with openmp.\n", own - ours.begin() + 1, *own,
                       *other);
}

/// "  Step by step: tetrace trace ...", in a line of its own, ready to paste.
std::string command_text(const std::string& command)
{
    return command.empty() ? std::string() : fmt::format("  Step by step: {}\n", command);
}

std::string different_text(const RowRecord& row, const DifferingRay& ray)
{
    const RayWalk& walk = traced(row)->walk_of_different;
    return fmt::format("{}: {} rays differ from openmp's, the first at view {}, pixel ({}, {})\n  this row: {}\n"
                       "  openmp:   {}\n{}{}{}{}\n",
                       row_name(row.key), traced(row)->different, ray.view, ray.x, ray.y, hit_text(ray.ours),
                       hit_text(ray.openmp), path_text("tets of this row", walk.own),
                       path_text("tets of openmp", walk.openmp), parting_text(walk.own, walk.openmp),
                       command_text(walk.command));
}

std::string wrong_text(const RowRecord& row, const WrongRay& ray)
{
    return fmt::format("{}: first wrong ray: view {}, pixel ({}, {}): {}\n  this row:  {}\n  exact ray: "
                       "{}, t {:.9g}\n{}{}\n",
                       row_name(row.key), ray.view, ray.x, ray.y, ray.reason, hit_text(ray.ours),
                       face_text(ray.reference_face), ray.reference_t,
                       path_text("tets of openmp", traced(row)->walk_of_wrong.openmp),
                       command_text(traced(row)->walk_of_wrong.command));
}

} // namespace

std::string differences_text(const RowRecord& row)
{
    const Traced* result = traced(row);
    if (result == nullptr) return {};
    std::string text;
    if (const auto& ray = result->first_different) text += different_text(row, *ray);
    if (const auto& ray = result->verdicts.first_wrong) text += wrong_text(row, *ray);
    return text;
}

} // namespace tetrace
