#include "scenes/builder/build.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/mesh/entry_grid.h"
#include "scenes/builder/empty_triangles.h"
#include "scenes/builder/failure.h"
#include "scenes/builder/kept_regions.h"
#include "scenes/builder/mesh_reader.h"
#include "scenes/builder/repair/repair.h"
#include "scenes/builder/repair/self_intersection.h"
#include "scenes/optimise/graded_points.h"
#include "scenes/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

namespace tetrace {

std::size_t count_pieces(const TriangleMesh& mesh)
{
    std::vector<std::uint32_t> towards(mesh.vertices.size()); // another vertex of the piece, or itself
    std::iota(towards.begin(), towards.end(), 0u);
    const auto end_of = [&](std::uint32_t vertex) {
        while (towards[vertex] != vertex)
            vertex = towards[vertex] = towards[towards[vertex]];
        return vertex;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        towards[end_of(b)] = end_of(a);
        towards[end_of(c)] = end_of(a);
    }
    std::vector<bool> is_piece(mesh.vertices.size());
    for (const auto& triangle : mesh.triangles)
        is_piece[end_of(triangle[0])] = true;
    return static_cast<std::size_t>(std::count(is_piece.begin(), is_piece.end(), true));
}

namespace {

using Kind = TetMeshDefect::Kind;

void note_clean_up(const CleanUp& cleaned, const std::string& why, const BuilderTalk& talk)
{
    const auto note = [&](std::uint64_t count, const char* what) {
        if (count > 0) talk.note(fmt::format("{} {}{}", count, what, why));
    };
    note(cleaned.merged_vertices, "vertices merged with one at the same place");
    note(cleaned.unused_vertices, "vertices of no triangle dropped");
    note(cleaned.degenerate_triangles, "triangles without area dropped");
    note(cleaned.duplicate_triangles, "duplicate triangles dropped");
}

void clean(Scene& scene, const std::string& why, const BuilderTalk& talk)
{
    if (const std::uint64_t split = split_at_empty_triangles(scene.mesh, scene.origins); split > 0)
        talk.note(
            fmt::format("{} triangles split where a neighbour has no area{}, so that no gap is left", split, why));
    const CleanUp cleaned = clean_up(scene.mesh, scene.origins);
    note_clean_up(cleaned, why, talk);
    scene.build.merged_vertices += cleaned.merged_vertices;
    scene.build.degenerate_triangles += cleaned.degenerate_triangles;
    scene.build.duplicate_triangles += cleaned.duplicate_triangles;
    if (scene.mesh.triangles.empty())
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("cleaning {}: no triangle has an area; check the mesh's coordinates", scene.build.source));
}

void note_rounding(const MeshSoup& soup, const BuilderTalk& talk)
{
    if (soup.centre != Double3{})
        talk.note(fmt::format("the coordinates are large for the mesh's size: ({}, {}, {}), the centre of its bounding "
                              "box, was subtracted before they were rounded to float",
                              soup.centre.x, soup.centre.y, soup.centre.z));
    if (soup.merged_by_rounding == 0) return;
    const auto [low, high] = bounding_box(soup.mesh);
    talk.note(fmt::format("rounding to float put {} vertices at the place of another; it moved vertices by at most "
                          "{:.3g}, {:.2g} of the bounding box's diagonal",
                          soup.merged_by_rounding, soup.rounding, soup.rounding / length(high - low)));
}

void read(const std::filesystem::path& path, Scene& scene, OwnTets& own, const BuilderTalk& talk)
{
    MeshSoup soup = read_mesh(path);
    for (const std::string& note : soup.notes)
        talk.note(note);
    note_rounding(soup, talk);
    scene.mesh = std::move(soup.mesh);
    own = {std::move(soup.tets), std::move(soup.source_tets), {}, {}};
    scene.build.source_hash = soup.source_hash;
    scene.build.centre = soup.centre;
    scene.build.rounding = soup.rounding;
}

/// keep: whether triangles stay though rounding leaves them without area, as those of tets do until these are checked.
void place_mesh(Scene& scene, const BuilderOptions& options, bool keep, const BuilderTalk& talk)
{
    const Placement placement = place(scene.mesh, options.domain);
    scene.build.scale_exponent = placement.scale_exponent;
    scene.build.snapped_coordinates = placement.snapped_coordinates;
    if (placement.snapped_coordinates > 0) {
        scene.build.rounding += placement.moved;
        talk.note(
            fmt::format("{} coordinates near 0 rounded to the grid of 2^-40, which moved vertices by at most {:.3g}",
                        placement.snapped_coordinates, placement.moved));
        if (!keep) clean(scene, " after rounding to the grid", talk);
    }
}

void add_domain(Scene& scene, const BuilderOptions& options)
{
    scene.domain = make_domain(scene.mesh, options.domain, options.divisions);
    const Float3 low = scene.domain.low(), high = scene.domain.high();
    for (int axis = 0; axis < 3; ++axis)
        if (low[axis] < -1 || high[axis] > 1)
            throw Error(ErrorKind::internal,
                        "placing the mesh: its domain does not fit [-1, 1]^3; please report this mesh");
}

void require_no_self_intersection(const Scene& scene)
{
    const SelfIntersections found = find_self_intersections(scene.mesh);
    if (found.count > 0)
        throw BuilderFailure(BUILDER_SELF_INTERSECTION,
                             fmt::format("checking {}: {}", scene.build.source, describe(found, scene)));
}

void repair_or_refuse(Scene& scene, const BuilderOptions& options, const BuilderTalk& talk)
{
    scene.build.repair.asked = options.repair;
    if (!options.repair && options.mesh_only) return; // a BVH has no need of it
    if (!options.repair) {
        talk.stage("looking for self-intersections");
        return require_no_self_intersection(scene);
    }
    talk.stage("repairing where triangles cross");
    repair(scene, options.weld, talk.stage);
    if (scene.build.repair.passes > 0) talk.note(repair_text(scene.build));
}

// Most meshes need no repair and lose no triangle: then there is nothing to keep.
void drop_own_numbers(std::vector<std::uint32_t>& origins)
{
    for (std::uint32_t i = 0; i < origins.size(); ++i)
        if (origins[i] != i) return;
    origins.clear();
}

const char* name_of(Kind kind)
{
    switch (kind) {
    case Kind::bad_index: return "indices";
    case Kind::asymmetric_neighbour: return "asymmetric neighbours";
    case Kind::inverted: return "inverted tets";
    case Kind::flat: return "flat tets";
    case Kind::asymmetric_face: return "asymmetric faces";
    case Kind::uncovered_triangle: return "missing input triangles";
    case Kind::open_boundary: return "volume of the domain";
    }
    return "unknown";
}

// Slivers that TetGen itself left without volume, and those that rounding to float made, ask for different switches.
std::string origin_of(const TetMeshDefect& defect, const RawTets& output, const Rounding& rounding)
{
    if (defect.kind != Kind::inverted && defect.kind != Kind::flat) return "";
    const std::uint64_t left = rounding.damaged - rounding.repaired;
    return fmt::format("; {} tets are flat or inverted: {} were so in {}'s double coordinates already, the rest by "
                       "rounding to float",
                       left, std::min(left, output.flat_tets), output.maker);
}

void require_sound(const Scene& scene, const RawTets& output, const Rounding& rounding)
{
    auto defect = find_defect(scene.tets, scene.mesh.triangles.size());
    const Double3 size = to_double(scene.domain.high()) - to_double(scene.domain.low());
    if (!defect) defect = find_gap(scene.tets, scene.mesh, size);
    if (!defect) return;
    throw BuilderFailure(BUILDER_ABSURD_OUTPUT, fmt::format("checking {}'s output: {}: {}{}; {}, or repair the mesh",
                                                            output.maker, name_of(defect->kind), defect->what,
                                                            origin_of(*defect, output, rounding), try_other_switches));
}

// What is wrong with the domain's sides; empty if they are sound.
std::string flaw_of_sides(const Scene& scene)
{
    try {
        return find_weak_side(scene, make_entry_grid(scene.domain, scene.tets));
    } catch (const Error& error) {
        return error.what();
    }
}

void require_sound_sides(const Scene& scene, const RawTets& output)
{
    if (const std::string flaw = flaw_of_sides(scene); !flaw.empty())
        throw BuilderFailure(BUILDER_ABSURD_OUTPUT, fmt::format("checking {}'s output: the domain's sides: {}; {}",
                                                                output.maker, flaw, try_other_switches));
}

void note_result(const OptimiserReport& report, const BuilderTalk& talk)
{
    talk.note(fmt::format("optimised in {:.1f} s, {} rounds: a uniform line crosses {:.2f} free faces instead of "
                          "{:.2f}",
                          report.seconds, report.rounds, report.cost_after, report.cost_before));
}

void optimise_for_rays(Scene& scene, std::string_view maker, const OptimiserLimits& limits, const BuilderTalk& talk)
{
    OptimisedInfo& info = scene.build.optimised;
    info.effort = limits.effort;
    if (limits.effort == 0) {
        info.reason = "--effort is 0";
        return;
    }
    talk.stage("optimising");
    OptimisedTets result =
        optimise(scene.tets, limits, [&](const std::string&, double fraction, const std::string& detail) {
            if (talk.progress) talk.progress(fraction, detail);
        });
    talk.stage("checking the optimised tets");
    info.cost_before = result.report.cost_before;
    info.cost_after = result.report.cost_after;
    info.seconds = result.report.seconds;
    info.rounds = result.report.rounds;
    info.end = result.report.end;
    info.reason = objection_to(result, scene);
    std::vector<SourceTet> regions;
    if (info.reason.empty() && !scene.source_tets.empty()) {
        regions = keep_regions(scene, result.mesh);
        if (regions.empty()) info.reason = "the optimised tets fail a check: regions; please report it";
    }
    if (info.reason.empty()) {
        info.tets = TetsKind::rays;
        for (const OperationCount& operation : result.report.operations)
            info.operations.push_back({std::string(operation.name), operation.done, operation.gain, operation.seconds});
        scene.tets = std::move(result.mesh);
        scene.source_tets = std::move(regions);
        note_result(result.report, talk);
    } else {
        info.cost_after = info.cost_before;
        talk.note(fmt::format("{}'s tets are used: {}", maker, info.reason));
    }
}

} // namespace

std::string builder_tool()
{
    return "tetrace-builder " TETRACE_VERSION ", TetGen " TETRACE_TETGEN_VERSION ", CGAL " TETRACE_CGAL_VERSION;
}

std::string objection_to(const OptimisedTets& result, const Scene& scene)
{
    if (result.report.cost_after >= result.report.cost_before)
        return result.report.end == OptimiserEnd::finished ? "the optimiser found nothing to better"
                                                           : "the optimiser was stopped before it had bettered any";
    Scene changed = scene;
    changed.tets = result.mesh;
    auto defect = find_defect(changed.tets, scene.mesh.triangles.size());
    const Double3 size = to_double(scene.domain.high()) - to_double(scene.domain.low());
    if (!defect) defect = find_gap(changed.tets, scene.mesh, size);
    if (defect)
        return fmt::format("the optimised tets fail a check: {}: {}; please report it", name_of(defect->kind),
                           defect->what);
    if (const std::string flaw = flaw_of_sides(changed); !flaw.empty())
        return fmt::format("the optimised tets fail a check: {}; please report it", flaw);
    return "";
}

namespace {

/// A scene without tets; own: those of its file, if it has some.
Scene mesh_in_domain(const BuilderOptions& options, OwnTets& own, const BuilderTalk& talk)
{
    Scene scene;
    scene.name = options.name.empty() ? options.mesh.stem().string() : options.name;
    scene.build.source = options.mesh.filename().string();
    scene.build.tool = builder_tool();

    talk.stage("reading " + scene.build.source);
    read(options.mesh, scene, own, talk);
    const bool has_tets = !own.tets.empty();
    scene.origins.resize(scene.mesh.triangles.size());
    std::iota(scene.origins.begin(), scene.origins.end(), 0u);

    talk.stage("cleaning and placing");
    if (!has_tets) clean(scene, "", talk);
    place_mesh(scene, options, has_tets, talk);
    if (has_tets) {
        talk.stage(fmt::format("checking {} tets of the file", own.tets.size()));
        scene.build.repair.asked = options.repair;
        own = check_own_tets(scene, std::move(own.tets), std::move(own.numbers));
    } else
        repair_or_refuse(scene, options, talk);
    drop_own_numbers(scene.origins);
    add_domain(scene, options);
    return scene;
}

} // namespace

PreparedScene prepare_scene(const BuilderOptions& options, const BuilderTalk& talk)
{
    PreparedScene prepared;
    Scene& scene = prepared.scene;
    std::error_code ignored; // then it is made again
    if (!options.prepared.empty() && std::filesystem::exists(options.prepared, ignored)) {
        talk.stage("reading the prepared mesh");
        scene = read_scene(options.prepared, SceneFileKind::mesh_only);
    } else {
        scene = mesh_in_domain(options, prepared.own, talk);
        if (!options.prepared.empty() && prepared.own.tets.empty()) write_scene(options.prepared, scene);
    }
    scene.build.switches = options.switches;
    scene.build.order = options.order;
    prepared.surface = domain_surface(scene.domain);
    scene.build.optimised.asked = options.tets;
    if (options.mesh_only) return prepared;
    const bool has_own = !prepared.own.tets.empty();
    if (has_own) scene.build.optimised.effort = options.effort;
    if (has_own && options.tets == TetsKind::rays && !options.optimise_own)
        scene.build.optimised.reason = "the tets of its file are data, and optimised only if --tets rays is named";
    if (has_own && (options.tets != TetsKind::rays || !options.optimise_own)) return prepared;
    prepared.limits = {options.tets == TetsKind::rays ? options.effort : 0, options.optimise_for_s};
    prepared.limits.closed_too = has_own;
    const bool has_pieces = prepared.limits.effort > 0 && count_pieces(prepared.facets()) > 1;
    prepared.limits.several_pieces = has_pieces || has_own;
    const bool is_welded =
        options.repair && options.weld > 0; // TetGen has failed before: the least that it can do with
    if (has_pieces && !is_welded)           // more vertices on the sides to begin with
        prepared.surface = domain_surface(make_domain(scene.mesh, options.domain, 2 * options.divisions));
    if (const std::uint32_t squares = options.order / 100; squares > 0)
        prepared.surface = domain_surface(make_domain(scene.mesh, options.domain, squares));
    // With O0 TetGen has failed before, and needs fewer points; it optimises its tets again after it has inserted some.
    const bool has_no_points = is_welded || options.switches.find('q') != std::string::npos ||
                               options.switches.find("O0") != std::string::npos;
    if (prepared.limits.effort > 0 && !has_no_points) prepared.points = graded_points(prepared.facets(), scene.domain);
    return prepared;
}

Scene finish_scene(PreparedScene prepared, const RawTets& filled, const BuilderTalk& talk)
{
    Scene scene = std::move(prepared.scene);
    const bool has_own = !prepared.own.tets.empty();
    talk.stage(fmt::format("converting and checking {} tets", filled.tets.size()));
    RawTets joined;
    if (has_own) joined = join_own_tets(prepared.own, scene, filled);
    const RawTets& output = has_own ? joined : filled;
    Rounding rounding;
    scene.tets = convert_tets(output, scene.mesh, scene.domain, rounding);
    if (has_own) require_own_tets(prepared.own, scene);
    if (rounding.damaged > 0)
        talk.note(fmt::format("{} tets flat or inverted after rounding to float, {} of them mended: {} Steiner points "
                              "moved, {} removed, {} cavities filled with other tets",
                              rounding.damaged, rounding.repaired, rounding.moved_points, rounding.removed_points,
                              rounding.refilled));
    require_sound(scene, output, rounding);
    require_sound_sides(scene, output);
    scene.source_tets = std::move(prepared.own.numbers);
    if (scene.build.optimised.asked == TetsKind::rays && (!has_own || prepared.limits.closed_too))
        optimise_for_rays(scene, has_own ? "the file" : output.maker, prepared.limits, talk);
    scene.build.build_s = prepared.watch.seconds();
    return scene;
}

} // namespace tetrace
