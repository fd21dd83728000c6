#include "bench/results/work_recipe.h"

#include "scenes/pinned.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

const PinnedScene* pinned_of(const ResultScene& scene)
{
    std::uint64_t hash = 0;
    std::from_chars(scene.hash.data(), scene.hash.data() + scene.hash.size(), hash, 16);
    return pinned_with(hash);
}

/// "0-3": consecutive views as ranges.
std::string views_text(const std::vector<std::uint64_t>& views)
{
    std::string text;
    for (std::size_t i = 0; i < views.size();) {
        std::size_t end = i + 1;
        while (end < views.size() && views[end] == views[end - 1] + 1)
            ++end;
        text += fmt::format("{}{}", text.empty() ? "" : ",", views[i]);
        if (end > i + 1) text += fmt::format("-{}", views[end - 1]);
        i = end;
    }
    return text;
}

void add(WorkRecipe& recipe, const std::string& option, const std::string& value)
{
    recipe.options += fmt::format("{}{} {}", recipe.options.empty() ? "" : " ", option, value);
}

/// The options that decide tets, where they differ; false if none does.
bool add_build(WorkRecipe& recipe, const ResultScene& a, const ResultScene& b)
{
    const std::size_t before = recipe.options.size();
    const auto kind_of = [](const ResultScene& scene) { return scene.tets_kind.empty() ? "cdt" : scene.tets_kind; };
    if (kind_of(a) != kind_of(b)) add(recipe, "--tets", kind_of(a));
    if (a.domain != b.domain) add(recipe, "--domain", a.domain);
    if (a.divisions != b.divisions) add(recipe, "--divisions", std::to_string(a.divisions));
    if (a.effort && b.effort && a.effort != b.effort) add(recipe, "--effort", std::to_string(*a.effort));
    if (kind_of(a) == kind_of(b) && a.switches != b.switches) add(recipe, "--switches", a.switches);
    return recipe.options.size() > before;
}

void add_scene(WorkRecipe& recipe, const ResultScene& a, const ResultScene& b)
{
    if (a.hash == b.hash) return;
    if (const PinnedScene* const pinned = pinned_of(a)) {
        add(recipe, "--scene", std::string(pinned->name));
        return;
    }
    if (!a.source_hash.empty() && !b.source_hash.empty() && a.source_hash != b.source_hash)
        recipe.obstacle = fmt::format("A's {} was made from another mesh file, of hash {}", a.name, a.source_hash);
    else if (!add_build(recipe, a, b))
        recipe.obstacle = fmt::format("the same options made other tets of {} in A's version of tetrace, which are "
                                      "not pinned; only its BVH rows compare",
                                      a.name);
}

void add_rays(WorkRecipe& recipe, const ResultScene& a, const ResultScene& b)
{
    const bool other_set = a.camera_set != b.camera_set, other_numbers = a.camera_set_hash != b.camera_set_hash;
    const bool other_mesh = !a.source_hash.empty() && a.source_hash != b.source_hash; // frame depends on it
    if (other_set)
        add(recipe, "--camera-set", a.camera_set);
    else if (other_numbers && !other_mesh && recipe.obstacle.empty())
        recipe.obstacle = fmt::format("the cameras of {} had other numbers in A", a.camera_set);
    if (a.views != b.views) add(recipe, "--views", views_text(a.views));
    if (a.width != b.width || a.height != b.height) add(recipe, "--size", fmt::format("{}x{}", a.width, a.height));
}

} // namespace

std::string WorkRecipe::text() const
{
    const std::string measure = options.empty() ? "" : "measure B with " + options;
    return measure + (measure.empty() || obstacle.empty() ? "" : "; ") + obstacle;
}

WorkRecipe work_recipe(const ResultScene& a, const ResultScene& b)
{
    WorkRecipe recipe;
    add_scene(recipe, a, b);
    add_rays(recipe, a, b);
    return recipe;
}

} // namespace tetrace
