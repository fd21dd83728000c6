#pragma once

#include "bench/options/camera_file.h"
#include "bench/options/shard.h"
#include "core/isolation/isolation.h"
#include "core/pack/kernel_id.h"
#include "core/rays/camera_set.h"
#include "scenes/catalogue.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// What the program is asked to do; the first word of its command line.
enum class Verb {
    devices,
    scenes,
    build,
    bench,
    check,
    render,
    reproduce,
    inspect,
    trace,
    dump,
    rays,
    judge,
    compare,
    show,
    report,
    page,
    merge,
    help,
    version
};
template <>
inline constexpr auto enum_names<Verb> = names_up_to<Verb::version>("devices", "scenes", "build", "bench", "check",
                                                                    "render", "reproduce", "inspect", "trace", "dump",
                                                                    "rays", "judge", "compare", "show", "report",
                                                                    "page", "merge", "help", "version");

/// The form of a result.
enum class Format { table, json, csv, markdown };
template <>
inline constexpr auto enum_names<Format> = names_up_to<Format::markdown>("table", "json", "csv", "markdown");

/// A picture that `render` writes: of hits; the hits as data; or, from crossings on, of all tets of each ray; or of
/// the sums of the tets.
enum class Picture { normals, steps, hits, crossings, depth, light, tally };
template <>
inline constexpr auto enum_names<Picture> = names_up_to<Picture::tally>("normals", "steps", "hits", "crossings",
                                                                        "depth", "light", "tally");

/// Whether one of the pictures is the hits themselves.
[[nodiscard]] inline bool writes_hits(const std::vector<Picture>& pictures)
{
    return std::ranges::find(pictures, Picture::hits) != pictures.end();
}

/// A table or a figure of the paper that `reproduce` measures again. Three are not in the paper: rivals, our own
/// claims about tets and BVHs; ladder, what a step costs by the size of a scene; and volume, all tets of a ray.
enum class PaperTarget { table3, table4, table5, table6, figure6, rivals, ladder, volume };
template <>
inline constexpr auto enum_names<PaperTarget> = names_up_to<PaperTarget::volume>("table3", "table4", "table5", "table6",
                                                                                 "figure6", "rivals", "ladder",
                                                                                 "volume");

/// Whether it is measured as `bench` measures, all views together, and by itself.
[[nodiscard]] constexpr bool is_bench_run(PaperTarget target)
{
    return target == PaperTarget::rivals || target == PaperTarget::ladder || target == PaperTarget::volume;
}

/// A build of a scene that `reproduce` traces: a CDT as the options ask for, one as near to the paper's counts as
/// known, or tets for rays.
enum class PaperBuild { ours, paper, rays };
template <>
inline constexpr auto enum_names<PaperBuild> = names_up_to<PaperBuild::rays>("ours", "paper", "rays");

/// The number of exit searches for Table 5. Default: the paper's.
struct SearchSize {
    std::uint32_t tets = 10'000;
    std::uint32_t rays = 16'384; ///< for each tet; a multiple of TILE_WIDTH

    [[nodiscard]] std::uint64_t count() const { return std::uint64_t{tets} * rays; }
    friend bool operator==(const SearchSize&, const SearchSize&) = default;
};

/// Rays that the verb `rays` makes (bench/judging/made_rays.h).
enum class MadeRays { primary, random, hard };
template <>
inline constexpr auto enum_names<MadeRays> = names_up_to<MadeRays::hard>("primary", "random", "hard");

/// A pixel of an image; (0, 0) is the top left.
struct ImagePixel {
    std::uint32_t x = 0, y = 0;

    friend bool operator==(const ImagePixel&, const ImagePixel&) = default;
};

/// Of an image, in pixels.
struct ImageSize {
    std::uint32_t width = 0, height = 0;

    friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// A checked command line. Empty lists select by default (see rows.h); all other members hold their default.
struct Options {
    Verb verb = Verb::help;
    std::string help_topic;  ///< verb that help is about; empty: the program
    bool whole_help = false; ///< of a verb, in place of its first page

    std::optional<Shard> shard;         ///< empty: the whole run, or the rank's share under a launcher
    std::vector<std::string> words;     ///< the command line, the verb first
    std::vector<std::string> arguments; ///< the command line without what shards of one run may differ in
    std::string job;                    ///< of the launcher that started this rank, as Rank::job
    bool is_silent = false;             ///< whether standard output gets nothing: another rank prints for all
    double wait_s = 120;                ///< of rank 0, for a rank without a sign of life

    std::vector<std::filesystem::path> files; ///< result files that the verb reads, as many as file_arguments() says

    std::vector<std::string> scenes; ///< catalogue names or paths, as given
    std::vector<DomainKind> domains = {BuildOptions{}.domain};
    std::vector<TetsKind> tets = {TetsKind::rays};
    bool names_tets = false;              ///< whether --tets was given: only then rays are for a file's own tets too
    std::vector<std::uint32_t> divisions; ///< empty: those of default_build()
    std::vector<std::string> switches;    ///< empty: those of default_build()
    std::optional<bool> repair;           ///< empty: as true
    int effort = usual_effort;
    std::uint32_t resolution = BuildOptions{}.resolution;
    double time_limit_s = BuildOptions{}.time_limit_s;
    double optimise_s = BuildOptions{}.optimise_s;
    std::uint64_t memory_limit_bytes = 0; ///< 0: the usual limit, less in a container with less

    std::vector<Structure> structures;
    std::vector<Method> methods;
    std::vector<Layout> layouts;
    std::vector<std::string> backends;
    std::vector<Task> tasks; ///< trace, which is rays too, segments, tally and absorb; empty: trace
    std::vector<RayKind> rays;
    std::vector<RayOrder> ray_orders; ///< of given rays
    std::vector<MathMode> math;
    std::vector<TetOrder> orders;
    std::vector<Schedule> schedules;
    std::vector<std::string> devices; ///< texts; a device's name, driver, type or id must contain one; empty: all
    std::string filter;               ///< regular expression on row names, see name_filter.h; empty: all
    bool list = false;

    CameraSet camera_set = CameraSet::frame;
    std::optional<OwnCameras> own_cameras; ///< in place of camera_set
    std::string views;                     ///< as parse_views() takes it; empty: all of the set
    std::uint32_t width = 1024, height = 1024;
    std::vector<ImageSize> sizes;    ///< of `bench`, if it measures several; width and height are the last
    std::optional<ImagePixel> pixel; ///< of `trace`, which needs it, and of a case of `dump`
    std::string defect;              ///< of `dump`: the reduced kernel that is written as a case; empty: none

    unsigned threads = 0;                ///< 0: all that the process may use; of several, the most
    std::vector<unsigned> thread_counts; ///< of `bench`, if it measures several
    unsigned tile_height = 0;            ///< 4 or 8; 0: see tile_height_of()
    unsigned packet_lanes = 0;           ///< one of packet_widths; 0: the widest available
    std::uint64_t buffer_limit = 0;      ///< largest buffer of every device, in bytes; 0: unchanged
    unsigned samples = 10;
    bool exact_samples = false;      ///< whether noisy rows get no more
    unsigned runs = 1;               ///< of the measurement, each with sessions of its own
    unsigned launches_in_flight = 1; ///< of a sample of `bench`, see select_rows()
    double sample_s = 0.1;           ///< that a sample lasts at least, on its device; 0: a pass
    double budget_s = 240;           ///< for verifying and timing all rows

    std::vector<PaperTarget> targets;     ///< of `reproduce`; empty: those of the paper; the others only by themselves
    std::vector<PaperBuild> paper_builds; ///< of `reproduce`; empty: all
    SearchSize searches;                  ///< of `reproduce`
    bool resume = false;                  ///< continue from the journal

    std::vector<std::string> gpus;                    ///< of `inspect`: targets; empty: those of targets_of()
    std::vector<Entry> entries;                       ///< of `inspect`; empty: all
    std::optional<std::filesystem::path> code_folder; ///< of `inspect`: the folder for the code
    Isolation isolation = Isolation::device;
    double driver_limit_s = 0; ///< for each call of a driver; 0: by the size of its work

    std::vector<std::string> required; ///< backends that must have a usable device; of `inspect`, targets to be asked
    bool allow_flawed = false;
    bool defects = false;                                ///< of `check`: reduced kernels in place of rows
    bool stress = false;                                 ///< of `check`: stressors in place of rows
    unsigned variants = 0;                               ///< of `check`: changed kernels of each row; 0: rows
    std::optional<std::uint64_t> seed;                   ///< of the variants; empty: 1
    std::vector<std::string> changes;                    ///< of a case of `dump`: of the kernel's text, by name
    unsigned repeat = 1;                                 ///< of `check`: how often rows are checked
    std::vector<std::filesystem::path> expected;         ///< of `check`: files and folders of expectations
    std::optional<std::filesystem::path> write_expected; ///< of `check`: file or folder of what it showed
    std::vector<MadeRays> made_rays;                     ///< of `rays`; empty: all kinds
    unsigned made_count = 65'536;                        ///< of `rays`: rays of each kind
    std::optional<std::filesystem::path> answer_file;    ///< of `rays`: for the exact answers
    std::optional<std::filesystem::path> ray_file;       ///< of `judge`, as the next
    std::optional<std::filesystem::path> hit_file;
    double slack = 2;           ///< of `judge`: times what rounding in the kernels' formula can lose
    double tolerance = 0.03;    ///< of `compare`, a fraction: a row that is slower by more is a regression
    bool allow_missing = false; ///< of `compare`
    bool clear = false;
    std::vector<Picture> pictures;
    std::optional<std::filesystem::path> junit;          ///< of `check`
    std::optional<std::filesystem::path> picture_folder; ///< of `check`: pictures of the differences
    std::optional<std::filesystem::path> array_folder;   ///< of `bench` and `check`: verified answers as .npy files

    std::vector<std::filesystem::path> report_pictures;   ///< of `report`: PNG files
    std::optional<std::filesystem::path> chart_folder;    ///< of `report`: for the charts as SVG files
    std::optional<std::filesystem::path> portability_csv; ///< of `report`: for efficiencies on each platform

    std::optional<std::filesystem::path> out;
    std::optional<Format> format;
    bool brief = false;                       ///< of `bench` and `show`: one screen
    std::vector<std::string> columns;         ///< keys of the columns to print; empty: all that fit
    std::string label;                        ///< what the user calls the machine, or this run of it
    bool anonymous = false;                   ///< no host name and no folders in results
    std::vector<std::string> benchmark_flags; ///< Google Benchmark's, as given
};

/// Reads a command line, without the program's name.
/// Throws Error{usage} naming what is not accepted, and the accepted values.
[[nodiscard]] Options parse_options(const std::vector<std::string>& arguments);

/// Whether a check is of rows, and not of other kernels in their place.
[[nodiscard]] inline bool has_rows(const Options& options)
{
    return !options.defects && !options.stress && options.variants == 0;
}

/// The scenes asked for with their one set of build options; the default scenes where none was named. Precondition: one
/// domain, one kind of tets, at most one number of divisions and set of switches (parse_options ensures it, except for
/// `build`, which combines them, and `render`, which shows several kinds of tets).
[[nodiscard]] std::vector<SceneRequest> scene_requests(const Options& options);

/// The camera set's name, and its number of views: the user's own where one is given.
[[nodiscard]] std::string camera_set_name(const Options& options);
[[nodiscard]] std::size_t camera_set_size(const Options& options);

/// The shard that the options name; the whole run where they name none.
[[nodiscard]] Shard shard_of(const Options& options);

/// The words of a command line without options of these names, and without their values.
[[nodiscard]] std::vector<std::string> without_options(const std::vector<std::string>& words,
                                                       std::span<const std::string_view> names);

/// Throws Error{usage} if the shard is without views. (`reproduce` has other parts, and does not need one of each
/// scene.)
void require_views(const Options& options);

/// The view numbers asked for, ascending, of which the shard has its share. Throws Error{usage} as parse_views() does.
[[nodiscard]] std::vector<std::uint32_t> selected_views(const Options& options);

} // namespace tetrace
