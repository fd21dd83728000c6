#include "backends/openmp/packet_session.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace tetrace::openmp {

namespace {

#ifdef __SSE2__
constexpr std::size_t line_bytes = 64;

void store_line(const std::byte* from, std::byte* to)
{
    for (std::size_t i = 0; i < line_bytes; i += sizeof(__m128i))
        _mm_stream_si128(reinterpret_cast<__m128i*>(to + i),
                         _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i)));
}

// Whole lines go past the caches, the parts of a line at both ends do not: past the caches each would be a write of its
// own.
void store_row(std::span<const Hit> row, Hit* to)
{
    const std::byte* from = std::as_bytes(row).data();
    const std::byte* const end = from + row.size_bytes();
    auto* at = reinterpret_cast<std::byte*>(to);
    const std::size_t before = (line_bytes - reinterpret_cast<std::uintptr_t>(at) % line_bytes) % line_bytes;
    const std::byte* const first_line = from + std::min(before, row.size_bytes());
    at = std::copy(from, first_line, at);
    for (from = first_line; end - from >= static_cast<std::ptrdiff_t>(line_bytes); from += line_bytes, at += line_bytes)
        store_line(from, at);
    std::copy(from, end, at);
}
#else
void store_row(std::span<const Hit> row, Hit* to)
{
    std::ranges::copy(row, to);
}
#endif

} // namespace

HitTile::HitTile(std::span<Hit> image, std::uint32_t width, std::uint32_t height)
    : image_(image), width_(width), height_(height)
{
    assert(image.size() == std::size_t{width} * height);
}

HitTile::~HitTile()
{
#ifdef __SSE2__
    _mm_sfence();
#endif
}

void HitTile::store(std::uint32_t x, std::uint32_t y) const
{
    const std::uint32_t columns = std::min(packet_block_size, width_ - x),
                        rows = std::min(packet_block_size, height_ - y);
    for (std::uint32_t row = 0; row < rows; ++row)
        store_row({hits_.data() + std::size_t{row} * packet_block_size, columns},
                  &image_[std::size_t{y + row} * width_ + x]);
}

namespace {

// Where a tally's lengths are added; the first `skipped` that are not 0 have been added before.
struct Sums {
    std::uint32_t* words = nullptr;
    std::uint32_t* skipped = nullptr;
};

std::uint32_t add_to_sum(Sums sums, std::uint32_t word, std::uint32_t added)
{
    if (*sums.skipped == 0) return std::atomic_ref(sums.words[word]).fetch_add(added, std::memory_order_relaxed);
    --*sums.skipped;
    return 0; // so that no carry follows
}

namespace scalar {
#define LENGTH_SUMS Sums
#define NO_SUMS (Sums{})
#define HAS_SUMS(sums) ((sums).words != nullptr)
#define ADD_TO_SUM(sums, word, added) add_to_sum(sums, word, added)
#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/half32.h"
#include "kernels/kernel_cpp.h"
} // namespace scalar

constexpr std::size_t huge_page = std::size_t{2} << 20;

// What the scalar kernel needs for the rays that packets leave to it.
struct Rays {
    scalar::SceneView scene;
    scalar::TraceParams params;
    std::span<const Quad> given;

    [[nodiscard]] const Quad& direction(std::uint32_t number) const { return given[number]; }
    [[nodiscard]] const Quad& origin(std::uint32_t number) const
    {
        return given[given.size() / GIVEN_RAY_QUADS + number];
    }
};

const Rays& rays_of(const PacketJob& job)
{
    return *static_cast<const Rays*>(job.context);
}

void write_hit(const PacketJob& job, std::uint32_t number, const scalar::Hit& hit)
{
    static_assert(sizeof(hit) == HIT_WORDS * sizeof(std::uint32_t));
    std::memcpy(job.hits + std::size_t{HIT_WORDS} * number, &hit, sizeof(hit));
}

void trace_pixel(const PacketJob& job, std::uint32_t number)
{
    const Rays& rays = rays_of(job);
    const std::uint32_t x = job.block_x + number % packet_block_size, y = job.block_y + number / packet_block_size;
    write_hit(job, number, scalar::trace(rays.scene, rays.params, scalar::primary_ray(rays.params, x, y)));
}

void trace_given(const PacketJob& job, std::uint32_t number)
{
    const Rays& rays = rays_of(job);
    write_hit(job, number, scalar::trace_given(rays.scene, rays.params, rays.direction(number), rays.origin(number)));
}

void cross_given(const PacketJob& job, std::uint32_t number, std::uint32_t added)
{
    const Rays& rays = rays_of(job);
    const auto answer = scalar::cross_tets(rays.scene, rays.params, Sums{job.sums, &added}, job.absorbs,
                                           rays.direction(number), rays.origin(number));
    write_hit(job, number, std::bit_cast<scalar::Hit>(answer));
}

std::vector<PacketKernel> kernels_of_host()
{
    std::vector<PacketKernel> kernels;
#if MOST_PACKET_LANES >= 16
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        kernels.push_back({16, tetrace_trace_block_16, tetrace_trace_rays_16});
#endif
#if MOST_PACKET_LANES >= 8
    if (__builtin_cpu_supports("avx2")) kernels.push_back({8, tetrace_trace_block_8, tetrace_trace_rays_8});
#endif
    kernels.push_back({4, tetrace_trace_block_4, tetrace_trace_rays_4});
    return kernels;
}

std::string why_no_packets(unsigned lanes)
{
    if (lanes > MOST_PACKET_LANES)
        return "this build has none of more than " + std::to_string(MOST_PACKET_LANES) +
               " (CMake's TETRACE_PACKET_LANES)";
    return std::string("this processor lacks ") + (lanes == 8 ? "AVX2" : "AVX-512 (F, BW, DQ, VL)");
}

std::uint32_t* copy_of(const std::vector<Quad>& quads)
{
    if (quads.size() > (std::uint64_t{1} << 32) / 4)
        throw Error(ErrorKind::unsupported, "packets number the words of records with 32 bits, too few for " +
                                                std::to_string(quads.size() * sizeof(Quad)) +
                                                " bytes; schedule tiles takes them");
    const std::size_t bytes = quads.size() * sizeof(Quad);
    const std::size_t whole_pages = std::max(huge_page, (bytes + huge_page - 1) / huge_page * huge_page);
    void* const block = std::aligned_alloc(huge_page, whole_pages);
    if (block == nullptr)
        throw Error(ErrorKind::unsupported,
                    "packets need a copy of the records: " + std::to_string(whole_pages) + " bytes are not available");
#ifdef MADV_HUGEPAGE
    madvise(block, whole_pages, MADV_HUGEPAGE); // optional: without huge pages walks are slower
#endif
    std::memcpy(block, quads.data(), bytes);
    return static_cast<std::uint32_t*>(block);
}

std::uint32_t exit_of(const Quad& exits, std::uint32_t index)
{
    return index == 0 ? exits.x : index == 1 ? exits.y : exits.z;
}

// The exit of a record through the face opposite its corner `index`, as pack_half32() has it for a free face.
std::uint32_t exit_through_face(std::span<const Quad> quads, std::uint32_t record, std::uint32_t index)
{
    const auto apex = [&](std::uint32_t of) {
        const Quad& quad = quads[std::size_t{HALF32_QUADS} * of];
        return std::array{quad.x, quad.y, quad.z};
    };
    const std::uint32_t face = scalar::record_of_corner(record, index);
    const std::uint32_t half_face = quads[std::size_t{HALF32_QUADS} * face + 1].w;
    if (half_face == NO_HALF_FACE) return NO_HALF_FACE;
    const auto first = apex(scalar::record_of_corner(half_face, 0));
    std::uint32_t rotation = 0;
    while (rotation < 2 && apex(rotation == index ? record : scalar::record_of_corner(record, rotation)) != first)
        ++rotation;
    return half_face << 2 | rotation;
}

// Lets triangles' faces lead on to the next tet, as free ones do, for rays that cross tets.
void open_triangles(std::span<Quad> quads)
{
    for (std::uint32_t record = 0; record < quads.size() / HALF32_QUADS; ++record) {
        Quad& exits = quads[std::size_t{HALF32_QUADS} * record + 1];
        for (std::uint32_t index = 0; index < 3; ++index)
            if ((exit_of(exits, index) & 3u) == EXIT_END)
                (index == 0 ? exits.x : index == 1 ? exits.y : exits.z) = exit_through_face(quads, record, index);
    }
}

void copy3(Float3 from, float* to)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

PacketJob packet_job(const PackedScene& scene, const std::uint32_t* records, const TraceJob& job, const Rays& rays)
{
    PacketJob result{};
    result.records = records;
    result.triangles = reinterpret_cast<const std::uint32_t*>(scene.triangles.data());
    result.lines = reinterpret_cast<const float*>(scene.lines.data());
    result.entry_ranges = scene.entry_ranges.data();
    result.entry_half_faces = scene.entry_half_faces.data();
    result.divisions = scene.divisions;
    copy3(job.view.origin, result.origin);
    copy3(job.view.corner, result.corner);
    copy3(job.view.step_x, result.step_x);
    copy3(job.view.step_y, result.step_y);
    result.width = job.width;
    result.height = job.height;
    result.start_tet = job.start_tet;
    result.max_steps = std::min(job.max_steps, STEPS_BEFORE_DOUBT); // the rest is left to the scalar kernel
    if (!rays.given.empty()) {
        result.directions = reinterpret_cast<const std::uint32_t*>(&rays.direction(0));
        result.origins = reinterpret_cast<const std::uint32_t*>(&rays.origin(0));
    }
    result.trace_one = rays.given.empty() ? trace_pixel : trace_given;
    result.cross_one = cross_given;
    result.context = &rays;
    return result;
}

// What this thread takes of an image's blocks.
void trace_blocks(const PacketKernel& kernel, PacketJob job, std::span<Hit> hits, SharedTiles& tiles)
{
    const std::uint32_t across = (job.width + packet_block_size - 1) / packet_block_size;
    const std::uint32_t blocks = across * ((job.height + packet_block_size - 1) / packet_block_size);
    HitTile tile(hits, job.width, job.height);
    job.hits = reinterpret_cast<std::uint32_t*>(tile.hits().data());
    tiles.take(blocks, 1, [&](std::uint32_t block) {
        job.block_x = block % across * packet_block_size;
        job.block_y = block / across * packet_block_size;
        kernel.block(job);
        tile.store(job.block_x, job.block_y);
    });
}

} // namespace

const std::vector<PacketKernel>& packet_kernels()
{
    static const std::vector<PacketKernel> kernels = kernels_of_host();
    return kernels;
}

PacketKernel packet_kernel(unsigned lanes)
{
    std::string widths;
    for (const PacketKernel& kernel : packet_kernels()) {
        if (lanes == kernel.lanes || lanes == 0) return kernel;
        widths += (widths.empty() ? "" : ", ") + std::to_string(kernel.lanes);
    }
    throw Error(ErrorKind::unsupported, "this build lacks packets of " + std::to_string(lanes) +
                                            " lanes: " + why_no_packets(lanes) + "; there are some of " + widths);
}

PacketSession::PacketSession(PacketKernel kernel, Task task, const PackedScene& scene, unsigned threads)
    : HostSession(task, threads), kernel_(kernel), task_(task), scene_(scene)
{
    const Stopwatch watch;
    make_tally(task, scene.tet_count);
    records_.reset(copy_of(scene.tets));
    if (traits_of(task).crosses) open_triangles({reinterpret_cast<Quad*>(records_.get()), scene.tets.size()});
    copy_s_ = watch.seconds();
}

SetupTimes PacketSession::setup_times() const
{
    SetupTimes times;
    times.upload_s = copy_s_;
    return times;
}

void PacketSession::set_rays(std::span<const Quad> quads)
{
    rays_.assign(quads.begin(), quads.end());
    const auto directions = quads.first(quads.size() / GIVEN_RAY_QUADS), origins = quads.subspan(directions.size());
    rays_start_outside_ = std::ranges::any_of(directions, [](const Quad& quad) { return quad.w == NO_HALF_FACE; });
    rays_end_ = std::ranges::any_of(origins, [](const Quad& quad) { return std::bit_cast<float>(quad.w) < NO_END; });
}

void PacketSession::run(const TraceJob& job, std::span<std::uint32_t> output, SharedTiles& tiles)
{
    const Rays rays{scalar::view_of(scene_), scalar::params_of(job), rays_};
    PacketJob packets = packet_job(scene_, records_.get(), job, rays);
    const TaskTraits& traits = traits_of(task_);
    packets.goal = traits.crosses ? Goal::boundary : rays_end_ ? Goal::end : Goal::triangle;
    packets.absorbs = traits.absorbs;
    if (traits.tallies) packets.sums = output.data() + HIT_WORDS * job.rays();
    packets.starts_outside = rays_start_outside_;
    packets.hits = output.data();
    packets.ray_count = job.width * job.height;
    std::fenv_t environment; // as in kernel.cpp
    std::fegetenv(&environment);
    std::fesetenv(FE_DFL_ENV);
    if (traits.takes_rays)
        tiles.share([&](std::uint32_t* next_ray) {
            packets.next_ray = next_ray;
            kernel_.rays(packets);
        });
    else
        trace_blocks(kernel_, packets, as_hits(output), tiles);
    std::fesetenv(&environment);
}

} // namespace tetrace::openmp
