#include "bench/options/workload.h"

#include "bench/options/option_values.h"
#include "scenes/catalogue.h"

#include <algorithm>

namespace tetrace {

const std::vector<Workload>& workloads()
{
    static const std::vector<std::string> scenes = {"bunny-1", "armadillo-1", "atrium-1"};
    static const std::vector<Workload> all = {
        {"default-2026.11", "what bench measures without other options", scenes, "0,1", 1024, {{RayKind::primary}}},
        {"score-2026.11",
         "primary rays, one bounce, and lines through the scene: what a score is of",
         scenes,
         "0,1",
         512,
         {{RayKind::primary},
          {RayKind::diffuse, {0x5dd41d1c38a58059, 0xd0238565bb3f7a01, 0xf000e3a506b00b7e}},
          {RayKind::random, {0x99f83c2fbe2126bc, 0xb2e7e7dee01bba60, 0x09afe474ad85d394}}}}};
    return all;
}

std::vector<std::string> workload_names()
{
    std::vector<std::string> names;
    for (const Workload& workload : workloads())
        names.emplace_back(workload.name);
    return names;
}

std::string default_scene(const std::string& row)
{
    for (const std::string& scene : workloads().front().scenes)
        if (scene_label(scene) == row) return scene;
    return row;
}

void apply_workload(Options& options, const std::string& name)
{
    const auto found = std::ranges::find(workloads(), name, &Workload::name);
    if (found == workloads().end()) reject_name("--workload", name, workload_names());
    options.scenes = found->scenes;
    options.views = found->views;
    options.width = options.height = found->size;
    for (const Workload::Rays& rays : found->rays)
        options.rays.push_back(rays.kind);
}

} // namespace tetrace
