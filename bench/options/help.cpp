#include "bench/options/help.h"

#include "bench/options/completion.h"
#include "bench/options/identity.h"
#include "bench/options/manual.h"
#include "bench/options/option_table.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>

namespace tetrace {

namespace {

const VerbHelp verb_help[] = {
    {Verb::devices, "list the devices of every backend",
     "Lists the devices of every backend of this build, grouped by hardware (everything that computes on the CPU is "
     "one group), with their limits and the result of a self-test of their arithmetic in exact mode. Then it lists "
     "what cannot be used, with the reason, and the optional parts of this build, with what to install for a missing "
     "one.",
     "  tetrace devices\n"
     "  tetrace devices --require openmp,vulkan   exit with 3 unless both are usable\n"},
    {Verb::scenes, "list the catalogue and the cache of built scenes",
     "Lists the catalogue: the source of each scene, and whether its mesh is available here. Then it lists the cache "
     "of built scenes, with sizes. The cache is in $XDG_CACHE_HOME/tetrace, or else in ~/.cache/tetrace.",
     "  tetrace scenes\n"
     "  tetrace scenes --clear                    empty the cache\n"},
    {Verb::build, "build scenes and report their size and steps per ray",
     "Builds the tetrahedralization of each scene, or finds it in the cache, and counts its tets, its faces, and the "
     "steps of the rays of a camera set. --tets, --domain, --divisions and --switches accept lists: every combination "
     "is built. A combination that fails is a row without numbers; standard error has the reason, and the others are "
     "still built. The exit code is that of the first failure: 2 if the mesh cannot be used. Ctrl-C during "
     "optimisation keeps the tets reached so far, in a separate file; a second Ctrl-C ends the program.",
     "  tetrace build --scene bunny\n"
     "  tetrace build --scene bunny --tets cdt,rays\n"
     "  tetrace build --scene dragon.ply --switches pq,pqY,pq5Y --domain tight,wide\n"
     "  tetrace build --scene bunny --divisions 4,8,16 --format markdown --out bunny.md\n"
     "  tetrace build --scene bunny --tets rays --out bunny.vtu    its tets, for ParaView\n"},
    {Verb::bench, "verify rows, then measure them",
     "Verifies every ray of every row, then measures the rows. A row is a combination of scene, structure, method, "
     "layout, kind of rays, math mode, backend and device.\n\n"
     "First, each row traces every selected view once, and every hit is verified. Then each row warms up and is "
     "sampled with Google Benchmark; the rows are interleaved at random. A sample traces all views in flight "
     "together, which gives the throughput; some passes launch each view separately, which gives the latency. Last, it "
     "measures the copy bandwidth and the launch latency of each device. Each row is compared with the same kernel "
     "under other APIs and with the fastest BVH on its hardware, with 95 % intervals computed from the samples. GPU "
     "APIs that are emulated on the CPU are marked, and never ranked with GPUs. For each kind of rays, the table "
     "shows what share of them enters the domain and what share hits.\n\n"
     "Default rows: maria on tet80 and tet96, project on half32 and tet64, and our three BVHs, on every usable device "
     "of every backend; project's packets on openmp; and Embree with single rays, packets of 8 and of 16, and "
     "streams, each on its own trees. --method all adds the other exit-face searches.\n\n"
     "Statuses: 'ok'; 'flawed', the method itself returns some wrong hits, or loses rays, because the walk found no "
     "exit face or reached its cap of steps (their number is printed, and the row keeps its rate; lost rays of maria "
     "and project, which claim to have none, give exit code 1); 'wrong', the row's hits differ from openmp's (no "
     "rate, exit code 1); 'unsupported', the host or the device cannot run this kernel; 'skipped', no usable device "
     "is here, or --budget leaves no time for the row; 'error'. The last three have a reason. 'noisy' replaces 'ok' if "
     "the interquartile range exceeds 5 % of the median, if other processes used more than a tenth of the CPUs, if a "
     "container's CPU quota stopped it, or if calibration (a fixed piece of work, repeated throughout the run) was a "
     "quarter slower during half of the "
     "samples.\n\n"
     "Google Benchmark's own flags (--benchmark_filter=REGEX, --benchmark_repetitions=N, --benchmark_out=FILE, "
     "--benchmark_format=console|json|csv, --benchmark_list_tests and so on) keep their meaning. A repetition is a "
     "sample; if their number is given, --budget does not apply.\n\n"
     "With --out FILE, finished views and samples are also kept in FILE.journal until the result is written: --resume "
     "goes on after Ctrl-C, a crash or a power cut.",
     "  tetrace bench\n"
     "  tetrace bench --scene bunny --camera-set orbit --views 0-1281:64 --out bunny.json\n"
     "  tetrace bench --scene bunny --method all\n"
     "  tetrace bench --scene cubes --method maria --math exact,fast --format csv\n"
     "  tetrace bench --filter 'tet96|embree' --list\n"
     "  tetrace bench --scene bunny --threads 1 --benchmark_repetitions=30\n"},
    {Verb::check, "verify every ray on every device, without timing",
     "Traces every selected view with every row on every device, and answers two questions about each ray.\n\n"
     "Does the device conform? In exact mode, all bits of all hits are compared with openmp's for the same method "
     "and layout. Each cell of the matrix is 'bit-exact'; 'within N ulp', t, u and v differ by no more than the "
     "device's self-test allows (0 if its division is correctly rounded); 'not exact', the hits are openmp's, but "
     "the self-test shows that the device contracts or rounds differently; 'wrong', with the number of rays, also "
     "if rays were never written, words outside the hits were written, or a second run returned other hits; or "
     "'unsupported', 'skipped' or 'error', with the reason. Equal hits have equal hashes.\n\n"
     "Is the method right? Each ray is verified with exact arithmetic on the original triangles. A hit agrees if "
     "the exact ray has the same one; it is counted as settled if an edge is within rounding error of the ray. "
     "Another hit is a tie if some curve within rounding error of the ray has it, which is checked exactly. Any "
     "other hit is wrong.\n\n"
     "The first differing ray and the first wrong ray of a row are printed in full, with the 'tetrace trace' "
     "command that follows it. --defects runs the reduced kernels of known compiler defects instead, and "
     "--stress kernels in forms in which compilers have been wrong, at up to a million items. --variants changes the "
     "text of the "
     "selected kernels at random, so that it means the same, and reduces what fails to the change that matters.\n\n"
     "--expect names files of what implementations are known to show, which --write-expect writes: what they list "
     "passes, and a change in either direction fails. --repeat finds rows that differ from one time to the next.\n\n"
     "Exits with 1 if a device is wrong or not exact. Wrong and lost rays that a method has on openmp, too, bit for "
     "bit, are the method's fault and not the device's: the row is 'flawed', its rays are counted, and the exit code "
     "is 0.\n\n"
     "Default rows: maria, project on half32 and tet64, and our three BVHs. Other exit-face searches are added if "
     "--method names them, and Embree if --structure, --method, --layout, --backend, --filter or --require does.",
     "  tetrace check --scene cubes --require opencl,vulkan --junit check.xml\n"
     "  tetrace check --scene bunny --backend vulkan --differences pictures\n"
     "  tetrace check --scene bunny --method all\n"
     "  tetrace check --scene cubes --write-expect expected\n"
     "  tetrace check --scene cubes --expect expected --repeat 10\n"
     "  tetrace check --defects --stress --junit defects.xml\n"
     "  tetrace check --variants 100 --scene cubes --size 32 --backend opencl,vulkan --budget 10m\n"
     "  tetrace check --scene bunny --camera-set flight --views 0-1281:40 --out check.json\n"},
    {Verb::render, "write pictures",
     "Traces the selected views and writes a picture of each: the surface shaded by its normals, or in false colour "
     "the "
     "steps of each ray, the tets that it crosses, the light of a medium, or a tally on a cut, side by side for "
     "several "
     "kinds of tets. "
     "The pictures are made by the first selected row of each scene.\n\n"
     "The file of --out ends in .png, .exr or .ppm, of hits only in .exr. With several pictures, scene, view and kind "
     "are inserted before the extension. If it is a folder, the pictures in it are named SCENE-VIEW-KIND.png, or .ppm "
     "if OpenImageIO is missing (PPM needs no library); hits are SCENE-VIEW-hits.exr.",
     "  tetrace render --scene bunny --views 0 --out bunny.png\n"
     "  tetrace render --scene armadillo --picture normals,steps --size 512\n"
     "  tetrace render --scene bunny --tets cdt,rays --picture steps --views 0 --out steps.png\n"
     "  tetrace render --scene bunny --picture hits --views 0 --out hits.exr\n"
     "  tetrace render --scene field --picture crossings,light --views 0\n"
     "  tetrace render --scene nested --picture tally --views 0 --size 512\n"},
    {Verb::reproduce, "regenerate the paper's tables and figures",
     "Regenerates the evaluation of Maria, Horna, Aveneau, \"Efficient Ray Traversal of Constrained Delaunay "
     "Tetrahedralization\" (GRAPP 2017), on every device that is here. The paper's numbers are printed next to ours, "
     "and each claim gets a verdict based on confidence intervals over the views: 'holds', 'does not hold' or 'not "
     "testable here'.\n\n"
     "Scenes are traced in up to three builds (--builds): a CDT with the usual options; banana, bunny and armadillo "
     "as close to the paper's counts as known; and tets for rays, to which no number of the paper is compared. If the "
     "mesh is not the paper's, the paper's numbers are shown without a ratio, with the reason.\n\n"
     "table3: tets, faces, memory and rates of each scene.\n\n"
     "table4: rays with a wrong result per image, by method, scene and device, verified as in 'check', and where they "
     "are. project, which is ours, is compared with the paper's methods.\n\n"
     "table5: the exit search by itself, without the walk: random tets, random rays that enter each by a known face, "
     "on one thread of the CPU and on every device. Every face found is compared with exact arithmetic. It needs no "
     "scene; --searches sets the number. A row needs about 80 MB for its rays. The table also has the operations and "
     "side products per search, which the kernels count themselves.\n\n"
     "table6: tets against BVHs. maria is compared with bvh2, which is the paper's kind of BVH, with bvh4 and cwbvh "
     "on every device, and with Embree on the host; through tets for rays, so is project on half32 and tet64. The "
     "table has frames/s, build time and memory; the ratio of their times, paired by view; and the number of rays "
     "after which a slower build pays off. In --method and --layout, names that belong to BVHs select only among the "
     "BVHs, and the others only among the tets.\n\n"
     "rivals: what this repository claims about the speed of tets and BVHs, measured again by rules that the authors "
     "of the BVHs would accept (docs/rivals.md): each ratio is to the fastest BVH of the device, on the same rays, "
     "over scenes that suit tets and scenes that do not. It is run by itself and measures as 'bench' does: all views "
     "together, with --samples, --sample-time and --budget as there. Default scenes: bunny, armadillo, atrium, city, "
     "terrain, spheres and grass, if available. 'tetrace show FILE.json --out page.md' writes the page again.\n\n"
     "ladder: what a step costs, as a scene outgrows one cache after the other (docs/ladder.md): nanoseconds per step "
     "of a ray alone, and of a full device, for random rays through lattices of 1 MB to 4 GB, with a figure per "
     "device. It is run by itself and measures as 'bench' does. Scenes too large for memory or --budget are left "
     "out, with the reason.\n\n"
     "volume: all tets of a ray, the sums of lengths per tet, and light (docs/volume.md), on every device, with one "
     "thread and with all: whether hashes and sums are equal, what the lengths of uniform lines are by integral "
     "geometry, and how many rays each method loses. It is run by itself and measures as 'bench' does.\n\n"
     "figure6: time over tets traversed, one point per view, their correlation, and pictures of the two extreme "
     "views.\n\n"
     "Timing: each view, and each batch of searches, has a launch of its own, as in the paper's frames per second. "
     "Otherwise it is timed as in 'bench': GPU rows are interleaved, then CPU rows; a sample has several passes if "
     "one is short (--sample-time); and a sample during which a GPU was throttled is repeated. Calibration and load "
     "are recorded throughout, also across --resume; a claim that depends on a noisy row is not testable.\n\n"
     "Views: those of the camera set 'flight'. --views selects a sample of them, and the numbers then have 95 % "
     "intervals. Default scenes: banana, bunny and armadillo, if available.\n\n"
     "Output: with --out FILE, each finished view or batch of searches, of ladder and volume each scene, is also kept "
     "in FILE.journal, so that --resume can continue a run that was stopped; pictures are written next to FILE. CSV "
     "has a row for each number, text, verdict and point of a figure; Markdown leaves out the points. Exits with 1 if "
     "a "
     "row differs from openmp's, and with 3 if no row could run here.",
     "  tetrace reproduce table4 --scene bunny --views 0-1281:20 --out table4.json\n"
     "  tetrace reproduce table6 --scene bunny --views 0-1281:20 --backend openmp,embree\n"
     "  tetrace reproduce table5 --searches 1000x16384 --backend openmp,cuda\n"
     "  tetrace reproduce rivals --out rivals.json    15 minutes on two cores; with --scene bunny, 3\n"
     "  tetrace reproduce ladder --size 1024 --out ladder.json\n"
     "  tetrace reproduce volume --out volume.json\n"
     "  tetrace reproduce --backend openmp --layout tet80 --out all.json --resume\n"},
    {Verb::inspect, "show what real GPU compilers make of the kernels",
     "Compiles every entry point of the selected kernels for GPUs that need not be here, and prints what the "
     "compilers report: registers, spills, scratch memory, occupancy, instructions, branches, loads, and AMD's "
     "own estimate of cycles. Nothing is run. AMD's targets are compiled by Mesa's RADV on null "
     "hardware (package mesa-vulkan-drivers), NVIDIA's by nvcc and ptxas. A target without its compiler is 'skipped', "
     "with the package to install. With --backend or --device the drivers of this machine are asked what they make of "
     "the kernels: Vulkan's by VK_KHR_pipeline_executable_properties, CUDA's and OpenCL's by what they report of a "
     "function.\n\n"
     "In exact mode no fused operation may decide a sign. The code of each program is searched for one: AMD's machine "
     "code, NVIDIA's PTX. 'none' means that none was found; 'boxes' counts those in the box tests of BVHs, which "
     "decide nothing; 'DECISIONS' counts the forbidden ones, and prints the first. Exits with 1 if there is one. "
     "docs/inspect.md explains each column and its limits. --variants compiles changed kernels that mean the same, as "
     "'check --variants' has them, and finds those that a compiler refuses or fuses.",
     "  tetrace inspect\n"
     "  tetrace inspect --backend cuda,vulkan --entry outside --schedule tiles\n"
     "  tetrace inspect --target gfx1100 --method all --out inspect.json\n"
     "  tetrace inspect --target sm_90 --method project --layout half32 --code code --require-target sm_90\n"
     "  tetrace inspect --target sm_90,gfx1100 --entry outside --variants 100 --budget 10m\n"},
    {Verb::trace, "follow one ray, step by step, on every device",
     "Follows the ray of one pixel through the tets on every selected device, next to openmp: each step with its tet, "
     "its exit face, the neighbour, and three side products. The first step at which a device differs from openmp is "
     "marked. 'check' prints this command for the first differing ray of a row.\n\n"
     "The steps come from the device's own kernel, the one that is measured: the whole image is traced repeatedly, "
     "with a cap that is one step higher each time, and the kernel returns the tet at which the ray was cut off. So a "
     "compiler defect that needs the neighbouring rays shows up here too; 'traced alone' is the same ray as an image "
     "of its own. The side products are the sides of the ray at the edges of the exit face (all of one sign if the "
     "face is right). The device computes each sum and product with the program of its self-test, because the kernel "
     "does not return its own.\n\n"
     "One kernel is followed: maria on tet80 by default; --method project without --layout means half32. --rays "
     "follows the ray of that kind that was made for the pixel, from the face on which it starts. Our BVHs (--layout "
     "bvh2, bvh4, cwbvh) lack steps, because their kernels do not report the nodes they visit; the hits are shown, "
     "and how many nodes and triangles openmp visits. Embree's kernels and a driver's (rt) return only the hit, and "
     "are refused. Exits with 1 if a device differs from openmp, with 2 if the ray does not exist, and with 3 if none "
     "of the selected devices could trace it. 'tetrace dump' with the same options, one --backend and --out FOLDER "
     "writes the ray's work-group as a reproducer.",
     "  tetrace trace --scene cubes --pixel 128,100\n"
     "  tetrace trace --scene bunny --view 2 --pixel 300,17 --size 512 --method project --backend vulkan\n"
     "  tetrace trace --scene cubes --pixel 128,100 --format json --out ray.json\n"},
    {Verb::dump, "write a kernel's source and code, or a reproducer, for a bug report",
     "Writes the files of one kernel as a backend's driver gets them. opencl: its source with all includes resolved. "
     "vulkan: GLSL, the SPIR-V of each program, and the machine code from drivers that return it. cuda: its source, "
     "PTX if NVRTC is here, and machine code if the build has it. cuda-host: its source as host C++. README.txt, which "
     "is also printed, says what each file is and how to compile it without tetrace. A driver is loaded only for its "
     "machine code, in this process, after everything else is written. Exits with 2 for a backend without such files: "
     "kernels of openmp and embree are parts of programs and libraries.\n\n"
     "With --scene and --pixel, or with --defect, it writes a case instead: a launch (one work-group of a "
     "scene's) as plain files, the expected output (openmp's), and a host in C that runs it on opencl or vulkan "
     "without tetrace: exit code 0 as expected, 1 different, 2 cannot run.",
     "  tetrace dump --backend vulkan --method project --layout half32 --out report\n"
     "  tetrace dump --backend opencl --method maria --layout tet80 --math fast --out report\n"
     "  tetrace dump --backend vulkan --method project --scene cubes --pixel 128,100 --out case\n"
     "  tetrace dump --backend opencl --defect loop_of_70000_iterations --out case\n"},
    {Verb::rays, "make rays for other programs, with exact answers",
     "Makes rays for a mesh, in the coordinates of its file, and writes them as a .npy file of NumPy: N x 8 numbers of "
     "float32, origin, t_min, direction, t_max. --answers also writes what each ray meets first, by exact arithmetic: "
     "N x 4 numbers, face, t, u, v. The rays are the same on every machine. 'tetrace judge' judges the answers of "
     "another program to these rays, or to any others. docs/judge.md has the formats, and an example with NumPy.",
     "  tetrace rays --scene bunny.ply --rays hard --out rays.npy\n"
     "  tetrace rays --scene bunny.ply --count 1000000 --out rays.npy --answers hits.npy\n"},
    {Verb::judge, "judge another program's answers to rays by exact arithmetic",
     "Reads a mesh, rays and the answers of any ray tracer, and decides each answer with exact arithmetic on the mesh "
     "as "
     "its file has it. Each ray has one verdict: 'right'; 'tie', another triangle is exactly as near, as at a shared "
     "edge; 'inaccurate', the nearest triangle, with a t, u or v that is not of the point; 'wrong', a triangle that is "
     "not the nearest; 'missed', a miss although the ray meets a triangle; 'invented', a triangle although it meets "
     "none. The last four are faults. The first is printed in full, and the number of faults that rounding near an "
     "edge "
     "may explain. Exits with 1 if there is a fault. docs/judge.md defines every verdict and tolerance.",
     "  tetrace judge --mesh bunny.ply --ray-file rays.npy --hits hits.npy\n"
     "  tetrace judge --mesh bunny.ply --ray-file rays.npy --hits hits.npy --slack 16 --out judged.json --junit "
     "judged.xml\n"},
    {Verb::compare, "compare results of bench, or two of check, row by row",
     "Compares the rows of B.json with those of the same name in A.json: another commit, driver, compiler or machine. "
     "Both were made by 'tetrace bench --out' or 'tetrace reproduce --out' (the exit searches of table5 are rows "
     "too). The head of the output says what differs between them. For each row it prints the ratio of the rates (of "
     "the medians; above 1, B is faster) with its interval from the samples, and a verdict:\n\n"
     "'SAME', the interval is within --tolerance; 'FASTER' or 'SLOWER', the interval does not contain 1; 'UNSURE', "
     "the interval contains 1 and exceeds the tolerance, or there are fewer than 5 samples, which give no interval: "
     "more samples would decide; 'NOISY', calibration was a quarter slower in one of the two ('tetrace help bench'), "
     "so the row decides nothing. 'DIFFERENT', both timed the row, but scenes, views, launches on a GPU or hit hashes "
     "differ, so it is not compared (Embree's hits, and those of math mode fast, depend on the CPU). Rows that only "
     "one of them timed are 'FAILED' (wrong or in error in B), 'MISSING' (not in B, or skipped or unsupported there) "
     "or 'NEW'. The geometric mean excludes these and DIFFERENT rows.\n\n"
     "The intervals are based on ranks; the only assumption is that samples are independent. If nothing changed, the "
     "chance that any row of the comparison is called FASTER or SLOWER is at most 1 in 100, with 10 or more samples "
     "per row; with 5 to 9, it is at most 1 in 100 for each row. Two runs also differ in ways that their samples do "
     "not show: the tolerance is for that.\n\n"
     "Three or more results are printed side by side, a column each, with ratios to the first, for the rows that did "
     "the same work; the others are listed with the reason. Verdicts are not given; the exit code is 0, "
     "or 2 if a result shares no row with the first.\n\n"
     "Two results of 'check' are compared by what they found: 'BECAME WRONG', 'BECAME RIGHT', 'CHANGED' (another "
     "result, and neither fails, or both do), 'NEW' and 'MISSING'. The first, a new row that fails and a missing one "
     "exit with 1.\n\n"
     "With two results, exits with 1 if a row is SLOWER by more than the tolerance, FAILED or MISSING (see "
     "--allow-missing). Exits with 2, and names the rows, if all are DIFFERENT.",
     "  tetrace compare before.json after.json\n"
     "  tetrace compare driver-1.json driver-2.json --filter api:vulkan --tolerance 1\n"
     "  tetrace compare main.json branch.json --allow-missing --format markdown\n"
     "  tetrace compare zen3.json zen5.json xeon.json\n"},
    {Verb::show, "print a result again",
     "Prints what the run that wrote RESULT.json printed, from the JSON, with the same code: for results of bench, "
     "check (with --defects too), reproduce and trace. A line 'Not here' at the end names what the JSON does not "
     "have. For a check, that is the tets that a differing ray walks through (its 'path' lists them) and the command "
     "that follows the ray; for older results, what they did not record. --format markdown is for posting it.",
     "  tetrace show bench.json\n"
     "  tetrace show bench.json --columns mrays_per_s,spread,status\n"
     "  tetrace show check.json --format markdown\n"},
    {Verb::report, "write one HTML page from results",
     "Writes one self-contained page from any number of result files: whether to trust their rates, for two results "
     "how B compares with A, machines and devices, rates with their spread, APIs compared with intervals, each "
     "device's roofline with its rows on it, the matrix of check, what inspect found, and pictures. The page loads "
     "nothing and runs no script. It follows the reader's choice of light or "
     "dark, and can be printed. Rows of several results share a chart if they traced the same rays through the same "
     "scene. Emulated devices and GPUs never share one.\n\n"
     "For a FOLDER, it writes the page of a campaign, from all results (.json) in the folder and its subfolders: an "
     "index of machines and results; machines compared with each other, by the newest rate of each, if they did the "
     "same work; how portable each API's performance is; and each machine's rates by date, with a verdict for the "
     "last change. A file that is not a result is left out, and listed with the reason. Machines are distinguished by "
     "the --label of their runs, or else by their "
     "CPUs; results that record neither are grouped by folder.",
     "  tetrace report bench.json check.json --out report.html\n"
     "  tetrace report results/ --out campaign.html\n"
     "  tetrace report gpu.json cpu.json --image bunny-0-normals.png,bunny-0-steps.png\n"
     "  tetrace report before.json after.json --charts figures\n"},
    {Verb::page, "write a page that traces in a browser, by WebGPU",
     "Writes one HTML file that traces the scenes on any GPU that a browser offers: open it, from a file or from a web "
     "server, and press Start. It compares every ray's answer with openmp's, which this verb has verified, bit for "
     "bit, then measures for ten seconds, draws, and offers the result as JSON, which 'show', 'report' and 'compare' "
     "read. It loads nothing. Each --layout is a "
     "row: half32, tet64, tet80, bvh2, bvh4, cwbvh and the other layouts of tetrace's own. Default: tet64 and bvh2 on "
     "the scene cubes. docs/browser.md has more.",
     "  tetrace page\n"
     "  tetrace page --scene cubes,banana --layout half32,tet64,bvh2,cwbvh --size 256 --out page.html\n"},
    {Verb::merge, "make one result from the shards of a run",
     "Reads the results that 'bench', 'check' or 'reproduce' wrote with --shard, each with its journal (FILE.journal) "
     "next to it, and makes the result of the whole run: the same counts, verdicts and hashes as without shards, and "
     "the same exit code. If a shard is missing or given twice, or if shards differ in commit, scenes, rows or "
     "options, it names them and exits with 2.\n\n"
     "Times are kept per machine: the result lists each machine with its shards and the rates of its rows. A row's "
     "times are combined only if all its shards ran on machines of one kind, with one device and driver; otherwise "
     "the row has counts, and no rate. For 'reproduce', the scenes are loaded again, from the cache or their meshes; "
     "no device is needed. docs/cluster.md has the rest: Slurm, MPI, and how it scales.",
     "  tetrace bench --scene bunny --shard 1/2 --out 1.json     on one machine\n"
     "  tetrace bench --scene bunny --shard 2/2 --out 2.json     on another\n"
     "  tetrace merge 1.json 2.json --out both.json\n"
     "  srun -n 4 tetrace reproduce table4 --scene bunny --out all.json   shards and merges by itself\n"},
    {Verb::help, "describe the program or a verb",
     "Describes the program, or a verb: its usual options, and with 'all', or '--help=all', everything. 'tetrace help "
     "options' prints a Markdown table of all options, 'tetrace help man' a manual page for man, and 'tetrace help "
     "bash', "
     "'zsh' or 'fish' a completion script for that shell.",
     "  tetrace help bench\n"
     "  tetrace help bench all\n"
     "  source <(tetrace help bash)               complete verbs, options and values with the tab key\n"},
};

std::string exit_codes()
{
    std::string text = "Exit codes\n";
    for (const auto& [code, meaning] : exit_code_meanings)
        text += fmt::format("  {}  {}\n", code, meaning);
    return text;
}

/// The terminal's width, if there is one, within limits: long lines are hard to read.
std::size_t page_width()
{
    constexpr std::size_t max_columns = 100, min_columns = 40;
    const std::size_t columns = terminal_columns(STDOUT_FILENO);
    return columns == 0 ? max_columns : std::clamp(columns, min_columns, max_columns);
}

std::string option_entry(const OptionRow& row)
{
    const std::string head = row.value.empty() ? row.name : row.name + " " + row.value;
    return fmt::format("  {}\n{}", head, wrapped_without_orphans(row.help, page_width(), 6));
}

std::string option_entries(Verb verb)
{
    std::string text, group;
    for (const OptionRow& row : option_table()) {
        if (!takes(verb, row)) continue;
        if (row.group != group) text += fmt::format("{}{}\n", text.empty() ? "" : "\n", row.group);
        group = row.group;
        text += option_entry(row);
    }
    return text;
}

std::string verb_text(const VerbHelp& entry)
{
    const std::string_view name = name_of(entry.verb);
    std::string text = fmt::format("tetrace {}: {}\n\n{}\n\n{}\n", name, entry.summary, usage_of(entry.verb),
                                   wrapped_without_orphans(entry.description, page_width(), 0));
    if (const std::string entries = option_entries(entry.verb); !entries.empty()) text += entries + "\n";
    text += fmt::format("Examples\n{}\n", entry.examples);
    return text + exit_codes();
}

std::string program_text()
{
    std::string text =
        wrapped("tetrace: ray traversal through constrained Delaunay tetrahedralizations, measured and verified",
                page_width(), 0) +
        "\nUsage: tetrace VERB [OPTION]...\n\n";
    for (const VerbHelp& entry : verb_help)
        text += fmt::format("  {:<10}{}\n", name_of(entry.verb), entry.summary);
    text += "\n" + wrapped("'tetrace help VERB' or 'tetrace VERB --help' describes a verb in a screen, 'tetrace help "
                           "VERB all' or 'tetrace VERB --help=all' with all its options. "
                           "Results go to standard output, or to --out FILE: either the complete file is written, or "
                           "none, with exit code 2. Messages and progress go to standard error: a line that is "
                           "redrawn, or a line every 30 seconds without a terminal. On a terminal, output has "
                           "colours unless NO_COLOR is set, and tables and sentences fit the width.",
                           page_width(), 0);
    text += "\nExamples\n"
            "  tetrace bench                             measure bunny, armadillo and atrium; Embree as a rival\n"
            "  tetrace check --scene cubes               is every device right on this machine?\n"
            "  tetrace build --scene dragon.ply          your own mesh\n\n";
    return text + exit_codes();
}

std::string verbs_of(const OptionRow& row)
{
    std::string text;
    for (const VerbHelp& entry : verb_help)
        if (takes(entry.verb, row)) append_item(text, ", ", name_of(entry.verb));
    return text;
}

std::string with_bars_escaped(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        if (c == '|') result += '\\';
        result += c;
    }
    return result;
}

std::string options_markdown()
{
    std::string text = "| option | verbs | meaning |\n|---|---|---|\n";
    for (const OptionRow& row : option_table())
        text += fmt::format("| `{}{}{}` | {} | {} |\n", row.name, row.value.empty() ? "" : " ",
                            with_bars_escaped(row.value), verbs_of(row), with_bars_escaped(row.help));
    return text;
}

} // namespace

std::span<const VerbHelp> verb_helps()
{
    return verb_help;
}

std::string help_text(const std::string& topic, bool whole)
{
    if (topic.empty()) return program_text();
    if (topic == "options") return options_markdown();
    if (topic == "man") return man_page();
    if (topic == "bash") return bash_completion();
    if (topic == "zsh") return zsh_completion();
    if (topic == "fish") return fish_completion();
    for (const VerbHelp& entry : verb_help)
        if (name_of(entry.verb) == topic)
            return whole ? verb_text(entry) : first_page(entry, std::min<std::size_t>(page_width(), 80));
    throw Error(ErrorKind::internal, "help_text: no help for '" + topic + "'");
}

std::string version_text()
{
    const BuildIdentity build = build_identity();
    return fmt::format("tetrace {} ({})\n{}, {}\n{}\nApache License 2.0\n", build.version, build.commit, build.compiler,
                       build.flags, build.libraries);
}

} // namespace tetrace
