#include "bench/options/option_table.h"

#include "bench/options/apply_option.h"
#include "bench/options/option_parts.h"
#include "bench/options/option_values.h"
#include "bench/options/workload.h"
#include "core/device/backend.h"
#include "core/isolation/isolation.h"
#include "scenes/catalogue.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

/// The distinct values of one part of all kernels' ids, whatever their tasks: the accepted values of an option.
template <class T>
std::vector<T> kernels_have(T KernelId::*member)
{
    std::vector<T> values;
    for (const Task task : values_of<Task>())
        for (const KernelId& kernel : kernels_of(task))
            if (std::ranges::find(values, kernel.*member) == values.end()) values.push_back(kernel.*member);
    return values;
}

/// "plane, plucker or stp": the distinct names of one part of the kernels that `keeps` keeps.
template <class T>
std::string names_of(T KernelId::*member, bool (*keeps)(const KernelId&))
{
    std::vector<std::string> names;
    for (const KernelId& kernel : all_kernels())
        if (const std::string name(name_of(kernel.*member));
            keeps(kernel) && std::ranges::find(names, name) == names.end())
            names.push_back(name);
    return join_alternatives(names);
}
template <Structure structure>
bool is_of(const KernelId& kernel)
{
    return kernel.structure == structure;
}
template <Family family>
bool is_bvh_of(const KernelId& kernel)
{
    return kernel.structure == Structure::bvh && traits_of(kernel.layout).family == family;
}
/// Whether only `project` walks through the layout.
bool is_projects(const KernelId& kernel)
{
    return kernel.structure == Structure::cdt && std::ranges::none_of(all_kernels(), [&](const KernelId& other) {
               return other.layout == kernel.layout && other.method != Method::project;
           });
}

/// What --task takes.
std::vector<Task> asked_tasks()
{
    std::vector<Task> tasks;
    for (const Task task : values_of<Task>())
        if (task == Task::trace || traits_of(task).crosses) tasks.push_back(task);
    return tasks;
}

std::string crossing_help()
{
    std::string help;
    for (const Task task : asked_tasks())
        if (traits_of(task).crosses) help += fmt::format("; '{}', {}", name_of(task), traits_of(task).help);
    return help;
}

/// "atrium, city, terrain": scenes of the catalogue.
std::string scene_names(bool (*is_named)(const CatalogueEntry&))
{
    std::vector<std::string> names;
    for (const CatalogueEntry& scene : catalogue())
        if (is_named(scene)) names.push_back(scene.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void forbid_repair(Options& options, const std::string&)
{
    if (options.repair) throw Error(ErrorKind::usage, "--no-repair: --repair is given, too; leave one of them out");
    options.repair = false;
}

/// "'default-2026.11', what ...; ..."
std::string workload_texts()
{
    std::vector<std::string> texts;
    for (const Workload& workload : workloads())
        texts.push_back(fmt::format("'{}', {}", workload.name, workload.what));
    return fmt::format("{}", fmt::join(texts, "; "));
}

std::vector<OptionRow> scene_options()
{
    return {
        {"Scenes", "--workload", "NAME",
         "Trace this named set of scenes, cameras and rays, whose results stay comparable across versions of "
         "tetrace: " +
             workload_texts() + ". Takes the place of the options of scenes and rays (docs/workloads.md).",
         bit(Verb::bench) | bit(Verb::check), false, ApplyOption(apply_workload, workload_names()),
         usual_for(bit(Verb::bench), "a named set of scenes, cameras and rays")},
        {"Scenes", "--scene", "SCENE",
         "A name from the catalogue ('tetrace scenes' lists it), a mesh file (PLY, OBJ, OFF, STL, glTF; of "
         "tets MEDIT, Gmsh, TetGen, VTK), a pipe of one, or a .tet file. May be repeated, or a list with commas. 'all' "
         "is every available scene of the catalogue "
         "except lattice and field. NAME-1 is NAME as it was first pinned, the same in "
         "every version of tetrace. NAME@N has about N triangles; the name can be " +
             scene_names([](const CatalogueEntry& scene) { return scene.source == SceneSource::procedural; }) +
             ". field@N has N points. lattice:N has 6 N^3 tets, for example 2 GB in layout half32 with N = 138. "
             "Default: bunny-1, "
             "armadillo-1 and atrium-1; cubes, banana and atrium-1 if the first two are missing.",
         building, true, append_scenes(), usual_for(every_verb, "a name of 'tetrace scenes', a mesh file, or all")},
        {"Scenes", "--repair", "",
         "If triangles of a mesh cross, overlap or touch, cut them along their exact intersections; if that never "
         "ends, or TetGen fails, merge near layers, and say by how much faces moved. face_id in results still names "
         "the file's triangles. This is the default.",
         building, false, [](Options& o, const std::string&) { o.repair = true; }},
        {"Scenes", "--no-repair", "",
         "Move nothing and cut nothing: a mesh whose triangles cross has no tets, and only its BVH rows run.", building,
         false, forbid_repair},
        {"Scenes", "--domain", "KIND",
         "The box that the tetrahedralization fills: 'tight', the mesh's bounding box grown by 2 %, or 'wide', a "
         "cube of half-size 3 bounding-sphere radii. 'build' accepts a list. Default: tight.",
         building, true, append("--domain", &Options::domains)},
        {"Scenes", "--tets", "KIND",
         "How the domain is filled: 'rays', tets optimised so that rays cross few faces, or 'cdt', the constrained "
         "Delaunay tetrahedralization before that, as TetGen makes it. 'cubes', 'lattice' and .tet files have tets "
         "of their own. A file of tets, or 'field', keeps its tets unless 'rays' is named: then they are optimised "
         "within their regions. 'build' accepts a list, and so does 'render', which then shows the steps side by side; "
         "'reproduce' has --builds. Default: rays.",
         building & ~bit(Verb::reproduce), true, append("--tets", &Options::tets),
         usual_for(bit(Verb::build) | bit(Verb::render), "how the domain is filled: {}")},
        {"Scenes", "--effort", "N",
         "Effort for --tets rays: 0 (TetGen's tets, unchanged, but with the --switches of this kind, so not those "
         "of --tets cdt), 1 (quick), 2, or 3 (vertices are inserted for a mesh of one piece too; the optimiser needs "
         "three times as long, for at most 1 % fewer steps). Default: " +
             std::to_string(usual_effort) + ".",
         building, false,
         [](Options& o, const std::string& v) { o.effort = static_cast<int>(parse_count("--effort", v, 0, 3)); },
         usual_for(bit(Verb::build), "effort of the optimiser: 0 to 3")},
        {experiments, "--divisions", "N",
         "Cut each side of the domain into N x N squares, 1 to 64. 'build' accepts a list. Default: " +
             std::to_string(BuildOptions{}.divisions) + ".",
         building, true, append_count("--divisions", &Options::divisions, 1, 64)},
        {"Scenes", "--switches", "SWITCHES",
         "TetGen's switches, as in its manual, or cgal, tets by CGAL 6.1 or later. 'build' accepts a list. Default: " +
             default_build(TetsKind::rays).switches + " for --tets rays, " + default_build(TetsKind::cdt).switches +
             " for --tets cdt.",
         building, true, append_text(&Options::switches), usual_for(bit(Verb::build), "TetGen's switches, or cgal")},
        {experiments, "--resolution", "N",
         "Cubes along each axis of the scene 'cubes', 2 to 128. Default: " + std::to_string(BuildOptions{}.resolution) +
             ".",
         building, false, set_count("--resolution", &Options::resolution, 2, 128)},
        {"Scenes", "--time-limit", "TIME",
         "End the scene builder when it has used this much processor time: seconds, or a number followed by s, m or h. "
         "Default: 10m.",
         building, false, set_seconds("--time-limit", &Options::time_limit_s),
         usual_for(bit(Verb::build), "processor time of the builder: 90s, 10m, 2h")},
        {"Scenes", "--optimise-time", "TIME",
         "Stop the optimiser of --tets rays after this processor time, as above, and use the tets reached so far. They "
         "depend "
         "on the machine: the result says 'out of time', and the scene is kept in a separate file, which --scene "
         "accepts. Default: half of --time-limit.",
         building, false, set_seconds("--optimise-time", &Options::optimise_s)},
        {"Scenes", "--memory-limit", "SIZE",
         "Memory that the scene builder may use: bytes, or a number followed by K, M, G or T. "
         "Default: 8G, or what is left of a container's limit.",
         building, false, set_bytes("--memory-limit", &Options::memory_limit_bytes),
         usual_for(bit(Verb::build), "memory of the builder: 500M, 8G")},
        {"Scenes", "--clear", "", "Empty the cache of built scenes.", bit(Verb::scenes), false, set(&Options::clear),
         usual_for(every_verb, "empty the cache of built scenes")},
    };
}

std::vector<OptionRow> row_options()
{
    return {
        {"Rows", "--structure", "NAME",
         "Keep the rows of this structure: cdt (tets of either kind) or bvh. Default: both. 'check' leaves out "
         "Embree's and a driver's own BVHs unless --structure, --method, --layout, --backend, --filter, '--schedule "
         "pipeline' or '--require embree' is given.",
         selecting & ~bit(Verb::trace), true, append("--structure", &Options::structures)},
        {"Rows", "--method", "NAME",
         "Keep the rows of this method: " + names_of(&KernelId::method, is_of<Structure::cdt>) +
             " (exit-face searches of the cdt), of task segments also plucker64 and barycentric, " +
             names_of(&KernelId::method, is_of<Structure::bvh>) +
             " (how many rays Embree's BVHs get at once: one, a packet, or a stream of packets, which only Embree 3 "
             "has; other BVHs have only single), or 'all'. Default: maria, project on half32 and tet64, and the "
             "methods of the BVHs if these are kept. Default for 'reproduce': all; table6 compares maria with BVHs, "
             "and through tets for rays also project on half32 and tet64.",
         reproducing | selecting | bit(Verb::dump), true,
         append_or_all("--method", &Options::methods, kernels_have(&KernelId::method)),
         usual_for(~bit(Verb::render), "exit-face search, for example maria, or all")},
        {"Rows", "--layout", "NAME",
         "Keep the rows of this memory layout: " + names_of(&KernelId::layout, is_of<Structure::cdt>) + " (cdt; " +
             names_of(&KernelId::layout, is_projects) + " only with project), " +
             names_of(&KernelId::layout, is_bvh_of<Family::bvh>) + " (our BVHs), or " +
             names_of(&KernelId::layout, is_bvh_of<Family::foreign>) +
             " (built by Embree itself, with quality high or medium, or with flag robust, and rt by Vulkan's driver "
             "for its own ray tracing). Default: all of the structures kept, and rt on GPUs that have it. On emulated "
             "devices rt is slow: it is a row there only if it is named here, in a filter, or by '--schedule "
             "pipeline'.",
         reproducing | selecting | bit(Verb::dump) | bit(Verb::page), true,
         append("--layout", &Options::layouts, kernels_have(&KernelId::layout)),
         usual_for(~(bit(Verb::check) | bit(Verb::render) | bit(Verb::reproduce)),
                   "memory layout, for example tet80 or bvh2")},
        {"Rows", "--backend", "NAME",
         "Keep the rows of this backend ('tetrace devices' lists them). A backend without a usable device has rows "
         "only if it is named here or by --require; they are skipped, with the reason. Default: all with a usable "
         "device and a kernel of the structures kept. 'inspect' asks the drivers of its devices instead of the usual "
         "targets' compilers. 'dump' has 'webgpu', too: the kernels of 'tetrace page'.",
         reproducing | bit(Verb::dump) | bit(Verb::inspect), true, append_backend("--backend", &Options::backends),
         usual_for(~bit(Verb::render), "API: {}")},
        {"Rows", "--device", "TEXT",
         "Keep the rows of the devices whose name, driver, type, id, number or driver's library contains TEXT, "
         "ignoring "
         "case, for example 'gpu', 'llvmpipe', 'vulkan:1' (the second device of vulkan) or '/opt/mesa/'. Exit code 3 "
         "if a TEXT matches "
         "none. Default: all. 'inspect' asks the drivers of these devices.",
         reproducing | bit(Verb::dump) | bit(Verb::inspect), true, append_text(&Options::devices),
         usual_for(bit(Verb::dump), "devices whose name, type or number has this text")},
        {"Rows", "--task", "NAME",
         "What rows compute: 'trace', the hit of each ray" + crossing_help() +
             ". These are for maria and project, in exact mode, and for rays of kinds primary, diffuse and random, all "
             "of which are given. Default: trace.",
         measuring | bit(Verb::dump) | bit(Verb::page), true, append("--task", &Options::tasks, asked_tasks())},
        {"Rows", "--rays", "KIND",
         "Trace rays of this kind: 'primary', the image's own, made by the kernels. The others are made on the "
         "host, from the primary hits: 'shadow', towards a light, and 'ao', short rays in directions around the "
         "normal (for both, any hit will do); 'diffuse', one bounce; 'random', lines through the domain. 'render' has "
         "them for its picture 'tally'. Default: primary; for that picture, random.",
         measuring | bit(Verb::render) | bit(Verb::trace) | bit(Verb::dump) | bit(Verb::page), true,
         append("--rays", &Options::rays),
         usual_for(~(measuring | bit(Verb::render) | bit(Verb::dump)), "kind of rays: {}")},
        {"Rows", "--ray-order", "ORDER",
         "Order of the rays of all kinds except primary, and of primary rays in tasks segments, tally and absorb: "
         "'tiles', in the order of their pixels; 'morton', sorted by origin and direction; 'shuffled'. Each is a "
         "separate row. Default: tiles.",
         measuring | bit(Verb::trace) | bit(Verb::dump), true, append("--ray-order", &Options::ray_orders)},
        {"Rows", "--math", "MODE",
         "'exact': no contraction to FMAs, the same bits everywhere; 'fast': the compiler may contract. Embree has "
         "one build, whose rows appear in both modes. Default: exact.",
         selecting | bit(Verb::dump), true, append("--math", &Options::math),
         usual_for(bit(Verb::inspect) | bit(Verb::dump), "contraction to FMAs: {}")},
        {experiments, "--order", "ORDER",
         "Order of the tets in memory: 'hilbert', along a space-filling curve; 'reached', the same, but tets that "
         "no ray from outside reaches are last; 'chains', as 'reached', but each tet is followed by its neighbour "
         "across its largest free face; 'input', as TetGen wrote them. Only for rows of structure cdt. Default: "
         "chains.",
         tracing | bit(Verb::dump), true, append("--order", &Options::orders)},
        {"Rows", "--schedule", "NAME",
         "How work items get their rays: 'tiles', one ray each; 'persistent', work items fetch rays until all are "
         "traced, on the backends with such kernels; 'packets', 4, 8 or 16 rays in lockstep on openmp, for project "
         "on half32; 'native', one ray each with code for AVX2 (x86-64-v3) on openmp, for maria on tet80, project "
         "on half32 and tet64, and BVHs; 'pipeline', only for rt, Vulkan's ray-tracing pipelines instead of ray "
         "queries. Embree has a schedule of its own. Default: tiles and packets; for rt, pipeline if the driver "
         "lacks ray queries.",
         selecting, true, append("--schedule", &Options::schedules),
         usual_for(bit(Verb::inspect), "how work items get their rays: {}")},
        {"Rows", "--filter", "REGEX",
         "Keep the rows whose names match this regular expression (RE2) anywhere: 'tet96.*openmp'. A claim of "
         "'reproduce rivals' is not testable without its rows. Default: all.",
         sharing | bit(Verb::render) | bit(Verb::compare), false,
         [](Options& o, const std::string& v) { o.filter = parse_filter(v); },
         usual_for(~bit(Verb::reproduce), "rows whose names match, as tet96.*openmp")},
        {"Rows", "--list", "", "Print the names of the selected rows and stop.", measuring, false, set(&Options::list)},
    };
}

std::vector<OptionRow> ray_options()
{
    const unsigned with_rays = building;
    return {
        {"Rays", "--camera-set", "SET",
         "'frame', 4 views that the scene fills: close views of a mesh, and special cameras for " +
             scene_names([](const CatalogueEntry& scene) { return !scene.views.empty(); }) +
             "; 'smoke', 4 views at 2 radii, in which a closed object fills a sixth of the "
             "image; 'orbit', 1,282 views on a sphere of 2 radii; 'flight', 1,282 views from 1.2 to 2.9 radii; or a "
             ".json file with your own cameras (docs/cameras.md). Default: frame; for 'reproduce', except for "
             "rivals, ladder and volume, flight.",
         with_rays, false, set_cameras(), usual_for(~(sharing | bit(Verb::dump)), "views: {}, or a .json file")},
        {"Rays", "--views", "LIST",
         "Views of the camera set, numbered from 0: numbers, ranges and strides, for example 0,3,10-20 or "
         "0-1281:64. Default: all; for 'bench' without --scene and with frame, 0 and 1.",
         with_rays & ~bit(Verb::trace) & ~bit(Verb::dump), true,
         [](Options& o, const std::string& v) { o.views += (o.views.empty() ? "" : ",") + v; },
         usual_for(bit(Verb::render) | bit(Verb::reproduce), "views of the set: 0,3,10-20 or 0-1281:64")},
        {"Rays", "--size", "WxH",
         "Image size in pixels, one ray each; N means NxN. 'bench' accepts a list, for example 256,512,1024, and "
         "measures each row at each size. Default: 1024x1024; for 'check', 'trace', 'dump' and 'page' 256x256, for "
         "'reproduce rivals' and 'ladder' 512x512, for 'reproduce volume' 64x64.",
         with_rays, true,
         [](Options& o, const std::string& v) {
             std::tie(o.width, o.height) = parse_size("--size", v);
             o.sizes.push_back({o.width, o.height});
         },
         usual_for(every_verb, "pixels of the image: 640x480, or 512 for 512x512")},
        {"Rays", "--threads", "N",
         "Host threads; 0 means OMP_NUM_THREADS if it is set, or else all CPUs that the process may use; in a "
         "container with a CPU quota, the quota rounded down. 'bench' accepts a list, for example 1,2,4, and measures "
         "each row of a processor with each number; all else has the largest. Scenes are always built with 0. Default: "
         "0.",
         with_rays, true,
         [](Options& o, const std::string& v) {
             o.thread_counts.push_back(static_cast<unsigned>(parse_count("--threads", v, 0, 4096)));
             o.threads = std::ranges::max(o.thread_counts);
         }},
        {experiments, "--tile", "WxH", "Pixels per work-group: 8x4 or 8x8. Default: depends on the type of the device.",
         reproducing | bit(Verb::dump), false,
         ApplyOption([](Options& o, const std::string& v) { o.tile_height = parse_tile_height(v); }, tile_names())},
        {experiments, "--packet-lanes", "N",
         "Rays per packet, for rows of schedule 'packets': 4, 8 or 16. If the CPU or the build does not support "
         "that width, those rows are unsupported. Default: the widest available.",
         tracing, false,
         ApplyOption([](Options& o, const std::string& v) { o.packet_lanes = parse_packet_lanes(v); },
                     packet_lane_names())},
        {experiments, "--buffer-limit", "SIZE",
         "Maximum size of a buffer on every device: bytes, or a number followed by K, M, G or T. The array of tets "
         "is bound in parts that fit; if that is not enough, the row is unsupported. Default: the limit that each "
         "device reports.",
         reproducing, false, set_bytes("--buffer-limit", &Options::buffer_limit)},
    };
}

std::vector<OptionRow> driver_options()
{
    const unsigned with_drivers = reproducing | bit(Verb::devices);
    return {
        {"Drivers", "--isolate", "KIND",
         fmt::format("The process in which drivers run ({}): 'device', a separate process for each device, so that a "
                     "driver that crashes or hangs ends only its row; 'none', tetrace's process, for debuggers. "
                     "Default: device.",
                     fmt::join(foreign_backends(), ", ")),
         with_drivers, false, set_choice<Isolation>("--isolate", &Options::isolation)},
        {"Drivers", "--driver-limit", "TIME",
         "End a driver's process if it does not answer a call within this time: seconds, or a number followed by s, "
         "m or h. Needs --isolate device. Default: 5 minutes, plus a millisecond per ray or a second per megabyte "
         "of data. A call that compiles ends after 3 times as much of processor time.",
         with_drivers, false, set_seconds("--driver-limit", &Options::driver_limit_s),
         usual_for(bit(Verb::devices), "time that a driver has for a call: 30s, 5m")},
    };
}

std::vector<OptionRow> judging_options()
{
    return {
        {"Measuring", "--samples", "N",
         "Samples, 3 to 10000. Of 'bench' and of rivals for each row: a sample traces all selected views together, "
         "repeatedly for --sample-time. Of 'reproduce' for each row and view, or batch of searches. Fewer than 5 give "
         "no interval, here and in 'compare'. Default: 10, and up to three times as many for rows that are noisy, "
         "while --budget "
         "lasts (not with --runs, nor with Google Benchmark's output); of 'reproduce' 5, except for rivals, "
         "ladder and volume (3).",
         bit(Verb::bench) | bit(Verb::reproduce), false,
         [](Options& o, const std::string& v) {
             set_count("--samples", &Options::samples, 3, 10000)(o, v);
             o.exact_samples = true;
         }},
        {"Measuring", "--runs", "N",
         "Measure N times, 1 to 100: each run opens every row's session again, warms it up and takes --samples. "
         "Times differ more between runs than within one (memory, driver, machine), so intervals of ratios then "
         "span the runs: their range, or with 5 or more runs a 95 % interval from resampling runs and samples. "
         "Default: 1, with intervals based only on its samples. For 'reproduce', only rivals.",
         bit(Verb::bench) | bit(Verb::reproduce), false, set_count("--runs", &Options::runs, 1, 100)},
        {"Measuring", "--launches-in-flight", "N",
         "Launches of a sample that may be on the device together, 1 to 8, each with an output of its own: a launch "
         "begins when the one that is N before it has ended. All N outputs are verified before and after the samples. "
         "Rates are then throughput, with less of the gaps between launches; latency is still that of single launches. "
         "Rows on devices of kind cpu, and those of --task tally, have 1. Default: 1.",
         bit(Verb::bench), false, set_count("--launches-in-flight", &Options::launches_in_flight, 1, max_in_flight)},
        {"Measuring", "--sample-time", "TIME",
         "Minimum duration of a sample on its device, or 4096 passes, if that is less: seconds, or a number "
         "followed by s, up to a minute. A GPU traces all views in less than a millisecond, too short for its "
         "clocks to settle. Passes follow each other without the host, and rates are per pass. 0: a sample is one "
         "pass. Default: 0.1; of 'reproduce', which takes samples of each of up to 1,282 views, 0.005, except for "
         "rivals, ladder and volume (0).",
         bit(Verb::bench) | bit(Verb::reproduce), false,
         [](Options& o, const std::string& v) { o.sample_s = parse_sample_time(v); }},
        {"Measuring", "--budget", "TIME",
         "Wall-clock time for verifying and timing all rows; of 'check' for verifying them. Loading scenes and opening "
         "devices do not count. If not all samples fit, 'bench' takes fewer, but at least 5 (or --samples, if less), "
         "since fewer give no interval. The slowest rows are skipped until the others fit; of each scene the fastest "
         "row of tets and that of BVHs stay, until whole scenes are skipped, the last one first. 'reproduce' shares "
         "the time evenly by the scenes that are left; the exit searches of table5 count as one more. The result "
         "states the budget that the skipped rows need. With --repeat, each repetition has it. One row is always "
         "measured, however small TIME is; otherwise a run exceeds the budget by at most a quarter. "
         "--benchmark_repetitions lifts the limit. "
         "Default: 4m; of 'check' and 'reproduce' no limit, but of rivals 10m, of ladder 5m. For --variants it is the "
         "time for all of them.",
         sharing | bit(Verb::inspect), false, set_seconds("--budget", &Options::budget_s),
         usual_for(bit(Verb::bench) | bit(Verb::reproduce), "time for verifying and timing: 30s, 10m")},
        {"Judging", "--require", "BACKEND",
         "Fail with exit code 3 unless this backend has a usable device and, except for 'devices', has selected rows "
         "of "
         "which none is skipped or unsupported; 'devices' exits with 1 if a self-test of that backend fails.",
         sharing | bit(Verb::devices), true, append_backend("--require", &Options::required),
         usual_for(bit(Verb::check) | bit(Verb::devices), "fail unless this API has a device and results")},
        {"Judging", "--allow-flawed", "",
         "Exit with 0 even if maria, project or one of our BVHs has wrong rays on a device whose t, u or v differ from "
         "openmp's. Lost rays there, and rows that differ from openmp, still fail. A row with openmp's bits never "
         "fails.",
         bit(Verb::check), false, set(&Options::allow_flawed)},
        {"Judging", "--defects", "",
         "Run the reduced kernels of known compiler defects instead of rows; no scene is needed. Exits with 1 if a "
         "driver shows one (docs/debugging.md).",
         bit(Verb::check), false, set(&Options::defects),
         usual_for(every_verb, "known compiler defects instead of rows")},
        {"Judging", "--stress", "",
         "Run stressors instead of rows: small kernels in forms in which compilers have been wrong, at 1 to 1,000,000 "
         "items. With --defects, both. Exits with 1 if a result is wrong.",
         bit(Verb::check), false, set(&Options::stress)},
        {"Judging", "--variants", "N",
         "Check N variants of each selected kernel instead of rows: its text with random changes that keep its "
         "meaning, "
         "compiled anew by the driver. Each has the hits of the unchanged kernel, or the driver is wrong. 'inspect' "
         "only "
         "compiles them. 1 to 1000000.",
         bit(Verb::check) | bit(Verb::inspect), false, set_count("--variants", &Options::variants, 1, 1'000'000)},
        {"Judging", "--seed", "S", "Choose other variants: 0 to 4294967295. Default: 1.",
         bit(Verb::check) | bit(Verb::inspect), false,
         [](Options& o, const std::string& v) { o.seed = parse_count("--seed", v, 0, 0xFFFFFFFF); }},
        {"Judging", "--tolerance", "PERCENT",
         "The difference in time that does not matter, in percent, 0 to 100. A row that is SLOWER by more is a "
         "regression; a row whose whole interval is within it is the SAME. Default: 3.",
         bit(Verb::compare), false,
         [](Options& o, const std::string& v) { o.tolerance = parse_percent("--tolerance", v) / 100; },
         usual_for(every_verb, "difference in time that does not matter")},
        {"Judging", "--allow-missing", "",
         "Exit with 0 even if rows that A timed, or checked, are missing, skipped or unsupported in B. Failed rows "
         "still "
         "count.",
         bit(Verb::compare), false, set(&Options::allow_missing),
         usual_for(every_verb, "rows that B lacks do not fail")},
        {"Pictures", "--picture", "KIND",
         "'normals', the surface shaded by its normals; 'hits', an .exr with t, steps, normal and face of each hit "
         "(docs/own-mesh.md); or, in false colour with a scale bar: 'steps' of each ray to its hit; "
         "'crossings', all tets that it crosses; 'depth', the optical depth of a medium, and 'light', what it "
         "emits; 'tally', the lengths of the view's rays in each tet over its volume, on a cut through the middle of "
         "the "
         "scene, across the view (docs/volume.md). Default: normals.",
         bit(Verb::render), true, append("--picture", &Options::pictures), usual_for(every_verb, "what is shown: {}")},
        {"Pictures", "--differences", "FOLDER",
         "Write a picture of each view in which a row differs from openmp, with the differing pixels marked: PNG, or "
         "PPM if OpenImageIO is missing. Default: none.",
         bit(Verb::check), false, set_path("--differences", &Options::picture_folder), usual_for(0, "")},
    };
}

std::vector<OptionRow> report_options()
{
    return {
        {"Pictures", "--image", "FILE",
         "Add this picture to the page: a PNG or PPM file, as 'tetrace render' writes it. May be repeated, or a "
         "list with commas. Default: only the pictures named by figures in the results.",
         bit(Verb::report), true, append_path("--image", &Options::report_pictures),
         usual_for(every_verb, "add this picture, PNG or PPM, to the page")},
        {"Output", "--charts", "FOLDER",
         "Also write each chart of the page into this folder, as an SVG file that needs nothing else, for papers and "
         "slides; its name says what it shows. Default: none.",
         bit(Verb::report), false, set_path("--charts", &Options::chart_folder),
         usual_for(every_verb, "each chart as an SVG file, too")},
        {"Output", "--portability", "FILE.csv",
         "Also write the application efficiency of each API and layout on each device, for tools of performance "
         "portability: problem, platform, application, efficiency (docs/report.md). Default: none.",
         bit(Verb::report), false, set_path("--portability", &Options::portability_csv),
         usual_for(every_verb, "efficiencies, for performance portability")},
    };
}

std::vector<OptionRow> make_table()
{
    std::vector<OptionRow> table;
    for (auto part :
         {reproduce_options, inspect_options, trace_options, scene_options, row_options, mesh_ray_options, ray_options,
          driver_options, judging_options, expectation_options, report_options, sharing_options, output_options})
        for (OptionRow& row : part())
            table.push_back(std::move(row));
    std::stable_partition(table.begin(), table.end(), [](const OptionRow& row) { return row.group != experiments; });
    return table;
}

} // namespace

FileArguments file_arguments(Verb verb)
{
    if (verb == Verb::compare) return {"A.json B.json [C.json...]", 2, 26};
    if (verb == Verb::show) return {"RESULT.json", 1, 1};
    if (verb == Verb::report) return {"RESULT|FOLDER...", 1, 1000};
    if (verb == Verb::merge) return {"RESULT...", 1, max_shards};
    return {};
}

const std::vector<OptionRow>& option_table()
{
    static const std::vector<OptionRow> table = make_table();
    return table;
}

} // namespace tetrace
