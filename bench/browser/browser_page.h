#pragma once

#include "bench/browser/answer_hash.h"
#include "core/device/launch.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// A view, as a page traces and judges it.
struct PageView {
    std::uint32_t number = 0; ///< in the camera set
    LaunchParams launch = {};
    std::span<const Quad> given_rays;                  ///< the caller keeps them alive; empty: the image's own
    AnswerHashes answers;                              ///< verified
    std::optional<std::array<std::uint32_t, 2>> tally; ///< hash_of_words() of the sums of task tally
};

/// number: of the view. job: of its rays. given_rays: as a session takes them; none for task trace. hits: its verified
/// answers.
[[nodiscard]] PageView page_view(std::uint32_t number, const TraceJob& job, const PackedScene& packed,
                                 std::span<const Quad> given_rays, std::span<const Hit> hits);

/// A kernel with its packed scene, which the caller keeps alive, and its views.
struct PageKernel {
    std::string name; ///< "cdt project half32"
    KernelId kernel;
    const PackedScene* packed = nullptr;
    std::vector<PageView> views;
};

struct PageScene {
    std::string name;
    std::string trace_command; ///< "tetrace trace ..." of its rays, without view and pixel
    std::uint64_t triangles = 0, tets = 0;
    std::uint32_t width = 0, height = 0;
    std::vector<PageKernel> kernels;
};

/// Whether a page can have the kernel.
[[nodiscard]] bool has_page_kernel(const KernelId& kernel);
/// Throws Error{usage} that lists the layouts of which a page can have a kernel if this is none of them.
void require_page_layout(Layout layout);

/// One HTML file that traces the scenes by WebGPU in any browser, compares every ray's answer with the hashes, and
/// measures. It loads nothing. result: what it saves, with a row for each kernel, scene after scene, as if each were
/// right, and one device; the page fills in the device, how each row ended, and its times. Throws Error{driver} if
/// openmp's self-test cannot be run.
[[nodiscard]] std::string browser_page(const std::vector<PageScene>& scenes, const nlohmann::json& result);

} // namespace tetrace
