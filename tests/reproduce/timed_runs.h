#pragma once

#include "bench/options/options.h"
#include "bench/reproduce/tables/tables.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace::test {

inline constexpr std::size_t views = 13; ///< of flight, spread evenly
inline constexpr double pixels = 64, papers_pixels = 1024.0 * 1024.0;

/// Cubes on the host, traced once and timed by nobody: the times are the test's.
inline SceneRun open_run(const std::string& backends = "openmp,embree", const std::string& view_list = "0-1281:100")
{
    const Options options =
        parse_options({"reproduce", "table6", "--scene", "cubes", "--resolution", "3", "--size", "8", "--views",
                       view_list, "--backend", backends, "--samples", "3", "--sample-time", "0", "--threads", "1"});
    SceneBuild build{scene_requests(options).front(), "cubes", our_build, "cubes", false, true, false, true};
    SceneRun run = open_scene_run(build, options);
    run_views(run, options, {});
    for (RowRun& row : run.rows)
        row.setup = {}; // build times are the test's too
    return run;
}

inline std::size_t find_row(const SceneRun& run, Layout layout, Method method, const std::string& backend = "openmp")
{
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
        const RowKey& key = run.rows[i].key;
        if (key.kernel.layout == layout && key.kernel.method == method && key.backend == backend) return i;
    }
    throw std::runtime_error("no such row");
}

/// A row that takes so long in each view: its median; the other samples are far off.
inline void set_times(SceneRun& run, std::size_t row, const std::vector<double>& seconds)
{
    double sum = 0;
    for (std::size_t view = 0; view < seconds.size(); ++view) {
        run.images[row].at(view).samples_s = {9 * seconds[view], seconds[view], seconds[view] / 2};
        sum += seconds[view];
    }
    run.rows[row].samples_s = {sum, sum, sum};
}

/// 1, 2, 3, ... times the factor.
inline std::vector<double> ramp(double factor)
{
    std::vector<double> seconds;
    for (std::size_t view = 0; view < views; ++view)
        seconds.push_back(factor * static_cast<double>(view + 1));
    return seconds;
}

inline void set_all(SceneRun& run, double cdt, double bvh)
{
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        if (is_whole(run.rows[i])) set_times(run, i, ramp(is_cdt(run.rows[i]) ? cdt : bvh));
}

inline const Claim& claim_of(const PaperTable& table, std::string_view id)
{
    for (const Claim& claim : table.claims)
        if (claim.id == id) return claim;
    throw std::runtime_error("no claim " + std::string(id));
}

/// From here on the run passes for one of the paper's scene, of the given similarity.
inline void be_like(SceneRun& run, const std::string& scene, LikenessKind kind)
{
    run.build.scene = scene;
    run.likeness = {kind, kind == LikenessKind::other_mesh ? "another mesh." : "all within 2 %."};
}

} // namespace tetrace::test
