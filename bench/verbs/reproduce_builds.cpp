#include "bench/verbs/reproduce_builds.h"

#include "bench/reproduce/paper.h"
#include "bench/reproduce/tables/tables.h"

#include <algorithm>
#include <iterator>

namespace tetrace {

namespace {

bool wants_build(const Options& options, PaperBuild build)
{
    const auto& builds = options.paper_builds;
    return builds.empty() || std::ranges::find(builds, build) != builds.end();
}

/// Whether the builder makes its tets: those of cubes, of lattices and of .tet files are their own.
bool is_tetrahedralized(const std::string& name)
{
    return !is_made_in_place(name) && std::filesystem::path(name).extension() != ".tet";
}

/// Whether the scene is one of the paper's, and TetGen makes its tets with the given switches.
bool has_papers_build(const std::string& name)
{
    return paper::has_scene(scene_label(name)) && is_tetrahedralized(name);
}

/// The same scenes in tets for rays, as the options say, and by their own defaults where these say nothing.
std::vector<SceneRequest> requests_for_rays(Options options)
{
    options.tets = {TetsKind::rays};
    return scene_requests(options);
}

SceneBuild papers(SceneBuild build)
{
    BuildOptions& how = build.request.build;
    how.domain = DomainKind::wide;
    how.tets = TetsKind::cdt;
    how.divisions = 1;
    how.switches = paper::nearest_build(build.scene).value().switches;
    build.build = papers_build;
    build.label += "-paper";
    return build;
}

SceneBuild in_rays(SceneBuild build, const SceneRequest& request)
{
    build.request = request;
    build.build = rays_build;
    build.label += "-rays";
    return build;
}

} // namespace

bool wants(const Options& options, PaperTarget target)
{
    return std::ranges::find(options.targets, target) != options.targets.end();
}

bool wants_scenes(const Options& options)
{
    const auto& targets = options.targets;
    return std::ranges::any_of(targets, [](PaperTarget target) { return target != PaperTarget::table5; });
}

std::vector<SceneBuild> scene_builds(const Options& options)
{
    const bool table3 = wants(options, PaperTarget::table3), table6 = wants(options, PaperTarget::table6);
    const bool table4 = wants(options, PaperTarget::table4), figure6 = wants(options, PaperTarget::figure6);
    std::vector<SceneBuild> builds;
    if (!wants_scenes(options)) return builds;
    const auto requests = scene_requests(options), of_rays = requests_for_rays(options);
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const std::string& name = requests[i].name;
        const std::string label = scene_label(name);
        const SceneBuild ours = {
            requests[i], label, our_build, label, table4, table3 || table6 || figure6, table3 || table4 || figure6,
            table6};
        const bool papers_too = wants_build(options, PaperBuild::paper) && has_papers_build(name);
        const bool rays_too = wants_build(options, PaperBuild::rays) && is_tetrahedralized(name);
        const bool has_all = !wants_build(options, PaperBuild::paper) || papers_too;
        if (wants_build(options, PaperBuild::ours) || !has_all || (!papers_too && !rays_too)) builds.push_back(ours);
        if (papers_too) builds.push_back(papers(ours));
        if (rays_too) builds.push_back(in_rays(ours, of_rays[i]));
    }
    return builds;
}

} // namespace tetrace
