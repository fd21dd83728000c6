#include "bench/browser/browser_page.h"
#include "bench/debugging/dump.h"
#include "bench/measuring/verify.h"
#include "bench/rows/rows.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <vector>

namespace tetrace {

namespace {

/// openmp's row of each layout, by the method that has rows by default: its answers are those that the page compares
/// with.
std::vector<RowKey> page_rows(const Options& options, const std::string& label)
{
    std::vector<RowKey> rows;
    for (const Layout layout : options.layouts.empty() ? std::vector{Layout::tet64, Layout::bvh2} : options.layouts) {
        require_page_layout(layout);
        Options wanted = options;
        wanted.layouts = {layout};
        wanted.methods = {one_kernel(wanted).method};
        wanted.schedules = {Schedule::tiles};
        wanted.backends = {reference_backend().name()};
        rows.push_back(select_rows(wanted, {label}).front());
    }
    return rows;
}

/// Throws Error{wrong_result} if an answer is not right: the page takes them for right.
PageView verified_view(Verifier& verifier, RowRun& row, std::size_t view)
{
    const ImageVerdict verdict = verifier.verify(row, view);
    if (!verdict.verdicts.clean())
        throw Error(ErrorKind::wrong_result,
                    fmt::format("page: {}, view {}: {} rays are wrong and {} lost, so a page cannot judge by them; "
                                "leave out this --layout",
                                row_name(row.key), row.scene->view_numbers()[view], verdict.verdicts.wrong,
                                verdict.verdicts.lost));
    const PackedScene& packed = row.packed->data;
    return page_view(row.scene->view_numbers()[view], row.scene->job(view, &packed, row.device), packed,
                     verifier.hits());
}

PageKernel page_kernel(Verifier& verifier, const RowKey& key, SceneWork& scene, const Options& options)
{
    RowRun row = open_row(key, scene, options);
    if (row.session == nullptr)
        throw Error(ErrorKind::missing, fmt::format("page: {}: {}", row_name(key), reason_of(row)));
    PageKernel kernel = {kernel_title(key), key.kernel, &row.packed->data, {}};
    for (std::size_t view = 0; view < scene.views().size(); ++view) {
        progress_line().show(fmt::format("tracing and verifying {} on {}", kernel.name, scene.label()),
                             static_cast<double>(view) / static_cast<double>(scene.views().size()));
        kernel.views.push_back(verified_view(verifier, row, view));
    }
    return kernel;
}

PageScene page_scene(SceneWork& scene, const Options& options)
{
    Verifier verifier(scene, options);
    PageScene page = {scene.label(),
                      "tetrace trace " + scene.arguments(),
                      scene.loaded().scene.mesh.triangles.size(),
                      scene.counts().tets,
                      scene.width(),
                      scene.height(),
                      {}};
    for (const RowKey& key : page_rows(options, scene.label()))
        page.kernels.push_back(page_kernel(verifier, key, scene, options));
    return page;
}

} // namespace

int page_command(const Options& options)
{
    const std::filesystem::path path = options.out.value_or("tetrace.html");
    Options with_scene = options;
    if (with_scene.scenes.empty()) with_scene.scenes = {"cubes"};
    std::vector<std::unique_ptr<SceneWork>> scenes; // pages refer to their packed forms
    std::vector<PageScene> pages;
    for (const SceneRequest& request : scene_requests(with_scene)) {
        scenes.push_back(std::make_unique<SceneWork>(load_work(request, with_scene)));
        pages.push_back(page_scene(*scenes.back(), with_scene));
    }
    const std::string page = browser_page(pages);
    if (path == "-") {
        print(page);
        return 0;
    }
    write_whole(path, page);
    say(fmt::format("{}: {}; open it in a browser with WebGPU and press Start", path.string(), size_text(page.size())));
    return 0;
}

} // namespace tetrace
