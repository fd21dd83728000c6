#include "backends/cuda/session.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/device/scene_buffers.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace tetrace::cuda {

namespace {

/// One address space needs no limit and no parts, but a smaller limit in the options is still enforced.
void require_arrays_fit(const PackedScene& scene, std::uint64_t max_buffer_bytes)
{
    for (const SceneBuffer& buffer : scene_buffers(scene))
        if (max_buffer_bytes != 0 && buffer.bytes.size() > max_buffer_bytes)
            throw Error(ErrorKind::unsupported,
                        "the scene's array '" + std::string(buffer.name) + "' has " +
                            std::to_string(buffer.bytes.size()) + " bytes, the largest buffer asked for " +
                            std::to_string(max_buffer_bytes) + "; CUDA kernels are given it as one");
}

} // namespace

CudaSession::CudaSession(const Driver& driver, Ordinal device, const Programs& programs, const KernelId& kernel,
                         const PackedScene& scene, const SessionOptions& options, unsigned tile_height)
    : device_(driver, device),
      program_(load_program(device_.context, device_.capability, programs, program_of(kernel), options.program_cache)),
      task_(kernel.task), schedule_(kernel.schedule), stack_bytes_(stack_bytes_of_item(kernel.layout)),
      outside_(entry(device, entry_name(kernel, true))), inside_(entry(device, entry_name(kernel, false))),
      domain_(domain_of(scene)), timer_(device_.context), outputs_(device_.context, device_.stream.get()),
      tile_height_(tile_height), threads_(options.threads), max_buffer_bytes_(options.max_buffer_bytes),
      launches_(tile_height), bytes_(scene.bytes())
{
    make_tally(kernel.task, scene.tet_count);
    require_arrays_fit(scene, max_buffer_bytes_);
    setup_.compile_s = program_.compile_s;
    setup_.compile_cached = program_.cached;
    upload(scene);
}

CudaSession::~CudaSession()
{
    // Modules and memory are released in the context that is current.
    device_.driver().context_set_current(device_.context.handle());
}

CudaSession::Entry CudaSession::entry(Ordinal device, const std::string& name)
{
    const FunctionHandle function = program_.module.function(name);
    const Driver& driver = device_.driver();
    int blocks = 0;
    device_.context.check(driver.blocks_per_multiprocessor(&blocks, function, persistent_block_threads,
                                                           std::size_t{stack_bytes_} * persistent_block_threads),
                          "asking how many blocks fit");
    return {function,
            static_cast<unsigned>(std::max(1, blocks * attribute_of(driver, device, attribute_multiprocessors)))};
}

void CudaSession::make_current()
{
    device_.context.make_current();
    if (device_.driver().is_emulation()) device_.driver().use_threads(threads_);
}

void CudaSession::upload(const PackedScene& scene)
{
    const Stopwatch watch;
    for (const SceneBuffer& buffer : scene_buffers(scene))
        arrays_.emplace_back(device_.context, buffer.bytes, buffer.name, device_.stream.get());
    device_.synchronize();
    setup_.upload_s = watch.seconds();
    for (const SceneArray& array : scene_arrays(scene.layout))
        scene_.push_back(arrays_[array.binding].address());
    std::array<std::uint64_t, 4> domain{}; // SceneView ends in the same words; the kernels' compiler pads to 8 bytes
    static_assert(sizeof(domain_) <= sizeof(domain));
    std::memcpy(domain.data(), &domain_, sizeof(domain_));
    scene_.insert(scene_.end(), domain.begin(), domain.end());
}

void CudaSession::set_rays(std::span<const Quad> quads)
{
    require_rays_fit(quads, max_buffer_bytes_);
    make_current();
    finish_launch(); // the launch reads the old ones
    rays_ = {};      // freed before the new ones are made: both may not fit
    rays_ = Memory(device_.context, std::as_bytes(quads), "the rays", device_.stream.get());
    device_.synchronize();
}

void CudaSession::poison_output(std::size_t words)
{
    require_output_fits(words, max_buffer_bytes_);
    if (output_.bytes() != words * sizeof(std::uint32_t)) {
        output_ = {}; // freed before the new one is made: both may not fit
        output_ = Memory(device_.context, words * sizeof(std::uint32_t), "the output");
    }
    device_.context.check(device_.driver().fill_words(output_.address(), POISON, words, device_.stream.get()),
                          "filling the output");
}

void CudaSession::start(std::span<const TraceJob> jobs)
{
    make_current();
    join_streams(); // of a launch that failed
    launched_tiles_ = 0;
    parts_ = output_parts(words_per_ray(task_));
    poison_output(parts_.words());
    entries_.clear();
    for (const TraceJob& job : jobs)
        entries_.push_back(job.start_tet == NO_TET ? outside_ : inside_);
    launches_.start(
        launch_params(jobs, domain_, tile_height_, TetParts{}.log2_bytes), jobs.front().passes,
        [this](std::span<const LaunchPiece> pieces, std::uint32_t passes) { start_launch(pieces, passes); },
        [this] { finish_launch(); }, jobs.front().in_flight);
}

void CudaSession::join_streams()
{
    for (SideStreams& sides : sides_)
        sides.join();
    outputs_.join();
}

void CudaSession::start_launch(std::span<const LaunchPiece> pieces, std::uint32_t passes)
{
    finish_launch(); // the previous one: there is only one stopwatch
    if (schedule_ == Schedule::persistent) clear_counters(passes * pieces.size());
    Address counter = counters_.address();
    timer_.start(device_.stream.get());
    outputs_.fork(launches_.in_flight());
    while (sides_.size() < launches_.in_flight())
        sides_.emplace_back(device_.context, outputs_.stream(sides_.size()));
    const std::size_t streams = std::min(pieces.size(), SideStreams::max_streams / launches_.in_flight());
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        SideStreams& sides =
            sides_[launches_.output_of(pass)]; // whose main stream has the previous pass of that output
        sides.fork(streams);
        std::size_t i = 0;
        for (const LaunchPiece& piece : launches_.of_pass(pieces, pass)) {
            const StreamHandle stream = sides.stream(i++);
            if (schedule_ == Schedule::persistent)
                launch_persistent(piece, counter, stream);
            else
                launch_tiles(piece, stream);
            counter += sizeof(std::uint32_t);
        }
        sides.join();
    }
    join_streams();
    timer_.stop(device_.stream.get());
    launched_tiles_ = tile_count(pieces);
    launched_passes_ = passes;
}

Address CudaSession::output_of(std::size_t job) const
{
    return output_.address() + parts_.begin(job) * sizeof(std::uint32_t);
}

void CudaSession::launch_tiles(const LaunchPiece& piece, StreamHandle stream)
{
    LaunchParams launch = piece.params;
    Address output = output_of(piece.job), rays = rays_.address();
    void* parameters[] = {scene_.data(), &launch, &output, &rays}; // the last one is of tasks with given rays
    const unsigned threads = TILE_WIDTH * tile_height_;
    device_.launch(entry_of(piece).function, piece.tiles, threads, parameters, stack_bytes_ * threads, stream);
}

void CudaSession::launch_persistent(const LaunchPiece& piece, Address counter, StreamHandle stream)
{
    LaunchParams launch = piece.params;
    std::uint32_t tiles = piece.tiles;
    Address output = output_of(piece.job), rays = rays_.address();
    void* parameters[] = {scene_.data(), &launch, &output, &counter, &tiles, &rays}; // the last one is of task rays
    const std::uint32_t items = tiles * TILE_WIDTH * tile_height_;
    const unsigned blocks = (items + persistent_block_threads - 1) / persistent_block_threads;
    const Entry& entry = entry_of(piece);
    device_.launch(entry.function, std::min(blocks, entry.resident_blocks), persistent_block_threads, parameters,
                   stack_bytes_ * persistent_block_threads, stream);
}

/// Each piece of each pass has a counter of its own: they are cleared together, which is not a part of the passes'
/// time.
void CudaSession::clear_counters(std::size_t count)
{
    const std::size_t bytes = count * sizeof(std::uint32_t);
    if (counters_.bytes() < bytes) {
        counters_ = {};
        counters_ = Memory(device_.context, bytes, "the counters of persistent threads");
    }
    device_.context.check(device_.driver().fill_words(counters_.address(), 0, count, device_.stream.get()),
                          "clearing the counters");
}

void CudaSession::finish_launch()
{
    if (launched_tiles_ == 0) return;
    launches_.took(launched_tiles_, launched_passes_, timer_.seconds());
    launched_tiles_ = 0;
}

double CudaSession::wait()
{
    make_current();
    finish_launch();
    return launches_.seconds();
}

void CudaSession::read_output(std::span<std::uint32_t> words)
{
    make_current();
    require_output_of_last_launch(words.size(), output_.bytes() / sizeof(words[0]));
    device_.context.check(
        device_.driver().copy_to_host(words.data(), output_.address(), words.size_bytes(), device_.stream.get()),
        "copying the output to the host");
    device_.synchronize();
}

} // namespace tetrace::cuda
