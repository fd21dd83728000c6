#include "backends/opencl/session.h"

#include "core/base/stopwatch.h"
#include "core/device/open_checks.h"

#include <algorithm>

namespace tetrace::opencl {

namespace {

// The arguments of kernel.cl's entry: these, then the scene's arrays, then the parts of the tets.
enum Argument : cl_uint {
    launch_argument,
    end_tile_argument,
    output_argument,
    counter_argument,
    rays_argument,
    first_array_argument
};

constexpr std::size_t smallest_buffer_bytes = 16; // OpenCL has no empty buffers

/// The most items that any device holds in a compute unit at once (NVIDIA's number). Groups that do not fit start when
/// all work is done. A processor's unit is one thread, which works on one group at a time.
constexpr std::size_t resident_items = 2048;

cl::Buffer make_buffer(const cl::Context& context, cl_mem_flags flags, std::size_t bytes)
{
    return {context, flags, std::max(bytes, smallest_buffer_bytes)};
}

cl::Buffer make_uploaded(const cl::Context& context, const cl::CommandQueue& queue, std::span<const std::byte> bytes)
{
    const cl::Buffer buffer = make_buffer(context, CL_MEM_READ_ONLY, bytes.size());
    if (!bytes.empty()) queue.enqueueWriteBuffer(buffer, CL_FALSE, 0, bytes.size(), bytes.data());
    return buffer;
}

} // namespace

OpenclSession::OpenclSession(std::shared_ptr<Context> context, const KernelId& kernel, const PackedScene& scene,
                             const SessionOptions& options)
    : context_(std::move(context)), kernel_id_(kernel), cache_(options.program_cache),
      starts_outside_(kernel.task == Task::trace && structure_of(kernel.layout) == Structure::cdt),
      tile_height_(tile_height_of(options)), max_buffer_bytes_(largest_buffer(context_->facts(), options)),
      domain_(domain_of(scene)), parts_(tet_parts(scene, max_buffer_bytes_)), scene_bytes_(scene.bytes()),
      launches_(tile_height_)
{
    run("making a queue", 0, [&] { queue_ = context_->make_queue(); });
    upload(scene);
    compile();
}

template <class Work>
void OpenclSession::run(const char* doing, std::uint64_t output_bytes, const Work& work)
{
    context_->run(std::string(doing) + " for " + name_of(kernel_id_), scene_bytes_ + output_bytes, work);
}

void OpenclSession::upload(const PackedScene& scene)
{
    const Stopwatch watch;
    run("uploading the scene", 0, [&] {
        const auto buffers = scene_buffers(scene);
        for (const SceneBuffer& buffer : buffers)
            arrays_.push_back(make_uploaded(context_->handle(), queue_,
                                            arrays_.empty() ? parts_.part(buffer.bytes, 0) : buffer.bytes));
        for (unsigned part = 1; part < parts_.count; ++part)
            more_parts_[part] = make_uploaded(context_->handle(), queue_, parts_.part(buffers[0].bytes, part));
        queue_.finish();
        counter_ = make_buffer(context_->handle(), CL_MEM_READ_WRITE, sizeof(cl_uint));
        rays_ = make_buffer(context_->handle(), CL_MEM_READ_ONLY, 0);
    });
    times_.upload_s = watch.seconds();
    resize_output(output_words({}, kernel_id_.task));
}

/// Compiles, and runs the kernel on no pixel: some drivers finish compiling at the first launch.
void OpenclSession::compile()
{
    const Stopwatch watch;
    std::string defines = "-DGROUP_ITEMS=" + std::to_string(TILE_WIDTH * tile_height_);
    if (kernel_id_.schedule == Schedule::persistent) defines += " -DPERSISTENT";
    if (kernel_id_.task == Task::rays) defines += " -DRAYS";
    if (kernel_id_.task == Task::search) defines += " -DSEARCH";
    if (parts_.count > 1) defines += " -DTETS_IN_PARTS";
    if (starts_outside_) defines += " -DSTARTS_OUTSIDE";
    const unsigned stack_top = context_->found().stack_top;
    if (structure_of(kernel_id_.layout) == Structure::bvh && stack_top > 0)
        defines += " -DSTACK_TOP=" + std::to_string(stack_top) + "u";
    const Program program(*context_, {source_name(kernel_id_), kernel_id_.math, defines}, cache_);
    run("making the kernel", output_bytes(), [&] {
        kernel_ = cl::Kernel(program.handle(), "run_image");
        set_arguments();
        LaunchParams nothing{};
        nothing.width = 1;
        nothing.tile_height = tile_height_;
        enqueue(nothing, 1, 1);
        queue_.finish();
        enqueued_.clear();
    });
    times_.compile_s += watch.seconds();
    times_.compile_cached = program.is_cached();
    program.keep();
}

void OpenclSession::compile_starts_inside()
{
    run("finishing", output_bytes(), [&] { take_times(); }); // launches that still run the old program
    starts_outside_ = false;
    compile();
}

void OpenclSession::set_arguments()
{
    cl_uint argument = first_array_argument;
    for (const SceneArray& array : scene_arrays(kernel_id_.layout))
        kernel_.setArg(argument++, arrays_[array.binding]);
    for (unsigned part = 1; part < MAX_TET_PARTS && parts_.count > 1; ++part)
        kernel_.setArg(argument++, part < parts_.count ? more_parts_[part] : arrays_[0]);
    kernel_.setArg(counter_argument, counter_);
    kernel_.setArg(rays_argument, rays_);
    kernel_.setArg(output_argument, output_);
}

void OpenclSession::set_rays(std::span<const Quad> quads)
{
    require_rays_fit(quads, max_buffer_bytes_);
    run("uploading rays", quads.size_bytes(), [&] {
        queue_.finish();      // enqueued work reads the old ones
        rays_ = cl::Buffer(); // the old ones are freed first: both may not fit
        rays_ = make_uploaded(context_->handle(), queue_, std::as_bytes(quads));
        queue_.finish();
        kernel_.setArg(rays_argument, rays_);
    });
}

void OpenclSession::resize_output(std::size_t words)
{
    if (words == output_words_) return;
    require_output_fits(words, max_buffer_bytes_);
    const std::uint64_t bytes = words * sizeof(std::uint32_t);
    output_ = cl::Buffer(); // the old one is freed first: both may not fit
    output_words_ = 0;
    run("making the output", bytes, [&] {
        output_ = make_buffer(context_->handle(), CL_MEM_READ_WRITE, bytes);
        if (kernel_() != nullptr) kernel_.setArg(output_argument, output_);
    });
    output_words_ = words;
}

std::size_t OpenclSession::groups_for(std::uint32_t tiles) const
{
    if (kernel_id_.schedule == Schedule::tiles) return tiles;
    const std::size_t units = context_->threads();
    const std::size_t resident = context_->facts().kind == DeviceKind::gpu
                                     ? units * (resident_items / (std::size_t{TILE_WIDTH} * tile_height_))
                                     : units;
    return std::min<std::size_t>(tiles, resident);
}

/// Persistent groups count tiles: their counter is filled before each pass, which is no part of its time.
void OpenclSession::enqueue(const LaunchParams& params, std::uint32_t tiles, std::uint32_t passes)
{
    const bool is_persistent = kernel_id_.schedule == Schedule::persistent;
    kernel_.setArg(launch_argument, params);
    kernel_.setArg(end_tile_argument, params.first_tile + tiles);
    const std::size_t group_items = std::size_t{TILE_WIDTH} * tile_height_;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        if (is_persistent) queue_.enqueueFillBuffer(counter_, params.first_tile, 0, sizeof(params.first_tile));
        const bool is_first = is_persistent || pass == 0;
        if (is_first) enqueued_.push_back({tiles, is_persistent ? 1 : passes, {}, {}});
        Enqueued& launched = enqueued_.back();
        const bool is_timed = is_first || pass + 1 == passes;
        queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(groups_for(tiles) * group_items),
                                    cl::NDRange(group_items), nullptr,
                                    !is_timed  ? nullptr
                                    : is_first ? &launched.first
                                               : &launched.last);
    }
}

void OpenclSession::launch(const TraceJob& job)
{
    if (job.start_tet != NO_TET && starts_outside_) compile_starts_inside();
    resize_output(output_words(job, kernel_id_.task));
    run("launching", output_bytes(), [&] {
        enqueued_.clear();
        queue_.enqueueFillBuffer(output_, POISON, 0, output_bytes());
        launches_.start(
            launch_params(job, domain_, tile_height_, parts_.log2_bytes), job.passes,
            [this](const LaunchParams& params, std::uint32_t tiles, std::uint32_t passes) {
                enqueue(params, tiles, passes);
            },
            [this] { take_times(); });
        queue_.flush();
    });
}

double OpenclSession::wait()
{
    run("waiting", output_bytes(), [&] { take_times(); });
    return launches_.seconds();
}

void OpenclSession::take_times()
{
    queue_.finish();
    for (const Enqueued& launched : enqueued_) {
        const cl::Event& last = launched.passes > 1 ? launched.last : launched.first;
        launched.first.wait(); // reports an error of the kernel
        last.wait();
        launches_.took(launched.tiles, launched.passes, seconds_between(launched.first, last));
    }
    enqueued_.clear();
}

void OpenclSession::read_output(std::span<std::uint32_t> words)
{
    require_output_of_last_launch(words.size(), output_words_);
    run("reading back", output_bytes(),
        [&] { queue_.enqueueReadBuffer(output_, CL_TRUE, 0, words.size_bytes(), words.data()); });
}

} // namespace tetrace::opencl
