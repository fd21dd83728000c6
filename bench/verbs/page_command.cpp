#include "bench/browser/browser_page.h"
#include "bench/browser/met_parts.h"
#include "bench/debugging/dump.h"
#include "bench/measuring/scene_rows.h"
#include "bench/options/browser_api.h"
#include "bench/output/bench_report.h"
#include "bench/rows/row_tracing.h"
#include "bench/rows/sized_scene.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <vector>

namespace tetrace {

namespace {

std::vector<Layout> without_repetitions(const std::vector<Layout>& layouts)
{
    std::vector<Layout> all;
    for (const Layout layout : layouts)
        if (std::ranges::find(all, layout) == all.end()) all.push_back(layout);
    return all;
}

/// openmp's rows of each layout, by the method that has rows by default: their answers are those that the page compares
/// with. Throws Error{usage} if a page has no kernel of a row.
std::vector<RowKey> page_rows(const Options& options)
{
    std::vector<RowKey> rows;
    for (const std::string& label : scene_labels(options))
        for (const Layout layout : without_repetitions(options.layouts)) {
            require_page_layout(layout);
            Options wanted = options;
            wanted.layouts = {layout};
            wanted.methods = {one_kernel(wanted).method};
            wanted.schedules = {Schedule::tiles};
            wanted.backends = {reference_backend().name()};
            for (RowKey& row : select_rows(wanted, {label})) {
                if (!has_page_kernel(row.kernel))
                    throw Error(ErrorKind::usage, fmt::format("page: this build has no WGSL of {}", row_name(row)));
                rows.push_back(std::move(row));
            }
        }
    return rows;
}

/// As kernels have sums: the lower word first.
std::vector<std::uint32_t> words_of(const std::vector<std::uint64_t>& sums)
{
    std::vector<std::uint32_t> words;
    for (const std::uint64_t sum : sums) {
        words.push_back(static_cast<std::uint32_t>(sum));
        words.push_back(static_cast<std::uint32_t>(sum >> 32));
    }
    return words;
}

/// The scenes with their kernels, as the rows are verified one after the other. Refers to the rows' packed scenes.
class PageMaker {
public:
    void see(const SeenImage& image)
    {
        const RowRun& row = image.row;
        const bool is_given = traits_of(row.key.kernel.task).takes_rays;
        const std::span<const Quad> given = is_given ? std::span<const Quad>(row.scene->given_rays().rows(
                                                           *row.scene, row.key, &row.packed->data, image.view))
                                                     : std::span<const Quad>();
        if (image.hits.empty()) return; // given rays, of which this view has none
        PageView& view = views_[row_name(row.key)].emplace_back(page_view(
            row.scene->view_numbers()[image.view], job_of(row, image.view), row.packed->data, given, image.hits));
        if (traits_of(row.key.kernel.task).tallies) view.tally = hash_of_words(words_of(row.session->tally()));
    }

    PageKernel kernel_of(RowRun& row)
    {
        if (views_[row_name(row.key)].empty())
            throw Error(ErrorKind::usage,
                        fmt::format("page: {}: no view has such rays; take other views (--views)", row_name(row.key)));
        packed_.push_back(std::make_unique<PackedScene>(with_met_parts_only(row)));
        return {kernel_title(row.key), row.key.kernel, packed_.back().get(), std::move(views_[row_name(row.key)])};
    }

private:
    std::map<std::string, std::vector<PageView>> views_; ///< by the row's name
    std::vector<std::unique_ptr<PackedScene>> packed_;
};

/// Throws Error{wrong_result} if an answer is not right: the page takes them for right.
void require_right(const std::vector<RowRun>& rows)
{
    for (const RowRun& row : rows)
        if (status_of(row) != Status::ok)
            throw Error(row.session == nullptr ? ErrorKind::missing : ErrorKind::wrong_result,
                        fmt::format("page: {} is {}, and a page judges by these answers: {}", row_name(row.key),
                                    name_of(status_of(row)), reason_of(row)));
}

PageScene page_scene(const SceneWork& scene)
{
    return {scene.label(),
            "tetrace trace " + scene.arguments(),
            scene.loaded().scene.mesh.triangles.size(),
            scene.counts().tets,
            scene.width(),
            scene.height(),
            {}};
}

/// What the page's device would be if it did all right; the page fills in the rest.
RowDevice page_device()
{
    RowDevice device;
    device.backend = browser_api;
    device.device.name = "not known";
    device.device.kind = DeviceKind::gpu;
    device.self_tests[MathMode::exact] = {};
    return device;
}

/// openmp's verified row as the page's, without times.
RowRecord page_record(const RowRun& row, const RowDevice& device)
{
    RowRecord record = record_of(row);
    record.key.backend = browser_api;
    record.device = device.device;
    record.self_test = device.self_tests.at(MathMode::exact);
    record.clock = "not known";
    record.setup.compile_s = record.setup.upload_s = 0;
    record.setup.compile_cached = false;
    auto& traced = std::get<Traced>(record.outcome);
    traced.compared = true;
    traced.kernel_s = traced.wall_s = traced.download_s = 0;
    return record;
}

/// What the page saves, a result of `bench`.
nlohmann::json page_result(const SceneRows& run, const Options& options)
{
    BenchResult result;
    result.devices = {page_device()};
    for (const RowRun& row : run.rows)
        result.rows.push_back(page_record(row, result.devices.front()));
    result.scenes = scene_records(run, options);
    result.comparisons.resize(result.rows.size());
    result.best_bvhs.resize(result.rows.size());
    Options as_bench = options;
    as_bench.verb = Verb::bench;
    nlohmann::json head = result_head(as_bench);
    head.erase("conditions"); // of this machine
    head["host"] = {{"cpu", "a browser's machine"}, {"system", "a browser"}, {"threads", 1}};
    return bench_report(result, as_bench, std::move(head)).json;
}

} // namespace

int page_command(const Options& options)
{
    const std::filesystem::path path = options.out.value_or("tetrace.html");
    if (path != "-") check_writable("--out", path);
    Options wanted = options;
    if (wanted.scenes.empty()) wanted.scenes = {"cubes"};
    if (wanted.layouts.empty()) wanted.layouts = {Layout::tet64, Layout::bvh2};
    PageMaker maker;
    SceneRows run = open_and_verify(page_rows(wanted), wanted, [&](const SeenImage& image) { maker.see(image); });
    require_right(run.rows);
    std::vector<PageScene> pages;
    for (const auto& scene : run.scenes) {
        pages.push_back(page_scene(*scene));
        for (RowRun& row : run.rows)
            if (row.key.scene == scene->label()) pages.back().kernels.push_back(maker.kernel_of(row));
    }
    const std::string page = browser_page(pages, page_result(run, wanted));
    if (path == "-") {
        print(page);
        return 0;
    }
    write_whole(path, page);
    say(fmt::format("{}: {}; open it in a browser with WebGPU and press Start", path.string(), size_text(page.size())));
    return 0;
}

} // namespace tetrace
