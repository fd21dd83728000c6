#include "backends/opencl/session.h"

#include "core/base/stopwatch.h"
#include "core/device/session.h"

#include <algorithm>
#include <array>

namespace tetrace::opencl {

namespace {

/// More kernels are not in flight together.
constexpr std::size_t max_queues = 8;

constexpr std::size_t min_buffer_bytes = 16; // OpenCL does not allow empty buffers

/// The most items that any device holds in a compute unit at once (NVIDIA's number). Groups that do not fit start when
/// all work is done. A processor's unit is one thread, which works on one group at a time.
constexpr std::size_t resident_items = 2048;

cl::Buffer make_buffer(const cl::Context& context, cl_mem_flags flags, std::size_t bytes)
{
    return {context, flags, std::max(bytes, min_buffer_bytes)};
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
    : context_(std::move(context)), kernel_id_(kernel),
      cache_(context_->found().keeps_programs ? std::filesystem::path() : options.program_cache),
      program_file_(options.program_file),
      starts_outside_(kernel.task == Task::trace && structure_of(kernel.layout) == Structure::cdt),
      tile_height_(tile_height_of(options)), max_buffer_bytes_(max_buffer(context_->facts(), options)),
      domain_(domain_of(scene)), tet_parts_(tet_parts(scene, max_buffer_bytes_)), scene_bytes_(scene.bytes()),
      launches_(tile_height_)
{
    make_tally(kernel.task, scene.tet_count);
    run("making a queue", 0, [&] { queues_.push_back(context_->make_queue()); });
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
            arrays_.push_back(make_uploaded(context_->handle(), queues_[0],
                                            arrays_.empty() ? tet_parts_.part(buffer.bytes, 0) : buffer.bytes));
        for (unsigned part = 1; part < tet_parts_.count; ++part)
            more_parts_[part] = make_uploaded(context_->handle(), queues_[0], tet_parts_.part(buffers[0].bytes, part));
        queues_[0].finish();
        rays_ = make_buffer(context_->handle(), CL_MEM_READ_ONLY, 0);
    });
    times_.upload_s = watch.seconds();
    resize_output(OutputParts(std::array<std::size_t, 1>{}, words_per_ray(kernel_id_.task)));
}

/// Compiles, and runs the kernel on no pixel: some drivers finish compiling at the first launch.
void OpenclSession::compile()
{
    const Stopwatch watch;
    const std::string defines =
        defines_of(kernel_id_, tile_height_, tet_parts_.count > 1, starts_outside_, context_->found().stack_top);
    const Program program(
        *context_,
        {.source = source_name(kernel_id_), .math = kernel_id_.math, .defines = defines, .file = program_file_},
        cache_);
    run("making the kernel", output_bytes(), [&] {
        kernel_ = cl::Kernel(program.handle(), "run_image");
        set_arguments();
        require_queues(1, 1);
        enqueue_on_nothing(1);
        queues_[0].finish();
    });
    max_tiles_ = 0;
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
    for (unsigned part = 1; part < MAX_TET_PARTS && tet_parts_.count > 1; ++part)
        kernel_.setArg(argument++, part < tet_parts_.count ? more_parts_[part] : arrays_[0]);
    kernel_.setArg(rays_argument, rays_);
}

void OpenclSession::set_rays(std::span<const Quad> quads)
{
    require_rays_fit(quads, max_buffer_bytes_);
    run("uploading rays", quads.size_bytes(), [&] {
        queues_[0].finish();  // enqueued work reads the old ones
        rays_ = cl::Buffer(); // the old ones are freed first: both may not fit
        rays_ = make_uploaded(context_->handle(), queues_[0], std::as_bytes(quads));
        queues_[0].finish();
        kernel_.setArg(rays_argument, rays_);
    });
}

void OpenclSession::resize_output(const OutputParts& parts)
{
    if (parts == parts_) return;
    require_output_fits(parts.words(), max_buffer_bytes_);
    const std::uint64_t bytes = parts.words() * sizeof(std::uint32_t);
    outputs_.clear(); // the old one is freed first: both may not fit
    output_ = cl::Buffer();
    parts_ = {};
    run("making the output", bytes, [&] {
        output_ = make_buffer(context_->handle(), CL_MEM_READ_WRITE, bytes);
        for (std::size_t job = 0; job < parts.count(); ++job) {
            cl_buffer_region part = {parts.begin(job) * sizeof(std::uint32_t), parts.size(job) * sizeof(std::uint32_t)};
            outputs_.push_back(parts.count() == 1 ? output_
                                                  : output_.createSubBuffer(0, CL_BUFFER_CREATE_TYPE_REGION, &part));
        }
    });
    parts_ = parts;
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

void OpenclSession::require_queues(std::size_t queues, std::size_t counters)
{
    while (counters_.size() < counters)
        counters_.push_back(make_buffer(context_->handle(), CL_MEM_READ_WRITE, sizeof(cl_uint)));
    while (queues_.size() < queues)
        queues_.push_back(context_->make_queue());
}

void OpenclSession::enqueue_on_nothing(std::uint32_t tiles)
{
    LaunchParams nothing{};
    nothing.width = 1;
    nothing.tile_height = tile_height_;
    queues_[0].enqueueFillBuffer(counters_[0], nothing.first_tile, 0, sizeof(cl_uint));
    enqueue_piece({0, nothing, tiles}, 0, queues_[0], {}, nullptr);
}

/// PoCL before 6.0 makes a new entry of a kernel for each wider launch. A launch adds a use to its own entry, and at
/// its end takes one from the newest (docs/findings.md, 13). Once the widest launch has run, all use its entry.
void OpenclSession::enqueue_widest_first(std::span<const LaunchPiece> pieces)
{
    const std::uint32_t tiles = std::ranges::max_element(pieces, {}, &LaunchPiece::tiles)->tiles;
    if (!context_->found().mixes_up_widths || tiles <= max_tiles_) return;
    max_tiles_ = tiles;
    enqueue_on_nothing(tiles);
}

/// Persistent groups count tiles: their counters are filled before each pass, which is not a part of its time.
void OpenclSession::enqueue(std::span<const LaunchPiece> pieces, std::uint32_t passes)
{
    if (launches_.in_flight() > 1) return enqueue_in_flight(pieces, passes);
    const bool is_persistent = kernel_id_.schedule == Schedule::persistent;
    require_queues(std::min(pieces.size(), max_queues), pieces.size());
    if (pieces.size() > 1) enqueue_widest_first(pieces);
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        for (std::size_t i = 0; is_persistent && i < pieces.size(); ++i)
            queues_[0].enqueueFillBuffer(counters_[i], pieces[i].params.first_tile, 0, sizeof(cl_uint));
        if (is_persistent || pass == 0) enqueued_.push_back({tile_count(pieces), is_persistent ? 1 : passes, {}});
        std::vector<cl::Event>& events = enqueued_.back().events;
        const bool is_timed = is_persistent || pass == 0 || pass + 1 == passes;
        if (pieces.size() > 1)
            enqueue_together(pieces, is_timed ? &events : nullptr);
        else
            enqueue_piece(pieces.front(), 0, queues_[0], {}, is_timed ? &events.emplace_back() : nullptr);
    }
}

void OpenclSession::enqueue_piece(const LaunchPiece& piece, std::size_t counter, cl::CommandQueue& queue,
                                  const std::vector<cl::Event>& after, cl::Event* event)
{
    kernel_.setArg(counter_argument, counters_[counter]);
    kernel_.setArg(launch_argument, piece.params);
    kernel_.setArg(end_tile_argument, piece.params.first_tile + piece.tiles);
    kernel_.setArg(output_argument, outputs_[piece.job]);
    const std::size_t group_items = std::size_t{TILE_WIDTH} * tile_height_;
    queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(groups_for(piece.tiles) * group_items),
                               cl::NDRange(group_items), &after, event);
}

/// Each output has queues of its own. The counters of persistent groups are filled while other passes run: that is a
/// part of the time.
void OpenclSession::enqueue_in_flight(std::span<const LaunchPiece> pieces, std::uint32_t passes)
{
    const std::size_t outputs = launches_.in_flight(), width = std::min(pieces.size(), max_queues / outputs);
    require_queues(outputs * width, outputs * pieces.size());
    enqueue_widest_first(pieces);
    std::vector<cl::Event> forked(1);
    queues_[0].enqueueMarkerWithWaitList(nullptr, &forked[0]);
    queues_[0].flush();
    std::vector ended(outputs, forked); // what the next pass of each output waits for
    enqueued_.push_back({tile_count(pieces), passes, {}});
    std::vector<cl::Event>& timed = enqueued_.back().events;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const std::size_t output = launches_.output_of(pass);
        const std::vector<LaunchPiece> own = launches_.of_pass(pieces, pass);
        std::vector<cl::Event> events(own.size());
        for (std::size_t i = 0; i < own.size(); ++i) {
            const std::size_t counter = output * own.size() + i;
            cl::CommandQueue& queue = queues_[output * width + i % width];
            if (kernel_id_.schedule == Schedule::persistent)
                queue.enqueueFillBuffer(counters_[counter], own[i].params.first_tile, 0, sizeof(cl_uint),
                                        &ended[output]);
            enqueue_piece(own[i], counter, queue, ended[output], &events[i]);
        }
        for (std::size_t i = 0; i < width; ++i)
            queues_[output * width + i].flush();
        if (pass < outputs || pass + outputs >= passes) timed.insert(timed.end(), events.begin(), events.end());
        ended[output] = std::move(events);
    }
    for (const std::vector<cl::Event>& last : ended)
        queues_[0].enqueueBarrierWithWaitList(&last);
}

/// A queue waits for another's events only if that one has been flushed.
void OpenclSession::enqueue_together(std::span<const LaunchPiece> pieces, std::vector<cl::Event>* events)
{
    std::vector<cl::Event> forked(1), ended(pieces.size());
    queues_[0].enqueueMarkerWithWaitList(nullptr, &forked[0]);
    queues_[0].flush();
    for (std::size_t i = 0; i < pieces.size(); ++i)
        enqueue_piece(pieces[i], i, queues_[i % queues_.size()], forked, &ended[i]);
    for (cl::CommandQueue& queue : queues_)
        queue.flush();
    queues_[0].enqueueBarrierWithWaitList(&ended);
    if (events != nullptr) events->insert(events->end(), ended.begin(), ended.end());
}

void OpenclSession::start(std::span<const TraceJob> jobs)
{
    const auto starts_inside = [](const TraceJob& job) { return job.start_tet != NO_TET; };
    resize_output(output_parts(words_per_ray(kernel_id_.task)));
    if (starts_outside_ && std::ranges::any_of(jobs, starts_inside)) compile_starts_inside();
    run("launching", output_bytes(), [&] {
        enqueued_.clear();
        queues_[0].enqueueFillBuffer(output_, POISON, 0, output_bytes());
        launches_.start(
            launch_params(jobs, domain_, tile_height_, tet_parts_.log2_bytes), jobs.front().passes,
            [this](std::span<const LaunchPiece> pieces, std::uint32_t passes) { enqueue(pieces, passes); },
            [this] { take_times(); }, jobs.front().in_flight);
        queues_[0].flush();
    });
}

double OpenclSession::wait()
{
    run("waiting", output_bytes(), [&] { take_times(); });
    return launches_.seconds();
}

void OpenclSession::take_times()
{
    queues_[0].finish();
    for (const Enqueued& launched : enqueued_) {
        for (const cl::Event& event : launched.events)
            event.wait(); // reports an error of the kernel
        launches_.took(launched.tiles, launched.passes, seconds_of(launched.events));
    }
    enqueued_.clear();
}

void OpenclSession::read_output(std::span<std::uint32_t> words)
{
    require_output_of_last_launch(words.size(), parts_.words());
    run("reading back", output_bytes(),
        [&] { queues_[0].enqueueReadBuffer(output_, CL_TRUE, 0, words.size_bytes(), words.data()); });
}

} // namespace tetrace::opencl
