#include "backends/vulkan/program.h"

#include "backends/vulkan/specialized.h"
#include "core/base/hash.h"

#include <array>

namespace tetrace::vulkan {

namespace {

using ShaderStage = vk::ShaderStageFlagBits;

const EmbeddedKernel& module_of(const ProgramId& id, std::string_view name)
{
    const EmbeddedKernel* const kernel = find_kernel(id.kernels, name);
    if (kernel == nullptr) throw Error(ErrorKind::internal, "vulkan lacks program " + std::string(name));
    return *kernel;
}

struct ShaderId {
    ShaderStage stage;
    std::string name;
};

/// In the order of the pipeline's stages. The first one has the buffers.
std::vector<ShaderId> shaders_of(const ProgramId& id)
{
    if (!id.is_ray_pipeline) return {{ShaderStage::eCompute, id.name}};
    return {
        {ShaderStage::eRaygenKHR, id.name}, {ShaderStage::eMissKHR, rt_miss}, {ShaderStage::eClosestHitKHR, rt_hit}};
}

ShaderStage first_stage(const ProgramId& id)
{
    return shaders_of(id).front().stage;
}

std::uint64_t key_of(const FoundDevice& device, const ProgramId& id)
{
    std::uint64_t key = hash_of(device.build_key + ";" + std::to_string(id.tile_height) +
                                (id.starts_outside ? ";outside" : "") + (id.selects_minima ? ";selects" : "") +
                                (id.stack_top != 0 ? ";stack " + std::to_string(id.stack_top) : "") +
                                (id.stack_entries != 0 ? ";entries " + std::to_string(id.stack_entries) : ""));
    for (const ShaderId& shader : shaders_of(id))
        key = hash_bytes(module_of(id, shader.name).bytes, key);
    return key;
}

vk::raii::PipelineCache make_cache(const Context& context, const ProgramCache& cache, std::uint64_t key)
{
    const auto kept = cache.find(key);
    auto info = vk::PipelineCacheCreateInfo{};
    if (kept) info.setInitialDataSize(kept->size()).setPInitialData(kept->data());
    return context.device().createPipelineCache(info);
}

/// The driver's feedback on making a pipeline: whether the cache had it.
bool is_hit(const vk::PipelineCreationFeedback& feedback)
{
    using Flag = vk::PipelineCreationFeedbackFlagBits;
    const auto hit = Flag::eValid | Flag::eApplicationPipelineCacheHit;
    return (feedback.flags & hit) == hit;
}

std::vector<vk::DescriptorSetLayoutBinding> bindings_of(const ProgramId& id)
{
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    const auto add = [&](std::uint32_t binding, vk::DescriptorType type) {
        bindings.push_back(vk::DescriptorSetLayoutBinding{}
                               .setBinding(binding)
                               .setDescriptorType(type)
                               .setDescriptorCount(1)
                               .setStageFlags(first_stage(id)));
    };
    for (const std::uint32_t binding : id.bindings)
        add(binding, vk::DescriptorType::eStorageBuffer);
    for (const TexelBinding& texels : id.texels)
        add(texels.binding, vk::DescriptorType::eUniformTexelBuffer);
    if (id.structure) add(*id.structure, vk::DescriptorType::eAccelerationStructureKHR);
    return bindings;
}

/// The values of a program's specialization constants, by ID.
std::vector<std::uint32_t> constants_of(const ProgramId& id)
{
    if (id.tile_height == 0) return {};
    return {id.tile_height, id.starts_outside ? 1u : 0u, id.selects_minima ? 1u : 0u, id.stack_top, id.stack_entries};
}

/// The stages of a pipeline that is being made, and their modules.
class Stages {
public:
    Stages(const vk::raii::Device& device, const ProgramId& id)
    {
        for (const ShaderId& shader : shaders_of(id))
            add(device, shader.stage, specialized(module_of(id, shader.name).bytes, constants_of(id)));
    }
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

    /// Valid while this lives.
    [[nodiscard]] const std::vector<vk::PipelineShaderStageCreateInfo>& infos() const { return infos_; }

private:
    void add(const vk::raii::Device& device, ShaderStage stage, const std::vector<std::uint32_t>& code)
    {
        modules_.push_back(device.createShaderModule(vk::ShaderModuleCreateInfo{}.setCode(code)));
        infos_.push_back(
            vk::PipelineShaderStageCreateInfo{}.setStage(stage).setModule(*modules_.back()).setPName("main"));
    }

    std::vector<vk::raii::ShaderModule> modules_;
    std::vector<vk::PipelineShaderStageCreateInfo> infos_;
};

/// A group for each of the three stages, as ShaderTable has them.
vk::raii::Pipeline compile_rays(const vk::raii::Device& device, const ProgramId& id,
                                const vk::raii::PipelineLayout& layout, const vk::raii::PipelineCache& cache,
                                vk::RayTracingPipelineCreateInfoKHR info)
{
    using Type = vk::RayTracingShaderGroupTypeKHR;
    constexpr std::uint32_t none = VK_SHADER_UNUSED_KHR;
    const std::array groups = {vk::RayTracingShaderGroupCreateInfoKHR(Type::eGeneral, 0, none, none, none),
                               vk::RayTracingShaderGroupCreateInfoKHR(Type::eGeneral, 1, none, none, none),
                               vk::RayTracingShaderGroupCreateInfoKHR(Type::eTrianglesHitGroup, none, 2, none, none)};
    const Stages stages(device, id);
    info.setStages(stages.infos()).setGroups(groups).setMaxPipelineRayRecursionDepth(1).setLayout(*layout);
    return device.createRayTracingPipelineKHR(nullptr, cache, info);
}

} // namespace

vk::raii::DescriptorSetLayout make_set_layout(const vk::raii::Device& device, const ProgramId& id)
{
    const auto bindings = bindings_of(id);
    return device.createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo{}.setBindings(bindings));
}

vk::raii::PipelineLayout make_pipeline_layout(const vk::raii::Device& device, const ProgramId& id,
                                              const vk::raii::DescriptorSetLayout& set_layout)
{
    const std::array sets = {*set_layout};
    const auto push = vk::PushConstantRange{}.setStageFlags(first_stage(id)).setSize(id.push_constant_bytes);
    auto info = vk::PipelineLayoutCreateInfo{}.setSetLayouts(sets);
    if (id.push_constant_bytes != 0) info.setPushConstantRanges(push);
    return device.createPipelineLayout(info);
}

vk::raii::Pipeline compile(const vk::raii::Device& device, const ProgramId& id, const vk::raii::PipelineLayout& layout,
                           vk::Optional<const vk::raii::PipelineCache> cache, vk::ComputePipelineCreateInfo info)
{
    const Stages stages(device, id);
    return device.createComputePipeline(cache, info.setStage(stages.infos().front()).setLayout(*layout));
}

Program::Program(const Context& context, const ProgramId& id, const ProgramCache& cache)
{
    context.run("compiling " + id.name, 0, [&] {
        make_layout(context, id);
        make_pipeline(context, id, cache);
    });
}

void Program::make_layout(const Context& context, const ProgramId& id)
{
    bindings_ = bindings_of(id);
    set_layout_ = make_set_layout(context.device(), id);
    layout_ = make_pipeline_layout(context.device(), id, set_layout_);
    set_ = make_set(context);
}

Program::Set Program::make_set(const Context& context) const
{
    Set set;
    if (bindings_.empty()) return set;
    std::vector<vk::DescriptorPoolSize> sizes;
    for (const auto& binding : bindings_)
        sizes.emplace_back(binding.descriptorType, 1);
    set.pool = context.device().createDescriptorPool(vk::DescriptorPoolCreateInfo{}
                                                         .setFlags(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet)
                                                         .setMaxSets(1)
                                                         .setPoolSizes(sizes));
    const std::array layouts = {*set_layout_};
    const auto allocation = vk::DescriptorSetAllocateInfo{}.setDescriptorPool(*set.pool).setSetLayouts(layouts);
    set.handle = std::move(vk::raii::DescriptorSets(context.device(), allocation).front());
    return set;
}

Program::Set Program::make_copied_set(const Context& context) const
{
    Set set = make_set(context);
    std::vector<vk::CopyDescriptorSet> copies;
    for (const auto& binding : bindings_)
        copies.push_back(vk::CopyDescriptorSet{}
                             .setSrcSet(*set_.handle)
                             .setSrcBinding(binding.binding)
                             .setDstSet(*set.handle)
                             .setDstBinding(binding.binding)
                             .setDescriptorCount(1));
    context.device().updateDescriptorSets({}, copies);
    return set;
}

void Program::make_pipeline(const Context& context, const ProgramId& id, const ProgramCache& cache)
{
    vk::PipelineCreationFeedback feedback;
    std::vector<vk::PipelineCreationFeedback> stage_feedbacks(shaders_of(id).size());
    auto feedbacks = vk::PipelineCreationFeedbackCreateInfo{}
                         .setPPipelineCreationFeedback(&feedback)
                         .setPipelineStageCreationFeedbacks(stage_feedbacks);
    const void* const next = context.found().tells_cache_hits ? &feedbacks : nullptr;
    const std::uint64_t key = key_of(context.found(), id);
    const vk::raii::PipelineCache pipelines = make_cache(context, cache, key);
    pipeline_ = id.is_ray_pipeline
                    ? compile_rays(context.device(), id, layout_, pipelines,
                                   vk::RayTracingPipelineCreateInfoKHR{}.setPNext(next))
                    : compile(context.device(), id, layout_, pipelines, vk::ComputePipelineCreateInfo{}.setPNext(next));
    is_cached_ = is_hit(feedback);
    if (!is_cached_) cache.keep(key, pipelines.getData());
    if (id.is_ray_pipeline) table_.emplace(context, pipeline_);
    group_items_ = TILE_WIDTH * id.tile_height;
}

void Program::bind(const Context& context, std::uint32_t binding, const Buffer& buffer) const
{
    bind_buffer(context, set_, binding, {buffer, 0, VK_WHOLE_SIZE});
}

void Program::bind_part(const Context& context, std::size_t set, std::uint32_t binding, const BufferPart& part)
{
    while (other_sets_.size() < set)
        other_sets_.push_back(make_copied_set(context));
    bind_buffer(context, this->set(set), binding, part);
}

void Program::bind_buffer(const Context& context, const Set& set, std::uint32_t binding, const BufferPart& part)
{
    const auto info =
        vk::DescriptorBufferInfo{}.setBuffer(part.buffer.handle()).setOffset(part.offset).setRange(part.bytes);
    const auto write = vk::WriteDescriptorSet{}
                           .setDstSet(*set.handle)
                           .setDstBinding(binding)
                           .setDescriptorType(vk::DescriptorType::eStorageBuffer)
                           .setBufferInfo(info);
    context.device().updateDescriptorSets(write, {});
}

void Program::bind_texels(const Context& context, const TexelBinding& texels, const Buffer& buffer)
{
    const auto info =
        vk::BufferViewCreateInfo{}.setBuffer(buffer.handle()).setFormat(texels.format).setRange(VK_WHOLE_SIZE);
    views_.insert_or_assign(texels.binding, context.device().createBufferView(info));
    const vk::BufferView view = *views_.at(texels.binding);
    const auto write = vk::WriteDescriptorSet{}
                           .setDstSet(*set_.handle)
                           .setDstBinding(texels.binding)
                           .setDescriptorType(vk::DescriptorType::eUniformTexelBuffer)
                           .setTexelBufferView(view);
    context.device().updateDescriptorSets(write, {});
}

void Program::bind_structure(const Context& context, std::uint32_t binding,
                             vk::AccelerationStructureKHR structure) const
{
    const auto info = vk::WriteDescriptorSetAccelerationStructureKHR{}.setAccelerationStructures(structure);
    const auto write = vk::WriteDescriptorSet{}
                           .setDstSet(*set_.handle)
                           .setDstBinding(binding)
                           .setDescriptorType(vk::DescriptorType::eAccelerationStructureKHR)
                           .setDescriptorCount(1)
                           .setPNext(&info);
    context.device().updateDescriptorSets(write, {});
}

void Program::record(const vk::raii::CommandBuffer& commands, std::size_t set) const
{
    commands.bindPipeline(bind_point(), *pipeline_);
    if (!bindings_.empty()) commands.bindDescriptorSets(bind_point(), *layout_, 0, *this->set(set).handle, {});
}

void Program::push(const vk::raii::CommandBuffer& commands, const LaunchParams& params) const
{
    const ShaderStage stage = table_ ? ShaderStage::eRaygenKHR : ShaderStage::eCompute;
    commands.pushConstants<LaunchParams>(*layout_, stage, 0, params);
}

void Program::dispatch(const vk::raii::CommandBuffer& commands, std::uint32_t x, std::uint32_t y, std::uint32_t z) const
{
    if (table_)
        table_->record_launch(commands, x * group_items_, y, z);
    else
        commands.dispatch(x, y, z);
}

} // namespace tetrace::vulkan
