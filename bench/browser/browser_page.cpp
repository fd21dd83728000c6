#include "bench/browser/browser_page.h"

#include "backends/webgpu/kernels.h"
#include "bench/options/identity.h"
#include "bench/report/html/html.h"
#include "bench/report/png.h"
#include "core/base/error.h"
#include "core/device/scene_buffers.h"
#include "core/device/self_test.h"
#include "kernels/layouts/probe_chains.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <span>
#include <string_view>

namespace tetrace {

namespace {

using nlohmann::json;

/// Tiles of a page's launches: TILE_WIDTH wide, and this high.
constexpr unsigned page_tile_height = 8;

template <class Range>
std::string packed_text(const Range& values)
{
    const auto bytes = std::as_bytes(std::span(values));
    return base64(deflated({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

/// By the numbers of the operations: a name, and what a wrong result makes of the result's `self_test`.
json operations_json()
{
    const auto named = [](const char* name, const char* finding, bool value) {
        return json{{"name", name}, {"finding", finding}, {"value", value}};
    };
    return {named("copy", "bits_kept", false),
            named("multiply-add", "contracts", true),
            {{"name", "division"}, {"finding", "division_ulps"}}, // how many units
            named("sum", "sums_right", false),
            named("product", "sums_right", false),
            {{"name", "square root"}},
            named("conversion", "conversions_right", false),
            named("comparison", "comparisons_right", false),
            named("integers", "integers_right", false),
            named("split", "reassociates", true),
            named("cancelled", "reassociates", true),
            named("scaled", "reassociates", true)};
}

/// Where divided() of prelude.wgsl rounds correctly on every device; elsewhere WGSL allows an error.
bool is_divided_exactly(const Quad& operation)
{
    const float a = std::bit_cast<float>(operation.y), b = std::bit_cast<float>(operation.z);
    const auto is_in_range = [](float x) { return std::abs(x) > 0x1p-60f && std::abs(x) < 0x1p64f; };
    return is_in_range(b) && is_in_range(a / b) && is_in_range(a);
}

/// The operations that kernels need exact: no square roots, which they do not take.
std::vector<Quad> page_operations()
{
    std::vector<Quad> operations = self_test_operations();
    std::erase_if(operations, [](const Quad& operation) {
        return operation.x == PROBE_SQUARE_ROOT || (operation.x == PROBE_DIVIDE && !is_divided_exactly(operation));
    });
    return operations;
}

json probe_json()
{
    const std::vector<Quad> operations = page_operations();
    const auto words = reference_backend().probe(0, MathMode::exact, operations);
    return {{"wgsl", webgpu::probe_text()},
            {"operations", packed_text(operations)},
            {"words", packed_text(words)},
            {"names", operations_json()},
            {"may_flush",
             {PROBE_MULTIPLY_ADD, PROBE_DIVIDE, PROBE_ADD, PROBE_MULTIPLY, PROBE_COMPARE, PROBE_SPLIT, PROBE_CANCEL,
              PROBE_SCALE}}};
}

/// Compressed arrays, each once, however many kernels and views have it.
class ArrayStore {
public:
    /// Its number.
    template <class Range>
    std::size_t add(const Range& values)
    {
        std::string text = packed_text(values);
        const auto [place, is_new] = numbers_.try_emplace(text, texts_.size());
        if (is_new) texts_.push_back(std::move(text));
        return place->second;
    }
    [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

private:
    std::map<std::string, std::size_t> numbers_;
    std::vector<std::string> texts_;
};

/// The arrays that the kernel's text reads: a device accepts no others with bindings that follow from the text.
json arrays_json(const PageKernel& kernel, ArrayStore& store)
{
    json arrays = json::array();
    const auto buffers = scene_buffers(*kernel.packed);
    const std::string text(webgpu::kernel_text(kernel.kernel));
    for (std::uint32_t binding = 0; binding < buffers.size(); ++binding) {
        const auto is_read = [&](const SceneArray& array) {
            return array.binding == binding && text.find(std::string(array.name) + "[") != std::string::npos;
        };
        if (std::ranges::any_of(scene_arrays(kernel.packed->layout), is_read))
            arrays.push_back({{"binding", binding}, {"array", store.add(buffers[binding].bytes)}});
    }
    return arrays;
}

json view_json(const PageView& view, ArrayStore& store)
{
    json object = {{"number", view.number},
                   {"launch", packed_text(std::span(&view.launch, 1))},
                   {"rays", view.answers.rays.size()},
                   {"tiles", tile_count(view.launch)},
                   {"hash", view.answers.view},
                   {"ray_hashes", store.add(view.answers.rays)}};
    if (view.tally) object["tally"] = *view.tally;
    if (!view.given_rays.empty()) object["given_rays"] = store.add(view.given_rays);
    return object;
}

json scene_json(const PageScene& scene, ArrayStore& store)
{
    json kernels = json::array();
    for (const PageKernel& kernel : scene.kernels) {
        json views = json::array();
        for (const PageView& view : kernel.views)
            views.push_back(view_json(view, store));
        kernels.push_back({{"name", kernel.name},
                           {"answer", traits_of(kernel.kernel.task).finds_hits
                                          ? "triangle, tet, t, u, v, steps"
                                          : "first tet, last tet, total, hash, reversed, crossings"},
                           {"wgsl", webgpu::kernel_text(kernel.kernel)},
                           {"tets", kernel.packed->tet_count},
                           {"arrays", arrays_json(kernel, store)},
                           {"views", views}});
    }
    return {{"name", scene.name},
            {"trace_command", scene.trace_command},
            {"triangles", scene.triangles},
            {"tets", scene.tets},
            {"width", scene.width},
            {"height", scene.height},
            {"kernels", kernels}};
}

/// JSON as the content of a script element: "<" is only in its strings.
std::string script_text(const json& data)
{
    std::string text;
    for (const char c : data.dump())
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    return text;
}

/// Replaces the first `place` of the page, which has one.
void put(std::string& page, std::string_view place, std::string_view text)
{
    page.replace(page.find(place), place.size(), text);
}

} // namespace

PageView page_view(std::uint32_t number, const TraceJob& job, const PackedScene& packed,
                   std::span<const Quad> given_rays, std::span<const Hit> hits)
{
    return {number, launch_params(job, domain_of(packed), page_tile_height, TetParts{}.log2_bytes), given_rays,
            answer_hashes(hits), std::nullopt};
}

bool has_page_kernel(const KernelId& kernel)
{
    return !webgpu::kernel_text(kernel).empty();
}

void require_page_layout(Layout layout)
{
    std::vector<std::string_view> accepted;
    for (const KernelId& kernel : all_kernels())
        if (has_page_kernel(kernel) && std::ranges::find(accepted, name_of(kernel.layout)) == accepted.end())
            accepted.push_back(name_of(kernel.layout));
    if (std::ranges::find(accepted, name_of(layout)) == accepted.end())
        throw Error(ErrorKind::usage, fmt::format("--layout {}: a page has kernels of tetrace's own only: {}",
                                                  name_of(layout), fmt::join(accepted, ", ")));
}

std::string browser_page(const std::vector<PageScene>& scenes, const json& result)
{
    ArrayStore store;
    json data = {{"version", build_identity().version},
                 {"commit", build_identity().commit},
                 {"guard_words", GUARD_WORDS},
                 {"hit_words", HIT_WORDS},
                 {"poison", POISON},
                 {"tile_height", page_tile_height},
                 {"first_tile_word", offsetof(LaunchParams, first_tile) / sizeof(std::uint32_t)},
                 {"launch_words", sizeof(LaunchParams) / sizeof(std::uint32_t) + 1},
                 {"launch_binding", webgpu::launch_binding},
                 {"output_binding", OUTPUT_BINDING},
                 {"rays_binding", RAYS_BINDING},
                 {"sums_binding", webgpu::sums_binding},
                 {"probe", probe_json()},
                 {"result", result},
                 {"scenes", json::array()}};
    for (const PageScene& scene : scenes)
        data["scenes"].push_back(scene_json(scene, store));
    data["arrays"] = store.texts();
    std::string page(webgpu::page_text());
    put(page, "@SCRIPT@", webgpu::page_script());
    put(page, "@DATA@", script_text(data)); // last: it may have any text
    return page;
}

} // namespace tetrace
