#include "bench/debugging/case_files.h"

#include "bench/debugging/dump.h"
#include "bench/debugging/trace_run.h"
#include "bench/inspection/work_folder.h"
#include "bench/options/browser_api.h"
#include "bench/options/identity.h"
#include "bench/rows/ray_store.h"
#include "bench/rows/row_tracing.h"
#include "bench/rows/rows.h"
#include "bench/variants/variant_program.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"
#include "core/device/defects.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"
#include "core/device/session.h"
#include "core/isolation/isolation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

namespace tetrace {

namespace {

using CaseWords = std::vector<std::uint32_t>;

/// What a program should write: its whole output, and how far each word may be off.
struct CaseOutput {
    CaseWords expected, tolerances;
    std::uint32_t before = POISON; ///< in each word before the launch
};

KernelFile words_file(const char* name, const char* what, const CaseWords& words)
{
    return {name, what, {}, std::string(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0]))};
}

DumpedCase files_of_case(const LaunchCase& launch, const CaseOutput& output, const std::string& title)
{
    const BuildIdentity build = build_identity();
    std::string macros = fmt::format("// {}, written by tetrace {} ({}).\n#define PROGRAM \"{}\"\n",
                                     printable_line(title), build.version, build.commit, launch.program.name);
    for (const std::string& line : launch.lines)
        macros += "#define " + line + "\n";
    macros += "#define INPUTS";
    DumpedCase made{title, {{"case.h", "the launch, as macros", {}, {}}, launch.host}};
    made.files.push_back(launch.program);
    for (const LaunchCase::Input& input : launch.inputs) {
        macros += fmt::format(" \\\n    {{{}, \"{}\"}},", input.place, input.file.name);
        if (std::ranges::find(made.files, input.file.name, &KernelFile::name) == made.files.end())
            made.files.push_back(input.file);
    }
    macros += fmt::format("\n#define OUTPUT {}\n#define OUTPUT_WORDS {}\n#define OUTPUT_BEFORE {:#x}u\n", launch.output,
                          output.expected.size(), output.before);
    made.files.push_back(words_file("expected.bin", "the whole output after the launch, in words", output.expected));
    made.files.push_back(words_file("tolerance.bin",
                                    "how far each word may be off: t, u and v of a hit by 3 units in the last place, "
                                    "as division may be; all else by none",
                                    output.tolerances));
    made.files.front().bytes = std::move(macros);
    return made;
}

[[noreturn]] void refuse_case(const Backend& backend)
{
    std::vector<std::string> others;
    for (const Backend* other : direct_backends())
        if (has_case_host(*other)) others.push_back(other->name());
    throw Error(ErrorKind::usage,
                fmt::format("dump: {} has no host that runs a case without tetrace; backends that have one: {}",
                            backend.name(), fmt::join(others, ", ")));
}

DumpedCase defect_case(const Backend& backend, std::string_view name)
{
    const ChosenDefect chosen = chosen_defect(name).value();
    const Defect& defect = *chosen.defect;
    const auto launch = backend.defect_case(defect.name, chosen.launch);
    if (!launch) refuse_case(backend);
    CaseOutput output;
    output.expected = expected_words(defect, chosen.launch);
    output.tolerances.assign(output.expected.size(), 0);
    output.before = 0;
    return files_of_case(*launch, output,
                         fmt::format("{} on {}: {}; {} {}", name, backend.name(), defect.what,
                                     defect.is_stressor ? "reports of the kind:" : "known in", defect.known));
}

/// The device for which a case is written.
Device case_target(const Options& options, const Backend& backend)
{
    Device gpu;
    gpu.kind = DeviceKind::gpu;
    if (options.devices.empty()) return gpu;
    for (std::size_t i = 0; i < backend.devices().size(); ++i)
        if (backend.devices()[i].usable && wanted_device(options, backend, i)) return backend.devices()[i];
    throw Error(ErrorKind::missing, fmt::format("--device: no usable device of {} matches", backend.name()));
}

/// The row of openmp that the expected output is from.
RowKey expecting_row(const Options& options)
{
    Options reference = options;
    reference.backends = {reference_backend().name()};
    reference.devices.clear();
    return rows_of_ray(reference).front();
}

/// Pixels of the tile that are in the image.
std::vector<std::size_t> rays_of_tile(const LaunchParams& launch)
{
    const std::uint32_t columns = (launch.width + TILE_WIDTH - 1) / TILE_WIDTH;
    const std::uint32_t left = launch.first_tile % columns * TILE_WIDTH;
    const std::uint32_t top = launch.first_tile / columns * launch.tile_height;
    std::vector<std::size_t> rays;
    for (std::uint32_t y = top; y < std::min(top + launch.tile_height, launch.height); ++y)
        for (std::uint32_t x = left; x < std::min(left + TILE_WIDTH, launch.width); ++x)
            rays.push_back(std::size_t{y} * launch.width + x);
    return rays;
}

/// The sums per tet of these of the row's given rays alone, which its session has afterwards; empty if its task has
/// none.
std::vector<std::uint64_t> tally_of(RowRun& row, const std::vector<Quad>& quads, const std::vector<std::size_t>& rays)
{
    if (!traits_of(row.key.kernel.task).tallies) return {};
    std::vector<Quad> some;
    for (std::size_t list = 0; list < GIVEN_RAY_QUADS; ++list) // all directions, then all origins
        for (const std::size_t ray : rays)
            some.push_back(quads[list * (quads.size() / GIVEN_RAY_QUADS) + ray]);
    row.session->set_rays(some);
    std::vector<Hit> answers(rays.size());
    const TraceJob job = job_of(row, 0);
    static_cast<void>(row.session->trace(given_job(rays.size(), job.max_steps, job.any_hit), answers));
    return row.session->tally();
}

/// hits: answers of all rays. tally: of the tile.
CaseOutput output_of_tile(const LaunchParams& launch, const KernelId& kernel, const std::vector<Hit>& hits,
                          const std::vector<std::uint64_t>& tally)
{
    constexpr std::uint32_t division_ulps = 3; // SelfTest::allowed_ulps()
    const std::array<std::size_t, 1> rays = {hits.size()};
    const OutputParts parts(rays, HIT_WORDS, 2 * tally.size());
    CaseOutput output{CaseWords(parts.words(), POISON), CaseWords(parts.words(), 0), POISON};
    const auto sums = parts.tally(std::span(output.expected), 0);
    for (std::size_t tet = 0; tet < tally.size(); ++tet) { // a kernel adds to what is there
        const std::uint64_t sum = (std::uint64_t{POISON} << 32 | POISON) + tally[tet];
        sums[2 * tet] = static_cast<std::uint32_t>(sum);
        sums[2 * tet + 1] = static_cast<std::uint32_t>(sum >> 32);
    }
    for (const std::size_t ray : rays_of_tile(launch)) {
        const std::size_t word = GUARD_WORDS + HIT_WORDS * ray;
        std::memcpy(&output.expected[word], &hits[ray], sizeof(Hit));
        if (!traits_of(kernel.task).finds_hits) continue; // integers
        for (const std::size_t member : {offsetof(Hit, t), offsetof(Hit, u), offsetof(Hit, v)})
            output.tolerances[word + member / sizeof(std::uint32_t)] = division_ulps;
    }
    return output;
}

std::vector<Quad> quads_of_case(SceneWork& scene, const RowRun& row)
{
    if (!traits_of(row.key.kernel.task).takes_rays) return {};
    return scene.given_rays().rows(scene, row.key, &row.packed->data, 0);
}

std::string title_of_tile(const SceneWork& scene, const RowKey& key, const Backend& backend, const Options& options)
{
    std::string title =
        fmt::format("{} on {}: the work-group of pixel {},{} of {} x {}, view {} of {}, scene {}", name_of(key.kernel),
                    backend.name(), options.pixel->x, options.pixel->y, scene.width(), scene.height(),
                    scene.view_numbers().front(), camera_set_name(options), scene.label());
    if (key.rays != RayKind::primary) title += fmt::format(", {} rays", name_of(key.rays));
    return title;
}

/// The program of the variant of --variant, which has the kernel's answers; empty: none is asked for.
std::filesystem::path variant_file(const Options& options, const std::string& backend, const KernelId& kernel,
                                   const WorkFolder& folder)
{
    if (options.changes.empty()) return {};
    const VariantProgram variant(backend, kernel);
    return variant.write(variant.text().with(variant.text().named(options.changes)), folder.path());
}

DumpedCase tile_case(const Options& options, const Backend& backend)
{
    if (one_kernel(options).math != MathMode::exact)
        throw Error(ErrorKind::usage, "dump: a case is of math mode exact: in fast, every driver may have other hits");
    const RowKey key = expecting_row(options);
    if (!has_case_host(backend)) refuse_case(backend);
    const Device target = case_target(options, backend);
    SceneWork scene = load_work(scene_requests(options).front(), options);
    RowRun row = open_row(key, scene, options);
    if (row.session == nullptr) throw Error(ErrorKind::unsupported, fmt::format("dump: openmp: {}", reason_of(row)));
    const auto number = static_cast<std::uint32_t>(number_of_ray(scene, key, 0, *options.pixel));
    TraceJob job = prepare_view(row, 0);
    if (target.max_steps != 0) job.max_steps = std::min(job.max_steps, target.max_steps);
    std::vector<Hit> hits(ray_count(row, 0));
    static_cast<void>(row.session->trace(job, hits));
    const PackedScene& packed = row.packed->data;
    LaunchParams launch =
        launch_params(job, domain_of(packed), tile_height_of(session_options(options)), TetParts{}.log2_bytes);
    const std::uint32_t columns = (job.width + TILE_WIDTH - 1) / TILE_WIDTH;
    launch.first_tile = number / job.width / launch.tile_height * columns + number % job.width / TILE_WIDTH;
    const WorkFolder folder;
    const std::vector<Quad> quads = quads_of_case(scene, row);
    auto made = backend.tile_case(target, key.kernel, packed, launch, quads,
                                  variant_file(options, backend.name(), key.kernel, folder));
    if (!made) refuse_case(backend);
    if (!options.changes.empty())
        made->program.what += fmt::format(", with the changes {}", fmt::join(options.changes, ", "));
    const auto tally = tally_of(row, quads, rays_of_tile(launch));
    return files_of_case(*made, output_of_tile(launch, key.kernel, hits, tally),
                         title_of_tile(scene, key, backend, options));
}

} // namespace

DumpedCase dumped_case(const Options& options, const std::vector<Backend*>& backends)
{
    if (options.backends.front() == browser_api)
        throw Error(ErrorKind::usage, fmt::format("dump: a case of {} is a page, which 'tetrace page' writes; without "
                                                  "--scene and --defect, dump writes its kernels",
                                                  browser_api));
    const Backend& backend = backend_named(options.backends.front(), backends);
    return options.defect.empty() ? tile_case(options, backend) : defect_case(backend, options.defect);
}

} // namespace tetrace
