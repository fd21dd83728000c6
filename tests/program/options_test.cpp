#include "bench/options/help.h"
#include "bench/options/option_table.h"
#include "bench/options/option_values.h"
#include "bench/options/options.h"
#include "bench/terminal/text.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::string rejection(const std::vector<std::string>& arguments)
{
    const std::string error = error_of([&] { static_cast<void>(parse_options(arguments)); });
    EXPECT_TRUE(error.starts_with("usage: ")) << (error.empty() ? "accepted" : error);
    return error;
}

/// Whether a verb has an option of this name: an option may have a row for each of several verbs.
bool takes(Verb verb, const std::string& name)
{
    return std::ranges::any_of(option_table(),
                               [&](const OptionRow& row) { return row.name == name && tetrace::takes(verb, row); });
}

} // namespace

TEST(Options, without_arguments_help_is_asked_for)
{
    EXPECT_EQ(parse_options({}).verb, Verb::help);
    EXPECT_EQ(parse_options({"--help"}).verb, Verb::help);
    EXPECT_EQ(parse_options({"bench", "--help"}).help_topic, "bench");
    EXPECT_EQ(parse_options({"help", "build"}).help_topic, "build");
    EXPECT_EQ(parse_options({"--version"}).verb, Verb::version);
    EXPECT_EQ(parse_options({"-V"}).verb, Verb::version);
    EXPECT_EQ(parse_options({"-h"}).verb, Verb::help);
    EXPECT_EQ(parse_options({"check", "-h"}).help_topic, "check");
    for (const char* const way : {"--help=all", "all"}) {
        const Options all =
            way == std::string("all") ? parse_options({"help", "bench", way}) : parse_options({"bench", way});
        EXPECT_EQ(all.help_topic, "bench");
        EXPECT_TRUE(all.whole_help);
    }
    for (const VerbHelp& verb : verb_helps()) {
        if (verb.verb == Verb::help) continue;
        const std::string name(name_of(verb.verb));
        EXPECT_EQ(parse_options({name, "-h"}).help_topic, name);
        EXPECT_FALSE(parse_options({name, "-h"}).whole_help);
        EXPECT_EQ(parse_options({name, "-V"}).verb, Verb::version) << name;
    }
    EXPECT_EQ(parse_options({"bench", "-o", "r.json"}).words, parse_options({"bench", "--out", "r.json"}).words);
}

TEST(Options, slips_of_the_hand_get_a_guess)
{
    EXPECT_TRUE(contains(rejection({"bench", "--smaples", "3"}), "; did you mean --samples?"));
    EXPECT_TRUE(contains(rejection({"bench", "--scne=bunny"}), "; did you mean --scene?"));
    EXPECT_TRUE(
        contains(rejection({"bench", "bunny", "--scen"}), "bench: '--scen' is not an option; did you mean --scene?"));
    EXPECT_TRUE(contains(rejection({"bench", "-s", "3"}), "bench: '-s' is not an option\n"));
    EXPECT_TRUE(contains(rejection({"becnh"}), "'becnh' is not a verb; did you mean bench?"));
    EXPECT_FALSE(contains(rejection({"bench", "--colour"}), "did you mean"));
    EXPECT_FALSE(contains(rejection({"draw"}), "did you mean"));
    EXPECT_EQ(did_you_mean("ab", {"abc", "cb"}), "") << "of short names everything is near";
    EXPECT_EQ(did_you_mean("table7", {"table3", "table4"}), "") << "which of them?";
    EXPECT_TRUE(
        contains(rejection({"bench", "--backend", "vulcan"}), "'vulcan' is not accepted; did you mean vulkan? "));
    EXPECT_TRUE(contains(rejection({"bench", "--method", "maira"}), "; did you mean maria? Accepted: all, plane, "));
}

TEST(Options, all_scenes_are_those_of_the_catalogue)
{
    EXPECT_EQ(parse_options({"bench", "--scene", "all"}).scenes, all_scenes());
    EXPECT_TRUE(contains(rejection({"trace", "--scene", "all", "--pixel", "1,1"}), "trace: --scene accepts one scene"));
}

TEST(Options, defaults_are_those_of_the_main_job)
{
    const Options options = parse_options({"bench"});
    EXPECT_TRUE(options.scenes.empty());
    EXPECT_EQ(options.camera_set, CameraSet::frame);
    EXPECT_EQ(selected_views(options), (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(selected_views(parse_options({"bench", "--scene", "cubes"})).size(), 4u);
    EXPECT_EQ(selected_views(parse_options({"bench", "--camera-set", "smoke"})).size(), 4u);
    EXPECT_EQ(options.width, 1024u);
    EXPECT_EQ(options.height, 1024u);
    EXPECT_EQ(options.samples, 10u);
    EXPECT_EQ(scene_requests(options).front().build.tets, TetsKind::rays);
    EXPECT_EQ(scene_requests(options).front().build.divisions, default_build(TetsKind::rays).divisions);
    EXPECT_EQ(scene_requests(parse_options({"reproduce"})).front().build.tets, TetsKind::cdt);
    EXPECT_EQ(scene_requests(parse_options({"check", "--tets", "cdt"})).front().build.switches, "pq5Y");
    EXPECT_FALSE(options.format.has_value());
}

TEST(Options, lists_take_commas_and_repetition)
{
    const Options options =
        parse_options({"bench", "--scene", "cubes,banana", "--scene=bunny", "--layout", "tet80,tet96"});
    EXPECT_EQ(options.scenes, (std::vector<std::string>{"cubes", "banana", "bunny"}));
    EXPECT_EQ(options.layouts, (std::vector<Layout>{Layout::tet80, Layout::tet96}));
    EXPECT_TRUE(contains(rejection({"bench", "--scene", "cubes,,bunny"}), "empty value"));
    const TemporaryFolder folder;
    const std::string file = folder / "a,b,,c.obj";
    write_file(file, "v 0 0 0\n");
    using Names = std::vector<std::string>;
    EXPECT_EQ(parse_options({"bench", "--scene", file}).scenes, Names{file}) << "a name that is a file is a file";
    EXPECT_EQ(parse_options({"bench", "--scene", "cubes," + file + ",banana"}).scenes,
              (Names{"cubes", file, "banana"}));
}

TEST(Options, an_unknown_option_is_answered_with_the_accepted_ones)
{
    const std::string text = rejection({"bench", "--scenes", "cubes"});
    EXPECT_TRUE(contains(text, "--scenes"));
    // Rows of other verbs have these names, or the beginning of one.
    const std::set<std::string> of_bench_too = {"--out",         "--format", "--samples",
                                                "--sample-time", "--budget", "--view"};
    for (const OptionRow& row : option_table())
        EXPECT_EQ(bool(contains(text, row.name)), takes(Verb::bench, row.name) || of_bench_too.count(row.name) > 0)
            << row.name;
}

TEST(Options, an_unknown_value_is_answered_with_the_accepted_ones)
{
    EXPECT_TRUE(contains(rejection({"bench", "--method", "bsp"}), "all, plane, plucker, stp, ms06, maria, "));
    const std::vector<Method> methods = parse_options({"bench", "--method", "all"}).methods;
    for (const KernelId& kernel : all_kernels())
        EXPECT_EQ(std::count(methods.begin(), methods.end(), kernel.method), 1) << name_of(kernel);
    EXPECT_EQ(parse_options({"bench", "--method", "stp,ms06"}).methods,
              (std::vector<Method>{Method::stp, Method::ms06}));
    EXPECT_TRUE(contains(rejection({"bench", "--backend", "metal"}), "openmp, opencl, vulkan, cuda, cuda-host"));
    EXPECT_TRUE(contains(rejection({"bench", "--camera-set", "Orbit"}), "frame, smoke, orbit or flight"));
    EXPECT_TRUE(contains(rejection({"bench", "--format", "xml"}), "table, json, csv or markdown"));
    EXPECT_TRUE(contains(rejection({"bench", "--order", "morton"}), "chains, hilbert, reached or input"));
    EXPECT_TRUE(contains(rejection({"draw"}), "devices, scenes, build, bench, check, render, reproduce, inspect, "
                                              "trace, dump, rays, judge, compare, show, report, page, merge, "
                                              "help, --help or --version"));
    EXPECT_TRUE(contains(rejection({"help", "draw"}), "bench"));
}

TEST(Options, options_of_other_verbs_are_not_accepted)
{
    EXPECT_TRUE(contains(rejection({"scenes", "--samples", "3"}), "--samples"));
    EXPECT_TRUE(contains(rejection({"check", "--benchmark_filter=x"}), "--benchmark_filter"));
    EXPECT_TRUE(contains(rejection({"bench", "stray"}), "stray"));
    EXPECT_TRUE(contains(rejection({"bench", "--scene", "cubes", "stray"}), "stray")) << "a value each";
}

TEST(Options, build_takes_lists_where_others_take_one_value)
{
    const Options options =
        parse_options({"build", "--switches", "p,pq5Y", "--domain", "tight,wide", "--divisions", "4,8"});
    EXPECT_EQ(options.switches, (std::vector<std::string>{"p", "pq5Y"}));
    EXPECT_EQ(options.domains, (std::vector<DomainKind>{DomainKind::tight, DomainKind::wide}));
    EXPECT_EQ(options.divisions, (std::vector<std::uint32_t>{4, 8}));
    EXPECT_EQ(parse_options({"build", "--tets", "cdt,rays"}).tets, (std::vector{TetsKind::cdt, TetsKind::rays}));
    EXPECT_TRUE(contains(rejection({"bench", "--switches", "p,pq5Y"}), "one value"));
    EXPECT_EQ(parse_options({"render", "--tets", "cdt,rays"}).tets.size(), 2u) << "side by side";
    EXPECT_TRUE(contains(rejection({"bench", "--tets", "cdt,rays"}), "one value"));
    EXPECT_TRUE(contains(rejection({"bench", "--tets", "delaunay"}), "rays"));
    EXPECT_TRUE(contains(rejection({"bench", "--effort", "4"}), "--effort"));
    EXPECT_TRUE(contains(rejection({"check", "--size", "8", "--size", "9"}), "one value"));
}

TEST(Options, values_reach_the_scene_requests)
{
    const Options options =
        parse_options({"bench", "--scene", "cubes", "--domain", "wide", "--divisions", "3", "--switches", "pq",
                       "--resolution", "5", "--time-limit", "2m", "--memory-limit", "3M"});
    const auto requests = scene_requests(options);
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].build.domain, DomainKind::wide);
    EXPECT_EQ(requests[0].build.divisions, 3u);
    EXPECT_EQ(requests[0].build.switches, "pq");
    EXPECT_EQ(requests[0].build.resolution, 5u);
    EXPECT_EQ(requests[0].build.time_limit_s, 120);
    EXPECT_EQ(requests[0].build.memory_limit_bytes, 3u << 20);
}

TEST(Options, google_benchmarks_flags_pass_through)
{
    const Options options =
        parse_options({"bench", "--benchmark_repetitions=5", "--size", "8", "--benchmark_filter=maria"});
    EXPECT_EQ(options.benchmark_flags,
              (std::vector<std::string>{"--benchmark_repetitions=5", "--benchmark_filter=maria"}));
}

TEST(Options, help_has_no_line_of_one_short_word)
{
    EXPECT_EQ(wrapped_without_orphans("one two three four", 13, 2), "  one two\n  three four\n");
    EXPECT_EQ(wrapped_without_orphans("one two incomprehensible", 9, 0), "one two\nincomprehensible\n");
    for (const Verb verb : {Verb::devices, Verb::scenes, Verb::build, Verb::bench, Verb::check, Verb::render,
                            Verb::reproduce, Verb::compare, Verb::report, Verb::help}) {
        std::istringstream lines(help_text(std::string(name_of(verb)), true));
        for (std::string line, before; std::getline(lines, line); before = line) {
            const std::string words = line.substr(std::min(line.find_first_not_of(' '), line.size()));
            const bool is_short_word = !words.empty() && words.size() <= 12 && words.find(' ') == std::string::npos;
            EXPECT_FALSE(before.size() > 60 && is_short_word && words.find("--") != 0) << before << "\n" << line;
        }
    }
}

TEST(Options, help_of_a_verb_is_a_screen_with_its_usual_options_and_says_where_all_of_them_are)
{
    for (const VerbHelp& verb : verb_helps()) {
        const std::string name(name_of(verb.verb)), page = first_page(verb, 80), whole = help_text(name, true);
        EXPECT_LE(std::ranges::count(page, '\n'), 24) << page;
        std::istringstream lines(page);
        for (std::string line; std::getline(lines, line);)
            EXPECT_LE(display_width(line), 80u) << line;
        EXPECT_TRUE(page.starts_with("Usage: tetrace " + name + " ")) << page;
        EXPECT_TRUE(contains(page, "tetrace help " + name + " all\n")) << page;
        std::size_t usual = 0, all = 0;
        for (const OptionRow& row : option_table()) {
            const bool is_taken = takes(verb.verb, row);
            const bool is_shown = page.find("\n  " + row.name + " ") != std::string::npos;
            EXPECT_TRUE(takes(verb.verb, row.name) || !is_shown) << name << ' ' << row.name;
            EXPECT_TRUE(!is_taken || contains(whole, "\n  " + row.name)) << name << ' ' << row.name;
            usual += is_taken && is_shown;
            all += is_taken;
        }
        EXPECT_LE(usual, 10u) << page;
        EXPECT_GE(usual, std::min<std::size_t>(all, 2)) << page;
    }
}

TEST(Options, an_option_of_other_verbs_is_answered_with_these)
{
    EXPECT_TRUE(
        contains(rejection({"devices", "--clear"}), "devices: '--clear' is not an option of devices, but of scenes"));
    EXPECT_TRUE(contains(rejection({"trace", "--views", "1"}), "'--views' is not an option; did you mean --view?"));
}

TEST(Options, every_row_is_taken_by_a_verb_and_described_with_a_full_sentence)
{
    std::set<std::pair<std::string, unsigned>> seen;
    for (const OptionRow& row : option_table()) {
        EXPECT_NE(row.verbs, 0u) << row.name;
        EXPECT_EQ(row.help.back(), '.') << row.name;
        EXPECT_EQ(row.name.rfind("--", 0) == 0, row.name != "TABLE") << row.name << " has a place, not dashes";
        for (unsigned verb = 0; verb < 32; ++verb)
            if ((row.verbs >> verb & 1u) != 0) {
                EXPECT_TRUE(seen.insert({row.name, verb}).second) << row.name;
            }
    }
}

TEST(Options, compare_takes_two_files_or_more_and_a_tolerance_in_percent)
{
    const Options options = parse_options({"compare", "a.json", "--tolerance", "2.5%", "b.json"});
    EXPECT_EQ(options.files, (std::vector<std::filesystem::path>{"a.json", "b.json"}));
    EXPECT_DOUBLE_EQ(options.tolerance, 0.025);
    EXPECT_TRUE(contains(rejection({"compare", "a.json"}), "one file is given; usage: tetrace compare A.json B.json"));
    EXPECT_EQ(parse_options({"compare", "a", "b", "c"}).files.size(), 3u);
    EXPECT_TRUE(contains(rejection({"show", "a", "b"}), "2 files are given"));
    EXPECT_TRUE(contains(rejection({"compare", "a", "b", "--samples", "3"}), "--tolerance"));
    EXPECT_EQ(parse_percent("--tolerance", "0"), 0);
    for (const char* const bad : {"", "%", "-1", "101", "nan", "3 %", "three"})
        EXPECT_THROW(static_cast<void>(parse_percent("--tolerance", bad)), Error) << bad;
}

TEST(Options, of_the_files_for_other_projects_ci_are_accepted)
{
    for (const char* name : {"github.yml", "gitlab.yml"}) {
        std::ifstream file(std::filesystem::path(TETRACE_DOCS) / "ci" / name);
        std::vector<Verb> verbs;
        for (std::string line; std::getline(file, line);) {
            const std::size_t at = line.find("/bin/tetrace ");
            if (at == std::string::npos) continue;
            std::istringstream rest(line.substr(at + 13));
            const std::vector<std::string> words{std::istream_iterator<std::string>(rest), {}};
            verbs.push_back(parse_options(words).verb);
        }
        EXPECT_EQ(verbs, (std::vector<Verb>{Verb::check, Verb::inspect})) << name;
    }
}

TEST(OptionValues, views_take_numbers_ranges_and_strides)
{
    EXPECT_EQ(parse_views("0,3,10-12", 20), (std::vector<std::uint32_t>{0, 3, 10, 11, 12}));
    EXPECT_EQ(parse_views("0-1281:640", 1282), (std::vector<std::uint32_t>{0, 640, 1280}));
    EXPECT_EQ(parse_views("3,1,1-3", 4), (std::vector<std::uint32_t>{1, 2, 3}));
    EXPECT_EQ(parse_views("", 4).size(), 4u);
    for (const char* const bad : {"4", "x", "1-", "-1", "3-1", "0-3:0", "1,,2", "0-4"})
        EXPECT_THROW(static_cast<void>(parse_views(bad, 4)), Error) << bad;
}

TEST(OptionValues, a_view_outside_the_set_is_named)
{
    EXPECT_TRUE(contains(rejection({"bench", "--views", "4"}), "view 4 does not exist; this camera set has views 0 "
                                                               "to 3"));
    EXPECT_EQ(selected_views(parse_options({"bench", "--views", "4", "--camera-set", "orbit"})),
              std::vector<std::uint32_t>{4});
}

TEST(OptionValues, sizes_counts_times_and_bytes_are_read_or_rejected)
{
    EXPECT_EQ(parse_size("--size", "640x480"), (std::pair<std::uint32_t, std::uint32_t>{640, 480}));
    EXPECT_EQ(parse_size("--size", "7"), (std::pair<std::uint32_t, std::uint32_t>{7, 7}));
    for (const char* const bad : {"", "0", "x", "3x", "x3", "3x4x5", "-1", "99999", "1.5"})
        EXPECT_THROW(static_cast<void>(parse_size("--size", bad)), Error) << bad;
    EXPECT_EQ(parse_seconds("--budget", "1.5"), 1.5);
    EXPECT_EQ(parse_seconds("--budget", "2h"), 7200);
    for (const char* const bad : {"", "0", "-1", "nan", "inf", "s", "5d"})
        EXPECT_THROW(static_cast<void>(parse_seconds("--budget", bad)), Error) << bad;
    EXPECT_EQ(parse_bytes("--memory-limit", "2G"), std::uint64_t{2} << 30);
    EXPECT_EQ(parse_bytes("--memory-limit", "17"), 17u);
    for (const char* const bad : {"", "G", "0", "1.5G", "99999999T", "-1"})
        EXPECT_THROW(static_cast<void>(parse_bytes("--memory-limit", bad)), Error) << bad;
    EXPECT_THROW(static_cast<void>(parse_count("--samples", "2", 3, 10)), Error);
}

TEST(Options, devices_schedules_tiles_and_buffer_limits_are_read)
{
    const Options options = parse_options(
        {"bench", "--device", "gpu,pocl", "--schedule", "persistent", "--tile", "8x4", "--buffer-limit", "64K"});
    EXPECT_EQ(options.devices, (std::vector<std::string>{"gpu", "pocl"}));
    EXPECT_EQ(options.schedules, std::vector<Schedule>{Schedule::persistent});
    EXPECT_EQ(options.tile_height, 4u);
    EXPECT_EQ(options.buffer_limit, 65536u);
    EXPECT_TRUE(contains(rejection({"bench", "--tile", "4x8"}), "8x4 or 8x8"));
    EXPECT_EQ(options.packet_lanes, 0u);
    EXPECT_EQ(parse_options({"check", "--packet-lanes", "8"}).packet_lanes, 8u);
    for (const char* const bad : {"0", "5", "32", "08", "all"})
        EXPECT_TRUE(contains(rejection({"bench", "--packet-lanes", bad}), "4, 8 or 16")) << bad;
    EXPECT_TRUE(contains(rejection({"bench", "--schedule", "dynamic"}), "persistent, packets, native or pipeline"));
    EXPECT_TRUE(contains(rejection({"bench", "--sample-time", "61"}), "0 to 60 seconds"));
    EXPECT_TRUE(contains(rejection({"bench", "--sample-time", "2m"}), "0 to 60 seconds"));
    EXPECT_EQ(parse_options({"bench", "--sample-time", "0.0"}).sample_s, 0);
    EXPECT_EQ(parse_options({"bench", "--sample-time", "1m"}).sample_s, 60);
    EXPECT_EQ(parse_options({"bench"}).sample_s, 0.1);
    EXPECT_EQ(parse_options({"reproduce"}).sample_s, 0.005) << "of each view";
    EXPECT_EQ(parse_options({"reproduce", "--sample-time", "0.02s"}).sample_s, 0.02);
}

TEST(Options, files_stand_between_options_wherever_they_are_given)
{
    const Options options = parse_options({"report", "a.json", "--out", "page.html", "b,c.json"});
    EXPECT_EQ(options.files, (std::vector<std::filesystem::path>{"a.json", "b,c.json"}));
    EXPECT_EQ(options.out, "page.html");
    EXPECT_EQ(parse_options({"report", "--image", "a.png,b.png", "a.json"}).report_pictures,
              (std::vector<std::filesystem::path>{"a.png", "b.png"}));
    EXPECT_TRUE(contains(rejection({"report"}), "no file is given"));
    EXPECT_TRUE(
        contains(rejection({"bench", "--size", "8", "9"}), "bench: '9' is not expected; a scene is '--scene 9'"));
}

TEST(Options, each_name_has_one_meaning_and_a_former_name_is_answered_with_the_new_one)
{
    EXPECT_EQ(parse_options({"check", "--differences", "folder"}).picture_folder, "folder");
    EXPECT_EQ(parse_options({"check", "--junit", "check.xml"}).junit, "check.xml");
    EXPECT_TRUE(contains(rejection({"render", "--picture", "folder"}),
                         "normals, steps, hits, crossings, depth, light or tally"));
    EXPECT_TRUE(contains(rejection({"check", "--picture", "folder"}), "--picture of check is now --differences"));
    EXPECT_TRUE(contains(rejection({"report", "--picture=a.png", "a.json"}), "--picture of report is now --image"));
    EXPECT_TRUE(contains(rejection({"inspect", "--require", "sm_90"}), "--require of inspect is now --require-target"));
    EXPECT_TRUE(contains(rejection({"check", "--junit", ""}), "--junit: the file name is empty"));
}

TEST(Options, reproduce_takes_tables_wherever_they_stand_and_the_papers_views)
{
    const Options options = parse_options({"reproduce", "--scene", "cubes", "figure6,table4", "--resume"});
    EXPECT_EQ(options.targets, (std::vector<PaperTarget>{PaperTarget::figure6, PaperTarget::table4}));
    EXPECT_EQ(options.scenes, std::vector<std::string>{"cubes"});
    EXPECT_EQ(options.camera_set, CameraSet::flight);
    EXPECT_TRUE(options.resume);
    EXPECT_TRUE(contains(rejection({"reproduce", "table1"}),
                         "table3, table4, table5, table6, figure6, rivals, ladder or volume"));
}

TEST(Options, rivals_are_measured_as_bench_measures)
{
    const Options options = parse_options({"reproduce", "rivals"}), bench = parse_options({"bench"});
    EXPECT_EQ(options.camera_set, bench.camera_set);
    EXPECT_EQ(options.tets, bench.tets);
    EXPECT_EQ(options.samples, bench.samples);
    EXPECT_EQ(options.sample_s, bench.sample_s);
    EXPECT_TRUE(options.structures.empty()) << "BVHs too";
    EXPECT_EQ(parse_options({"reproduce", "rivals", "--budget", "30s"}).budget_s, 30);
    EXPECT_TRUE(contains(rejection({"reproduce", "rivals,table4"}), "run it by itself"));
    for (const char* const option : {"--shard=1/2", "--searches=10x32", "--builds=ours"})
        EXPECT_TRUE(contains(rejection({"reproduce", "rivals", option}), "is not for 'reproduce rivals'")) << option;
    EXPECT_TRUE(contains(rejection({"reproduce", "table6", "--runs", "3"}), "--runs is for 'reproduce rivals'"));
}

TEST(Options, every_verb_that_measures_has_a_budget)
{
    EXPECT_EQ(parse_options({"bench"}).budget_s, 240);
    EXPECT_EQ(parse_options({"reproduce", "rivals"}).budget_s, 600);
    for (const char* const verb : {"check", "reproduce"}) {
        EXPECT_TRUE(std::isinf(parse_options({verb}).budget_s)) << verb;
        EXPECT_EQ(parse_options({verb, "--budget", "30s"}).budget_s, 30) << verb;
    }
}

TEST(Options, all_builds_are_traced_unless_some_are_named)
{
    EXPECT_TRUE(parse_options({"reproduce"}).paper_builds.empty());
    EXPECT_EQ(parse_options({"reproduce", "--builds", "paper"}).paper_builds, std::vector{PaperBuild::paper});
    EXPECT_EQ(parse_options({"reproduce", "--builds", "ours,paper"}).paper_builds.size(), 2u);
    EXPECT_EQ(parse_options({"reproduce", "--builds", "rays"}).paper_builds, std::vector{PaperBuild::rays});
    EXPECT_TRUE(contains(rejection({"reproduce", "--builds", "theirs"}), "ours, paper or rays"));
    EXPECT_THROW((void)parse_options({"reproduce", "--tets", "rays"}), Error) << "the paper's claims are about CDTs";
    EXPECT_THROW((void)parse_options({"bench", "--builds", "paper"}), Error);
}

TEST(Options, searches_are_tets_times_rays_and_the_papers_by_default)
{
    EXPECT_EQ(parse_options({"reproduce", "table5"}).searches, (SearchSize{10'000, 16'384}));
    EXPECT_EQ(parse_options({"reproduce", "--searches", "3x1048576"}).searches, (SearchSize{3, 1'048'576}));
    for (const char* const bad :
         {"", "x", "8", "3x", "x8", "3x8x8", "0x8", "3x0", "-3x8", "3x12", "1000001x8", "3x1048584", "3x8 ", "3.5x8"})
        EXPECT_TRUE(contains(rejection({"reproduce", "--searches", bad}), "TETSxRAYS, 1 to 1000000 tets with 8 to"))
            << bad;
    EXPECT_TRUE(contains(rejection({"bench", "--searches", "3x8"}), "--searches"));
}
