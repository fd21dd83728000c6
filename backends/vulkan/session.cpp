#include "backends/vulkan/session.h"

#include "backends/vulkan/kernels.h"
#include "core/base/files.h"
#include "core/base/stopwatch.h"
#include "core/device/session.h"

#include <algorithm>
#include <array>

namespace tetrace::vulkan {

namespace {

void require_storage_buffers(const FoundDevice& found, const PackedScene& scene, const TetParts& parts)
{
    const std::uint32_t needed = storage_buffers_needed(scene_buffers(scene).size(), parts.count > 1);
    if (found.limits.storage_buffers >= needed) return;
    throw Error(ErrorKind::unsupported, "tets in " + std::to_string(parts.count) + " buffers on '" + found.facts.name +
                                            "': a shader has " + std::to_string(found.limits.storage_buffers) +
                                            " storage buffers, " + std::to_string(needed) + " are needed");
}

/// Whether the scene is read as texels: if the device prefers it, its views can be that large, and no other program is
/// given.
bool is_in_texels(const FoundDevice& found, const PackedScene& scene, const TetParts& parts,
                  const SessionOptions& options)
{
    if (!found.reads_texels || parts.count > 1 || !options.program_file.empty()) return false;
    const auto fits = [&](const SceneBuffer& buffer) {
        return buffer.bytes.size() / sizeof(std::uint32_t) <= found.limits.texels;
    };
    return std::ranges::all_of(scene_buffers(scene), fits);
}

/// What the program's arrays hold, for rays that touch this many entries. In steps, so that few programs are compiled
/// and cached.
std::uint32_t array_entries(std::uint32_t stack_entries)
{
    constexpr std::uint32_t step = 4;
    return (stack_entries + step - 1) / step * step;
}

/// How many adjacent tiles one thread of an emulated device gets. With 1, walks lose 2 %, because neighbouring tiles
/// read the same data; with 16, BVHs lose 3 %, because a thread gets the same few columns in all rows.
constexpr std::uint32_t tiles_of_run = 4;

constexpr std::uint32_t structure_binding = 0; // of a driver's BVH, as in rt/item.glsl

/// Of a dispatch, or of a launch of a pipeline.
std::uint32_t max_tiles(const FoundDevice& found, const KernelId& kernel, unsigned tile_height)
{
    const std::uint32_t groups = found.limits.groups;
    if (tracer_of(kernel) == RayTracer::queries) return groups;
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(groups, found.ray_tracing.max_rays / (TILE_WIDTH * tile_height)));
}

void require_variant(const KernelId& kernel, const TetParts& parts)
{
    if (kernel.task != Task::trace && parts.count > 1)
        throw Error(ErrorKind::unsupported, "vulkan gives rays to kernels that read the tets from one buffer, and "
                                            "these are in " +
                                                std::to_string(parts.count));
}

} // namespace

std::vector<TexelBinding> texel_bindings(Layout layout)
{
    std::vector<TexelBinding> texels;
    for (const SceneArray& array : scene_arrays(layout))
        texels.push_back(array.element_bytes == sizeof(Quad)
                             ? TexelBinding{FIRST_QUADS_BINDING + array.binding, vk::Format::eR32G32B32A32Uint}
                             : TexelBinding{array.binding, vk::Format::eR32Uint});
    return texels;
}

VulkanSession::VulkanSession(const FoundDevice& found, const KernelId& kernel, const PackedScene& scene,
                             const SessionOptions& options)
    : context_(found), tet_parts_(tet_parts(scene, max_buffer(found.facts, options))),
      max_buffer_bytes_(max_buffer(found.facts, options)), tile_height_(tile_height_of(options)), kernel_(kernel),
      program_cache_(options.program_cache),
      given_program_(options.program_file.empty() ? "" : required_bytes(options.program_file)),
      in_texels_(is_in_texels(found, scene, tet_parts_, options)),
      stack_entries_(in_texels_ ? array_entries(scene.stack_entries) : 0), domain_(domain_of(scene)),
      launches_(tile_height_, found.limits.groups)
{
    require_storage_buffers(found, scene, tet_parts_);
    require_variant(kernel, tet_parts_);
    make_tally(kernel.task, scene.tet_count);
    const Stopwatch watch;
    context_.run("uploading the scene", scene.bytes(), [&] { make_scene_buffers(scene); });
    setup_.upload_s = watch.seconds();
    compile();
}

VulkanSession::VulkanSession(const FoundDevice& found, const KernelId& kernel, const TriangleMesh& mesh,
                             const SessionOptions& options)
    : context_(found, tracer_of(kernel)), max_buffer_bytes_(max_buffer(found.facts, options)),
      tile_height_(tile_height_of(options)), kernel_(kernel), program_cache_(options.program_cache),
      launches_(tile_height_, max_tiles(found, kernel, tile_height_))
{
    acceleration_.emplace(context_, mesh);
    bytes_ = acceleration_->bytes();
    setup_.upload_s = acceleration_->upload_s();
    setup_.build_s = acceleration_->build_s();
    compile();
}

VulkanSession::~VulkanSession()
{
    try {
        context_.finish(); // nothing may be destroyed while the device uses it
    } catch (const std::exception&) {
        return; // a device that is lost uses nothing
    }
}

void VulkanSession::make_scene_buffers(const PackedScene& scene)
{
    const auto make = [&](std::span<const std::byte> bytes) {
        Buffer buffer(context_, bytes.size(), BufferUse::device);
        upload(context_, buffer, bytes);
        bytes_ += buffer.bytes();
        return buffer;
    };
    const auto buffers = scene_buffers(scene);
    const std::span<const std::byte> tets = buffers[0].bytes;
    arrays_.push_back(make(tet_parts_.part(tets, 0)));
    for (std::size_t binding = 1; binding < buffers.size(); ++binding)
        arrays_.push_back(make(buffers[binding].bytes));
    for (unsigned part = 1; part < tet_parts_.count; ++part)
        more_parts_.push_back(make(tet_parts_.part(tets, part)));
}

void VulkanSession::compile()
{
    const Stopwatch watch;
    make_program();
    setup_.compile_s += watch.seconds();
    context_.check_validation("the first launch");
}

void VulkanSession::compile_starts_inside()
{
    take_times(); // for launches that still run the old program
    starts_outside_ = false;
    compile();
    if (parts_.count() != 0) bind_output();
}

void VulkanSession::make_program()
{
    const bool takes_rays = kernel_.task != Task::trace;
    const char* const variant = in_texels_ ? "_texels" : tet_parts_.count > 1 ? "_parts" : "";
    ProgramId id{.name = shader_name(kernel_) + variant,
                 .bindings = {OUTPUT_BINDING},
                 .push_constant_bytes = sizeof(LaunchParams),
                 .tile_height = tile_height_,
                 .is_ray_pipeline = kernel_.schedule == Schedule::pipeline,
                 .starts_outside = starts_outside_,
                 .selects_minima = context_.found().selects_minima,
                 .stack_top = context_.found().stack_top,
                 .stack_entries = stack_entries_};
    const EmbeddedKernel given{id.name, std::as_bytes(std::span(given_program_))};
    if (!given_program_.empty()) id.kernels = {&given, 1};
    if (in_texels_) id.texels = texel_bindings(kernel_.layout);
    if (acceleration_) id.structure = structure_binding;
    for (std::uint32_t binding = 0; !in_texels_ && binding < arrays_.size(); ++binding)
        id.bindings.push_back(binding);
    if (takes_rays && in_texels_) id.texels.push_back(rays_as_texels);
    if (takes_rays && !in_texels_) id.bindings.push_back(RAYS_BINDING);
    for (std::uint32_t part = 1; tet_parts_.count > 1 && part < MAX_TET_PARTS; ++part)
        id.bindings.push_back(SECOND_PART_BINDING - 1 + part);
    programs_.clear();
    const auto add = [&] { programs_.emplace_back(context_, id, ProgramCache(program_cache_)); };
    const std::string leaves = shader_name(kernel_) + "_leaves_texels";
    if (in_texels_ && starts_outside_ && find_kernel(embedded_kernels(), leaves) != nullptr) {
        id.bindings.push_back(DEFERRED_BINDING);
        id.name = leaves;
        add();
        id.name = shader_name(kernel_) + "_left_texels";
    }
    add();
    setup_.compile_cached = std::ranges::all_of(programs_, &Program::is_cached);
    for (Program& program : programs_)
        bind_scene(program);
}

void VulkanSession::bind_scene(Program& program)
{
    if (acceleration_) program.bind_structure(context_, structure_binding, acceleration_->handle());
    for (const TexelBinding& texels : in_texels_ ? texel_bindings(kernel_.layout) : std::vector<TexelBinding>{})
        program.bind_texels(context_, texels, arrays_[texels.binding % FIRST_QUADS_BINDING]);
    for (std::uint32_t binding = 0; !in_texels_ && binding < arrays_.size(); ++binding)
        program.bind(context_, binding, arrays_[binding]);
    for (unsigned part = 1; tet_parts_.count > 1 && part < MAX_TET_PARTS; ++part) // those after the last are never read
        program.bind(context_, SECOND_PART_BINDING - 1 + part,
                     part < tet_parts_.count ? more_parts_[part - 1] : arrays_[0]);
}

void VulkanSession::set_rays(std::span<const Quad> quads)
{
    require_rays_fit(quads, max_buffer_bytes_);
    const std::uint64_t words = quads.size_bytes() / sizeof(std::uint32_t);
    if (in_texels_ && words > context_.found().limits.texels)
        throw Error(ErrorKind::unsupported, "the rays have " + std::to_string(words) + " words, the device's views " +
                                                std::to_string(context_.found().limits.texels));
    context_.run("uploading rays", quads.size_bytes(), [&] {
        take_times(); // for launches that still read the old ones
        if (rays_.bytes() != quads.size_bytes()) bind_rays(Buffer(context_, quads.size_bytes(), BufferUse::device));
        upload(context_, rays_, std::as_bytes(quads));
    });
}

/// The view of the old ones is destroyed before they are.
void VulkanSession::bind_rays(Buffer rays)
{
    for (Program& program : programs_)
        if (in_texels_)
            program.bind_texels(context_, rays_as_texels, rays);
        else
            program.bind(context_, RAYS_BINDING, rays);
    rays_ = std::move(rays);
    if (parts_.count() != 0) bind_output(); // the sets of further jobs are copies
}

void VulkanSession::bind_output()
{
    constexpr std::uint64_t word = sizeof(std::uint32_t);
    for (Program& program : programs_) {
        program.forget_other_sets();
        for (std::size_t job = 0; job < parts_.count(); ++job) {
            program.bind_part(context_, job, OUTPUT_BINDING,
                              {output_, word * parts_.begin(job), word * parts_.size(job)});
            if (leaves_rays())
                program.bind_part(context_, job, DEFERRED_BINDING,
                                  {left_, word * left_parts_.begin(job), word * left_parts_.size(job)});
        }
    }
}

void VulkanSession::resize_output()
{
    const OutputParts parts = output_parts(words_per_ray(kernel_.task));
    if (parts == parts_) return;
    require_output_fits(parts.words(), max_buffer_bytes_);
    const std::uint64_t bytes = parts.words() * sizeof(std::uint32_t);
    left_parts_ = leaves_rays() ? output_parts(1) : OutputParts(); // DEFERRED_PIXELS fit in the guard words
    static_assert(DEFERRED_PIXELS <= 2 * GUARD_WORDS);
    const std::uint64_t deferred_bytes = left_parts_.words() * sizeof(std::uint32_t);
    output_ = Buffer(); // the old ones are freed first: both may not fit
    staging_ = Buffer();
    left_ = Buffer();
    parts_ = {};
    context_.run("making the output", bytes_ + bytes + deferred_bytes, [&] {
        if (deferred_bytes != 0) left_ = Buffer(context_, deferred_bytes, BufferUse::device);
        output_ = Buffer(context_, bytes, BufferUse::device);
        if (needs_staging(output_)) staging_ = Buffer(context_, bytes, BufferUse::read_back);
    });
    parts_ = parts;
    bind_output();
}

const vk::raii::CommandBuffer& VulkanSession::commands_for(std::size_t index)
{
    while (chunks_.size() <= index)
        chunks_.push_back({context_.make_commands(), context_.make_timestamps()});
    return chunks_[index].commands;
}

void VulkanSession::enqueue(std::span<const LaunchPiece> pieces, std::uint32_t passes)
{
    const vk::raii::CommandBuffer& commands = commands_for(enqueued_.size());
    const vk::raii::QueryPool& times = chunks_[enqueued_.size()].times;
    commands.begin({});
    if (std::exchange(fills_output_, false)) { // once: further passes add to a tally
        // In the kernel's own commands, so that the validation layers see both.
        commands.fillBuffer(output_.handle(), 0, VK_WHOLE_SIZE, POISON);
        record_barrier(context_, commands);
    }
    const std::uint32_t in_flight = launches_.in_flight();
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        order_.record_begin(commands, pass, in_flight);
        if (pass == 0) record_begin_time(commands, times);
        const std::vector<LaunchPiece> own = launches_.of_pass(pieces, pass);
        if (leaves_rays()) record_none_left(commands, own);
        for (const LaunchPiece& piece : own) {
            programs_.front().record(commands, piece.job);
            record_dispatches(commands, piece.params, piece.tiles);
        }
        if (leaves_rays()) record_left(commands, own);
        order_.record_end(commands, pass, in_flight);
    }
    record_end_time(commands, times);
    record_barrier(context_, commands);
    commands.end();
    context_.submit(commands);
    enqueued_.push_back({tile_count(pieces), passes});
}

void VulkanSession::record_dispatches(const vk::raii::CommandBuffer& commands, LaunchParams params,
                                      std::uint32_t tiles) const
{
    const auto record = [&](std::uint32_t run, std::uint32_t runs, std::uint32_t shares) {
        const std::uint32_t count = run * runs * shares;
        if (count == 0) return;
        programs_.front().push(commands, params);
        programs_.front().dispatch(commands, run, runs, shares);
        params.first_tile += count;
        tiles -= count;
    };
    if (const std::uint32_t shares = context_.found().shares; shares > 1) {
        record(tiles_of_run, tiles / (tiles_of_run * shares), shares);
        record(1, tiles / shares, shares);
    }
    record(tiles, 1, 1);
}

void VulkanSession::record_none_left(const vk::raii::CommandBuffer& commands, std::span<const LaunchPiece> pieces) const
{
    constexpr std::array<std::uint32_t, DEFERRED_PIXELS> none = {0, 1, 1, 0};
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (i == 0 || pieces[i - 1].job != pieces[i].job)
            commands.updateBuffer<std::uint32_t>(left_.handle(), left_parts_.begin(pieces[i].job) * sizeof(none[0]),
                                                 none);
    record_barrier(context_, commands);
}

/// The rays of a job's pieces are in one list.
void VulkanSession::record_left(const vk::raii::CommandBuffer& commands, std::span<const LaunchPiece> pieces) const
{
    record_barrier(context_, commands);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::size_t job = pieces[i].job;
        if (i > 0 && pieces[i - 1].job == job) continue;
        programs_.back().record(commands, job);
        programs_.back().push(commands, pieces[i].params);
        commands.dispatchIndirect(left_.handle(), left_parts_.begin(job) * sizeof(std::uint32_t));
    }
}

void VulkanSession::start(std::span<const TraceJob> jobs)
{
    context_.run("launching", output_bytes(), [&] {
        take_times(); // for a launch that nobody waited for
        const auto starts_inside = [](const TraceJob& job) { return job.start_tet != NO_TET; };
        if (starts_outside_ && std::ranges::any_of(jobs, starts_inside)) compile_starts_inside();
        resize_output();
        fills_output_ = true;
        launches_.start(
            launch_params(jobs, domain_, tile_height_, tet_parts_.log2_bytes), jobs.front().passes,
            [this](std::span<const LaunchPiece> pieces, std::uint32_t passes) { enqueue(pieces, passes); },
            [this] { take_times(); }, jobs.front().in_flight);
    });
}

double VulkanSession::wait()
{
    context_.run("waiting", output_bytes(), [&] { take_times(); });
    context_.check_validation("the next call");
    return launches_.seconds();
}

void VulkanSession::take_times()
{
    context_.finish();
    for (std::size_t i = 0; i < enqueued_.size(); ++i)
        launches_.took(enqueued_[i].tiles, enqueued_[i].passes, context_.seconds_of(chunks_[i].times));
    enqueued_.clear();
}

void VulkanSession::read_output(std::span<std::uint32_t> words)
{
    require_output_of_last_launch(words.size(), parts_.words());
    context_.run("reading back", output_bytes(), [&] {
        take_times(); // mapped memory is read directly: nothing may still be writing it
        vulkan::read_back(context_, output_, staging_, std::as_writable_bytes(words));
    });
    context_.check_validation("the next call");
}

} // namespace tetrace::vulkan
