#include "bench/results/work_recipe.h"

#include "bench/options/option_values.h"
#include "bench/terminal/text.h"
#include "core/rays/camera_set.h"
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

/// The texts are of a file, and become a part of a command line.
void add(WorkRecipe& recipe, const std::string& option, const std::string& value)
{
    if (value.empty()) return;
    recipe.options += fmt::format("{}{} {}", recipe.options.empty() ? "" : " ", option, shell_word(value));
}

/// Results before the key have CDTs.
std::string kind_of(const ResultScene& scene)
{
    return scene.tets_kind.empty() ? "cdt" : scene.tets_kind;
}

/// The options that decide tets, where they differ.
void add_build(WorkRecipe& recipe, const ResultScene& a, const ResultScene& b)
{
    if (kind_of(a) != kind_of(b)) add(recipe, "--tets", kind_of(a));
    if (a.domain != b.domain) add(recipe, "--domain", a.domain);
    if (a.divisions != b.divisions && a.divisions > 0) add(recipe, "--divisions", std::to_string(a.divisions));
    if (a.effort && b.effort && a.effort != b.effort) add(recipe, "--effort", std::to_string(*a.effort));
    if (kind_of(a) == kind_of(b) && a.switches != b.switches) add(recipe, "--switches", a.switches);
}

void add_scene(WorkRecipe& recipe, const ResultScene& a, const ResultScene& b)
{
    if (const PinnedScene* const pinned = pinned_of(a)) {
        add(recipe, "--scene", std::string(pinned->name));
        if (kind_of(b) != "rays" || a.effort != b.effort || a.domain != b.domain || a.divisions != b.divisions)
            recipe.usual_tets = true;
        return;
    }
    if (!a.source_hash.empty() && !b.source_hash.empty() && a.source_hash != b.source_hash) {
        recipe.obstacle = fmt::format("A's {} was made from another mesh file, of hash {}", a.name, a.source_hash);
        return;
    }
    add_build(recipe, a, b);
    if (recipe.options.empty() || kind_of(a) == "rays")
        recipe.obstacle =
            fmt::format("A's version of tetrace may have made other tets of {} with the same options, and "
                        "they are not pinned; its BVH rows compare in any case",
                        a.name);
}

void add_rays(WorkRecipe& recipe, const ResultScene& a, const ResultScene& b)
{
    const bool is_known = value_named<CameraSet>(a.camera_set).has_value();
    const bool other_mesh = !a.source_hash.empty() && a.source_hash != b.source_hash; // frame depends on it
    const bool other_numbers = a.camera_set_hash != b.camera_set_hash && !other_mesh;
    if (is_known && a.camera_set != b.camera_set)
        add(recipe, "--camera-set", a.camera_set);
    else if (a.camera_set != b.camera_set || other_numbers)
        recipe.obstacle += fmt::format("{}A's cameras are those of {}, of hash {}", recipe.obstacle.empty() ? "" : "; ",
                                       a.camera_set, a.camera_set_hash);
    if (a.views != b.views) add(recipe, "--views", views_text(a.views));
    if (a.width != b.width || a.height != b.height) add(recipe, "--size", fmt::format("{}x{}", a.width, a.height));
}

} // namespace

std::string WorkRecipe::text() const
{
    const std::string measure =
        options.empty() ? ""
                        : fmt::format("measure B with {}{}", options, usual_tets ? ", without options of tets" : "");
    return measure + (measure.empty() || obstacle.empty() ? "" : "; ") + obstacle;
}

WorkRecipe work_recipe(const ResultScene& a, const ResultScene& b, bool same_geometry)
{
    WorkRecipe recipe;
    if (!same_geometry) add_scene(recipe, a, b);
    add_rays(recipe, a, b);
    return recipe;
}

} // namespace tetrace
