#include "backends/openmp/packet_session.h"

#include "core/elapsed.h"
#include "core/error.h"

#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace tetrace::openmp {
namespace {

namespace scalar {
#define KERNEL_STRUCTURE_HEADER "kernels/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/cdt_arrays.h"
#define KERNEL_METHOD_HEADER "kernels/project.h"
#define KERNEL_LAYOUT_HEADER "kernels/half32.h"
#include "kernels/kernel_cpp.h"
} // namespace scalar

constexpr std::size_t huge_page = std::size_t{2} << 20;

// What the scalar kernel needs for a pixel that packets leave to it.
struct Pixels {
    scalar::SceneView scene;
    scalar::TraceParams params;
    Hit* hits;
};

void trace_pixel(const void* context, std::uint32_t x, std::uint32_t y)
{
    const Pixels& image = *static_cast<const Pixels*>(context);
    image.hits[std::size_t{y} * image.params.width + x] =
        std::bit_cast<Hit>(scalar::trace(image.scene, image.params, scalar::primary_ray(image.params, x, y)));
}

std::vector<PacketKernel> kernels_of_host()
{
    std::vector<PacketKernel> kernels;
#ifdef TETRACE_WIDE_PACKETS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        kernels.push_back({16, tetrace_trace_block_16});
    if (__builtin_cpu_supports("avx2")) kernels.push_back({8, tetrace_trace_block_8});
#endif
    kernels.push_back({4, tetrace_trace_block_4});
    return kernels;
}

std::uint32_t* copy_of(const std::vector<Row>& rows)
{
    const std::size_t bytes = rows.size() * sizeof(Row);
    const std::size_t whole_pages = std::max(huge_page, (bytes + huge_page - 1) / huge_page * huge_page);
    void* const block = std::aligned_alloc(huge_page, whole_pages);
    if (block == nullptr)
        throw Error(ErrorKind::unsupported,
                    "packets need a copy of the records: " + std::to_string(whole_pages) + " bytes are not to be had");
#ifdef MADV_HUGEPAGE
    madvise(block, whole_pages, MADV_HUGEPAGE); // a wish: without it walks are slower
#endif
    std::memcpy(block, rows.data(), bytes);
    return static_cast<std::uint32_t*>(block);
}

void copy3(Float3 from, float* to)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

PacketJob packet_job(const PackedScene& scene, const std::uint32_t* records, const TraceJob& job, const Pixels& pixels)
{
    PacketJob result{};
    result.records = records;
    result.triangles = reinterpret_cast<const std::uint32_t*>(scene.triangles.data());
    result.lines = reinterpret_cast<const float*>(scene.lines.data());
    result.entry_ranges = scene.entry_ranges.data();
    result.entry_links = scene.entry_links.data();
    result.divisions = scene.divisions;
    copy3(job.view.origin, result.origin);
    copy3(job.view.corner, result.corner);
    copy3(job.view.step_x, result.step_x);
    copy3(job.view.step_y, result.step_y);
    result.width = job.width;
    result.height = job.height;
    result.start_tet = job.start_tet;
    result.max_steps = job.max_steps;
    result.hits = reinterpret_cast<std::uint32_t*>(pixels.hits);
    result.trace_one = trace_pixel;
    result.context = &pixels;
    return result;
}

} // namespace

const std::vector<PacketKernel>& packet_kernels()
{
    static const std::vector<PacketKernel> kernels = kernels_of_host();
    return kernels;
}

PacketSession::PacketSession(PacketKernel kernel, const PackedScene& scene, unsigned threads)
    : HostSession(Task::trace), kernel_(kernel), scene_(scene), threads_(threads)
{
    const auto start = std::chrono::steady_clock::now();
    records_.reset(copy_of(scene.tets));
    copy_s_ = seconds_since(start);
}

void PacketSession::Free::operator()(void* block) const
{
    std::free(block);
}

SetupTimes PacketSession::setup_times() const
{
    SetupTimes times;
    times.upload_s = copy_s_;
    return times;
}

void PacketSession::run(const TraceJob& job, std::span<std::uint32_t> output)
{
    const Pixels pixels{scalar::view_of(scene_), scalar::params_of(job), as_hits(output).data()};
    const PacketJob packets = packet_job(scene_, records_.get(), job, pixels);
    const std::uint32_t across = (job.width + packet_block_size - 1) / packet_block_size;
    const std::uint32_t blocks = across * ((job.height + packet_block_size - 1) / packet_block_size);
#pragma omp parallel num_threads(static_cast <int>(threads_))
    {
        std::fenv_t environment;
        std::fegetenv(&environment);
        std::fesetenv(FE_DFL_ENV); // as kernel.cpp
#pragma omp for schedule(dynamic, 1)
        for (std::uint32_t block = 0; block < blocks; block++)
            kernel_.trace(packets, block % across * packet_block_size, block / across * packet_block_size);
        std::fesetenv(&environment);
    }
}

} // namespace tetrace::openmp
