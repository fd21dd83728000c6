#include "bench/verbs/reproduce_builds.h"

#include "bench/reproduce/paper.h"
#include "bench/reproduce/tables/tables.h"

#include <algorithm>

namespace tetrace {

namespace {

bool wants_build(const Options& options, PaperBuild build)
{
    const auto& builds = options.paper_builds;
    return builds.empty() || std::ranges::find(builds, build) != builds.end();
}

/// Whether the scene is one of the paper's, and TetGen makes its tets with the given switches.
bool has_papers_build(const std::string& name)
{
    if (!paper::has_scene(scene_label(name))) return false;
    const CatalogueEntry* entry = find_in_catalogue(name);
    if (entry != nullptr) return entry->source != SceneSource::cubes;
    return std::filesystem::path(name).extension() != ".tet";
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

/// The builds of the scenes asked for.
std::vector<SceneBuild> paper_builds(const Options& options)
{
    const bool table3 = wants(options, PaperTarget::table3), table6 = wants(options, PaperTarget::table6);
    const bool table4 = wants(options, PaperTarget::table4), figure6 = wants(options, PaperTarget::figure6);
    std::vector<SceneBuild> builds;
    if (!wants_scenes(options)) return builds;
    for (const SceneRequest& request : scene_requests(options)) {
        const std::string label = scene_label(request.name);
        const SceneBuild ours = {
            request, label, our_build, label, table4, table3 || table6 || figure6, table3 || table4 || figure6, table6};
        const bool is_papers = has_papers_build(request.name);
        if (wants_build(options, PaperBuild::ours) || !is_papers) builds.push_back(ours);
        if (wants_build(options, PaperBuild::paper) && is_papers) builds.push_back(papers(ours));
    }
    return builds;
}

/// Scenes in several sizes: banana and cubes where asked for, else banana.
void add_growth_builds(std::vector<SceneBuild>& builds, const Options& options)
{
    static const std::vector<std::uint32_t> cubes_sizes = {4, 8, 16, 32, 64};
    Options of_families = options;
    std::erase_if(of_families.scenes, [](const std::string& name) { return name != "banana" && name != "cubes"; });
    if (of_families.scenes.empty()) of_families.scenes = {"banana"};
    for (const SceneRequest& request : scene_requests(of_families)) {
        const auto& standard = request.name == "cubes" ? cubes_sizes : growth_sizes();
        for (SceneBuild& build : growth_builds(request, options.sizes.empty() ? standard : options.sizes))
            builds.push_back(std::move(build));
    }
}

} // namespace

bool wants(const Options& options, PaperTarget target)
{
    return std::ranges::find(options.targets, target) != options.targets.end();
}

bool wants_scenes(const Options& options)
{
    const auto& targets = options.targets;
    return std::ranges::any_of(
        targets, [](PaperTarget target) { return target != PaperTarget::table5 && target != PaperTarget::growth; });
}

std::vector<SceneBuild> scene_builds(const Options& options)
{
    auto builds = paper_builds(options);
    if (wants(options, PaperTarget::growth)) add_growth_builds(builds, options);
    return builds;
}

Options options_of_build(const SceneBuild& build, Options options)
{
    if (build.build == growth_build && options.views.empty() && options.camera_set == CameraSet::flight)
        options.views = growth_views;
    return options;
}

} // namespace tetrace
