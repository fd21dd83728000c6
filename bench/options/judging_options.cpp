#include "bench/options/apply_option.h"
#include "bench/options/option_parts.h"
#include "bench/options/option_values.h"

#include <charconv>

namespace tetrace {

namespace {

ApplyOption set_mesh()
{
    return {[](Options& o, const std::string& v) { o.scenes.push_back(v); }, {}, true};
}

double parse_slack(const std::string& text)
{
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !(value >= 1 && value <= 1e9))
        reject_value("--slack", text, "a number from 1 to 1000000000");
    return value;
}

} // namespace

std::vector<OptionRow> mesh_ray_options()
{
    constexpr unsigned making = bit(Verb::rays), judging = bit(Verb::judge);
    return {
        {"Mesh", "--scene", "SCENE",
         "The mesh that the rays are for: a mesh file (PLY, OBJ, OFF, STL, glTF), or a name of 'tetrace scenes'. Rays "
         "have the coordinates of its file. Required.",
         making, false, set_mesh(), usual_for(every_verb, "a mesh file, or a name of 'tetrace scenes'")},
        {"Mesh", "--mesh", "MESH",
         "The mesh that was traced: a mesh file (PLY, OBJ, OFF, STL, glTF), or a name of 'tetrace scenes'. It is taken "
         "as the file has it, with coordinates rounded to float32. Required.",
         judging, false, set_mesh(), usual_for(every_verb, "a mesh file, or a name of 'tetrace scenes'")},
        {"Rays", "--rays", "KIND",
         "Make rays of this kind: 'primary', the pixels of four images; 'random', lines through the mesh; 'hard', rays "
         "through vertices, along edges, in the planes of faces, from faces, at grazing angles, in thin triangles, and "
         "with an end on the mesh. Default: all.",
         making, true, append("--rays", &Options::made_rays), usual_for(every_verb, "kind of rays: {}")},
        {"Rays", "--count", "N", "Make this many rays of each kind, 1 to 10000000. Default: 65536.", making, false,
         set_count("--count", &Options::made_count, 1, 10'000'000), usual_for(every_verb, "rays of each kind")},
        {"Rays", "--answers", "FILE.npy",
         "Also write the exact answers: face, t, u, v for each ray; -1, 0, 0, 0 for a miss. Default: none.", making,
         false, set_path("--answers", &Options::answer_file), usual_for(every_verb, "also write the exact answers")},
        {"Rays", "--ray-file", "FILE.npy",
         "The rays that were traced: N x 8 numbers, origin, t_min, direction, t_max; float32 or float64. Required.",
         judging, false, set_path("--ray-file", &Options::ray_file),
         usual_for(every_verb, "origin, t_min, direction, t_max of each ray")},
        {"Rays", "--hits", "FILE.npy",
         "The answers: N x 4 numbers, face, t, u, v; float32 or float64. A face of -1 is a miss. Required.", judging,
         false, set_path("--hits", &Options::hit_file), usual_for(every_verb, "face, t, u, v of each ray")},
        {"Rays", "--slack", "FACTOR",
         "How far t, u and v may be from the exact numbers: this many times what the formula of Moeller and Trumbore "
         "can lose by rounding, 1 to 1000000000. Programs with another formula may need more (docs/judge.md). "
         "Default: 2.",
         judging, false, [](Options& o, const std::string& v) { o.slack = parse_slack(v); },
         usual_for(every_verb, "times what rounding can lose in t, u, v")},
        {"Rays", "--threads", "N",
         "Threads that decide rays; 0 means OMP_NUM_THREADS if it is set, or else all CPUs that the process may use. "
         "Default: 0.",
         making | judging, false, set_count("--threads", &Options::threads, 0, 4096)},
    };
}

} // namespace tetrace
