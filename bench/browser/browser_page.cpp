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
#include <nlohmann/json.hpp>
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

/// By the numbers of the operations.
const std::vector<std::string>& operation_names()
{
    static const std::vector<std::string> names = {"copy",     "multiply-add", "division",   "sum",
                                                   "product",  "square root",  "conversion", "comparison",
                                                   "integers", "split",        "cancelled",  "scaled"};
    return names;
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
            {"names", operation_names()},
            {"may_flush",
             {PROBE_MULTIPLY_ADD, PROBE_DIVIDE, PROBE_ADD, PROBE_MULTIPLY, PROBE_COMPARE, PROBE_SPLIT, PROBE_CANCEL,
              PROBE_SCALE}}};
}

/// The arrays that the kernel's text reads: a device accepts no others with bindings that follow from the text.
json arrays_json(const PageKernel& kernel)
{
    json arrays = json::array();
    const auto buffers = scene_buffers(*kernel.packed);
    const std::string text(webgpu::kernel_text(kernel.kernel));
    for (std::uint32_t binding = 0; binding < buffers.size(); ++binding) {
        const auto is_read = [&](const SceneArray& array) {
            return array.binding == binding && text.find(std::string(array.name) + "[") != std::string::npos;
        };
        if (std::ranges::any_of(scene_arrays(kernel.packed->layout), is_read))
            arrays.push_back({{"binding", binding}, {"bytes", packed_text(buffers[binding].bytes)}});
    }
    return arrays;
}

json view_json(const PageView& view)
{
    return {{"number", view.number},
            {"launch", packed_text(std::span(&view.launch, 1))},
            {"hash", view.answers.view},
            {"ray_hashes", packed_text(view.answers.rays)}};
}

json scene_json(const PageScene& scene)
{
    json kernels = json::array();
    for (const PageKernel& kernel : scene.kernels) {
        json views = json::array();
        for (const PageView& view : kernel.views)
            views.push_back(view_json(view));
        kernels.push_back({{"name", kernel.name},
                           {"wgsl", webgpu::kernel_text(kernel.kernel)},
                           {"arrays", arrays_json(kernel)},
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

PageView page_view(std::uint32_t number, const TraceJob& job, const PackedScene& packed, std::span<const Hit> hits)
{
    return {number, launch_params(job, domain_of(packed), page_tile_height, TetParts{}.log2_bytes),
            answer_hashes(hits)};
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

std::string browser_page(const std::vector<PageScene>& scenes)
{
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
                 {"probe", probe_json()},
                 {"scenes", json::array()}};
    for (const PageScene& scene : scenes)
        data["scenes"].push_back(scene_json(scene));
    std::string page(webgpu::page_text());
    put(page, "@SCRIPT@", webgpu::page_script());
    put(page, "@DATA@", script_text(data)); // last: it may have any text
    return page;
}

} // namespace tetrace
