#include "bench/results/work_recipe.h"

#include "bench/options/option_values.h"
#include "bench/results/row_keys.h"
#include "bench/terminal/text.h"
#include "core/base/printable.h"
#include "core/rays/camera_set.h"
#include "scenes/pinned.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

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

/// The options that decide tets, if they differ.
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

/// The values of that field in the rows that have times.
std::set<std::string> values_of(const ResultFile& file, const RowPath& field)
{
    std::set<std::string> values;
    const ResultValue section = file.section();
    const std::vector<ResultValue> rows = section.at("rows").items();
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (const auto value = rows[i].find(field); value && !file.rows[i].samples_s.empty())
            values.insert(value->line());
    return values;
}

/// What B takes as A's scene: its own name of the same scene, a pinned one's name, or a .tet file.
std::string scene_for(const ResultFile& b, const ResultFile& a, const std::string& name)
{
    const ResultScene* const scene = a.find_scene(name);
    if (scene == nullptr) return name;
    if (const auto same = std::ranges::find(b.scenes, scene->hash, &ResultScene::hash); same != b.scenes.end())
        return same->name;
    if (const PinnedScene* const pinned = pinned_of(*scene)) return std::string(pinned->name);
    const ResultValue section = a.section();
    for (const ResultValue& one : section.at("scenes").items())
        if (one.at("name").line() == name && one.text_at("file").ends_with(".tet")) return one.at("file").line();
    return name;
}

std::set<std::string> scenes_for(const ResultFile& b, const ResultFile& a, const std::set<std::string>& names)
{
    std::set<std::string> scenes;
    for (const std::string& name : names)
        scenes.insert(scene_for(b, a, name));
    return scenes;
}

} // namespace

std::string WorkRecipe::text() const
{
    const std::string measure =
        options.empty() ? ""
                        : fmt::format("measure B with {}{}", options, usual_tets ? ", without options of tets" : "");
    return measure + (measure.empty() || obstacle.empty() ? "" : "; ") + obstacle;
}

std::string rows_recipe(const ResultFile& a, const ResultFile& b)
{
    if (const std::string command = a.section().text_at("command"); !command.empty())
        return fmt::format("A was measured by `{}`", printable_line(command));
    if (a.head.verb != "bench")
        return a.head.verb == b.head.verb ? "" : fmt::format("measure B with 'tetrace {}'", a.head.verb);
    WorkRecipe recipe;
    for (const RowPath& field : {row_key::scene, row_key::rays, row_key::math, row_key::order, row_key::layout,
                                 row_key::method, row_key::backend}) {
        std::set<std::string> values = values_of(a, field);
        if (field.key == std::string_view(row_key::scene.key)) values = scenes_for(b, a, values);
        if (!std::ranges::includes(values_of(b, field), values))
            add(recipe, fmt::format("--{}", field.key), fmt::format("{}", fmt::join(values, ",")));
    }
    return recipe.text();
}

WorkRecipe work_recipe(const ResultScene& a, const ResultScene& b, bool same_geometry)
{
    WorkRecipe recipe;
    if (!same_geometry) add_scene(recipe, a, b);
    add_rays(recipe, a, b);
    return recipe;
}

} // namespace tetrace
