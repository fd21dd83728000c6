// What people get wrong on a command line, and the first words that answer it.
#include "tests/support/program_fixture.h"

#include <filesystem>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

struct Wrong {
    const char* arguments;
    int code;
    const char* answer; ///< the beginning of standard error, after "tetrace: "
};

constexpr Wrong wrong_usages[] = {
    // words and names of options
    {"bunny --scen", 2, "'bunny' is not a verb; a scene is 'tetrace bench --scene bunny'; accepted: devices, "},
    {"becnh", 2, "'becnh' is not a verb; did you mean bench? Accepted: devices, "},
    {"--verison", 2, "'--verison' is not a verb; did you mean --version? Accepted: "},
    {"-x", 2, "'-x' is not a verb; accepted: devices, "},
    {"help becnh", 2, "help: 'becnh' is not accepted; did you mean bench? Accepted: devices, "},
    {"help bench check", 2, "help: 'check' is not expected; usage: tetrace help [VERB [all] | TOPIC]"},
    {"help man all", 2, "help: 'all' is not expected; usage: "},
    {"bench bunny --scen", 2, "bench: '--scen' is not an option; did you mean --scene?\naccepted options: "},
    {"bench bunny", 2, "bench: 'bunny' is not expected; a scene is '--scene bunny'\naccepted options: "},
    {"bench -x", 2, "bench: '-x' is not an option\naccepted options: "},
    {"bench --scene", 2, "bench: --scene needs a value: SCENE\naccepted options: "},
    {"bench --backend", 2, "bench: --backend needs a value: NAME\n"},
    {"bench --samples 8 --samples 9", 2, "--samples is given 2 times; it accepts one value"},
    {"check --size 8,9", 2, "--size accepts one value for 'check'; lists are for 'tetrace bench'"},
    {"check --samples 3", 2, "check: '--samples' is not an option of check, but of bench or reproduce\n"},
    {"check --picture x", 2, "check: --picture of check is now --differences\n"},
    {"devices --scene cubes", 2, "devices: '--scene' is not an option of devices, but of build, bench, check, "},
    {"scenes --clean", 2, "scenes: '--clean' is not an option; did you mean --clear?\n"},
    {"trace --views 2", 2, "trace: '--views' is not an option; did you mean --view?\n"},
    {"inspect --require sm_90", 2, "inspect: --require of inspect is now --require-target\n"},
    {"judge --mesh cubes --rays r.npy --hits h.npy", 2, "judge: --rays of judge is now --ray-file\n"},
    {"report --picture a.png a.json", 2, "report: --picture of report is now --image\n"},
    // names of values
    {"bench --backend openmp --scene buny", 2, "scene buny: neither a name of the catalogue (cubes, banana, bunny, "},
    {"bench --backend vulcan", 2, "--backend: 'vulcan' is not accepted; did you mean vulkan? Accepted: openmp, "},
    {"bench --backend openmp,", 2, "--backend: empty value in 'openmp,'; write values with one comma between"},
    {"bench --require vulcan", 2, "--require: 'vulcan' is not accepted; did you mean vulkan? Accepted: openmp, "},
    {"bench --method maira", 2, "--method: 'maira' is not accepted; did you mean maria? Accepted: all, plane, "},
    {"bench --layout tet81", 2, "--layout: 'tet81' is not accepted; did you mean tet80? Accepted: tet80, tet96, "},
    {"bench --structure tets", 2, "--structure: 'tets' is not accepted; accepted: cdt or bvh"},
    {"bench --rays primery", 2, "--rays: 'primery' is not accepted; did you mean primary? Accepted: primary, "},
    {"bench --ray-order morten", 2, "--ray-order: 'morten' is not accepted; did you mean morton? Accepted: tiles, "},
    {"bench --math fsat", 2, "--math: 'fsat' is not accepted; did you mean fast? Accepted: exact or fast"},
    {"bench --order chain", 2, "--order: 'chain' is not accepted; did you mean chains? Accepted: chains, "},
    {"bench --schedule tile", 2, "--schedule: 'tile' is not accepted; did you mean tiles? Accepted: tiles, "},
    {"bench --camera-set orbits", 2, "--camera-set: 'orbits' is not accepted; did you mean orbit? Accepted: frame, "},
    {"bench --camera-set none.json", 3, "--camera-set: reading 'none.json': the file does not exist"},
    {"bench --format jsn", 2, "--format: 'jsn' is not accepted; did you mean json? Accepted: table, json, "},
    {"bench --isolate devices", 2,
     "--isolate: 'devices' is not accepted; did you mean device? Accepted: none or device"},
    {"bench --tile 4x8", 2, "--tile: '4x8' is not accepted; did you mean 8x8? Accepted: 8x4 or 8x8"},
    {"bench --packet-lanes 5", 2, "--packet-lanes: '5' is not accepted; accepted: 4, 8 or 16"},
    {"render --picture step", 2,
     "--picture: 'step' is not accepted; did you mean steps? Accepted: normals, steps, hits, crossings, depth, "
     "light or tally"},
    {"reproduce table7", 2, "reproduce: 'table7' is not accepted; accepted: table3, table4, "},
    {"reproduce --builds theirs", 2, "--builds: 'theirs' is not accepted; accepted: ours, paper or rays"},
    // numbers
    {"bench --size 0", 2, "--size: '0' is not accepted; accepted: WxH or N, each from 1 to 16384"},
    {"bench --size 10x", 2, "--size: '10x' is not accepted; accepted: WxH or N, each from 1 to 16384"},
    {"bench --views 9-3", 2, "--views: '9-3' is not accepted; accepted: numbers (3), ranges (10-20) and strides "},
    {"bench --views 4", 2, "--views: view 4 does not exist; this camera set has views 0 to 3"},
    {"bench --views ''", 2, "--views: the value is empty"},
    {"trace --scene cubes --pixel 1,1 --view 9", 2, "--view: view 9 does not exist; this camera set has views 0 to 3"},
    {"bench --threads -1", 2, "--threads: '-1' is not accepted; accepted: a whole number from 0 to 4096"},
    {"bench --samples many", 2, "--samples: 'many' is not accepted; accepted: a whole number from 3 to 10000"},
    {"bench --runs 0", 2, "--runs: '0' is not accepted; accepted: a whole number from 1 to 100"},
    {"bench --sample-time 2m", 2, "--sample-time: '2m' is not accepted; accepted: 0 to 60 seconds"},
    {"bench --budget soon", 2,
     "--budget: 'soon' is not accepted; accepted: a positive number of seconds, or a number "},
    {"bench --buffer-limit 1.5G", 2, "--buffer-limit: '1.5G' is not accepted; accepted: a whole number of bytes, or "},
    {"bench --shard 3/2", 2, "--shard: '3/2' is not accepted; accepted: K/N, the K-th of N shards, "},
    {"compare --tolerance 200 a b", 2, "--tolerance: '200' is not accepted; accepted: a percentage from 0 to 100, "},
    {"reproduce --searches 10x10", 2, "--searches: '10x10' is not accepted; accepted: TETSxRAYS, 1 to 1000000 tets "},
    {"trace --scene cubes --pixel 1", 2, "--pixel: '1' is not accepted; accepted: X,Y, two whole numbers from 0"},
    {"trace --scene cubes --pixel 300,1", 2,
     "--pixel: 300,1 is outside the image, whose pixels go from 0,0 to 255,255"},
    // files, and what is missing or does not go together
    {"compare one.json", 2, "compare: one file is given; usage: tetrace compare A.json B.json "},
    {"show", 2, "show: no file is given; usage: tetrace show RESULT.json "},
    {"show missing.json", 3, "reading the result 'missing.json': the file does not exist"},
    {"bench --out result.xml", 2, "--out: the extension of 'result.xml' does not name a format; use .json, "},
    {"bench --out ''", 2, "--out: the file name is empty"},
    {"bench --backend openmp --resume", 2,
     "--resume: the journal is in the result's folder; name the result's file with "},
    {"bench --no-repair --repair", 2, "--no-repair: --repair is given, too; leave one of them out"},
    {"render --scene cubes --picture hits --out a.png", 2, "--out 'a.png': --picture hits is written as .exr only; "},
    {"render --scene cubes --picture hits --tets cdt,rays", 2, "--picture hits: a file has the hits of one kind of "},
    {"bench --tets cdt,rays", 2, "--tets accepts one value for 'bench'; lists are for 'tetrace build'"},
    {"bench --backend openmp --filter '('", 2, "--filter: '(' is not a regular expression (RE2 syntax): "},
    {"bench --columns mrays", 2, "--columns: no table has the column 'mrays'; accepted: row, "},
    {"bench --backend openmp --junit - --benchmark_format=json", 2, "--junit -: --benchmark_format writes to "},
    {"bench --backend openmp --require embree", 3, "--require embree: no row of embree is selected, so none would be "},
    {"check --stress --shard 1/2", 2, "--stress takes only seconds and cannot be sharded; leave out --shard"},
    {"check --defects --shard 1/2", 2, "--defects takes only seconds and cannot be sharded; leave out --shard"},
    {"check --seed 3", 2, "--seed chooses variants; say how many with --variants"},
    {"check --variants 0", 2, "--variants: '0' is not "},
    {"check --variants 2 --stress", 2, "--variants changes the kernels of rows, and --defects and --stress run others"},
    {"check --variants 2 --expect expected", 2, "--variants has no expectations and no shards; leave out --expect, "},
    {"inspect --variants 2 --code code", 2,
     "--variants: inspect compiles them for GPUs that --target names, and keeps no "},
    {"inspect --budget 5m", 2, "--budget: inspect has it only with --variants"},
    {"dump --backend opencl --variant no/such --out case", 2, "--variant: the kernel's text has no change 'no/such'"},
    {"trace", 2, "trace: --scene SCENE is missing: which scene?"},
    {"trace --scene cubes", 2, "trace: --pixel X,Y is missing: which ray?"},
    {"dump --backend vulkan", 2, "dump: --out FOLDER is missing: where to?"},
};

class WrongUsage : public ProgramTest {};

} // namespace

TEST_F(WrongUsage, is_answered_with_what_is_wrong_first_and_nothing_is_written)
{
    for (const auto& [arguments, code, answer] : wrong_usages) {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, code) << arguments << '\n' << ended.errors;
        const std::string errors = ended.errors.starts_with("tetrace: ") ? ended.errors.substr(9) : ended.errors;
        EXPECT_TRUE(errors.starts_with(answer)) << arguments << '\n' << ended.errors;
        EXPECT_EQ(ended.out, "") << arguments;
    }
    EXPECT_TRUE(contains(run("bench --backend openmp --scene buny").errors, "; did you mean bunny?"));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        EXPECT_TRUE(entry.is_directory() || entry.path().filename().string().starts_with("std")) << entry.path();
}
