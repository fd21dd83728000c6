#include "backends/vulkan/program.h"

#include "core/base/hash.h"

#include <array>

namespace tetrace::vulkan {

namespace {

std::uint64_t key_of(const FoundDevice& device, const ProgramId& id, std::span<const std::byte> code)
{
    return hash_bytes(code, hash_of(device.build_key + ";" + std::to_string(id.tile_height) +
                                    (id.starts_outside ? ";outside" : "") + (id.selects_minima ? ";selects" : "") +
                                    (id.stack_top != 0 ? ";stack " + std::to_string(id.stack_top) : "")));
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
                               .setStageFlags(vk::ShaderStageFlagBits::eCompute));
    };
    for (const std::uint32_t binding : id.bindings)
        add(binding, vk::DescriptorType::eStorageBuffer);
    for (const TexelBinding& texels : id.texels)
        add(texels.binding, vk::DescriptorType::eUniformTexelBuffer);
    if (id.structure) add(*id.structure, vk::DescriptorType::eAccelerationStructureKHR);
    return bindings;
}

const EmbeddedKernel& module_of(const ProgramId& id)
{
    const EmbeddedKernel* const kernel = find_kernel(id.kernels, id.name);
    if (kernel == nullptr) throw Error(ErrorKind::internal, "vulkan has no program " + id.name);
    return *kernel;
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
    const auto push =
        vk::PushConstantRange{}.setStageFlags(vk::ShaderStageFlagBits::eCompute).setSize(id.push_constant_bytes);
    auto info = vk::PipelineLayoutCreateInfo{}.setSetLayouts(sets);
    if (id.push_constant_bytes != 0) info.setPushConstantRanges(push);
    return device.createPipelineLayout(info);
}

vk::raii::Pipeline compile(const vk::raii::Device& device, const ProgramId& id, const vk::raii::PipelineLayout& layout,
                           vk::Optional<const vk::raii::PipelineCache> cache, vk::ComputePipelineCreateInfo info)
{
    const EmbeddedKernel& kernel = module_of(id);
    // Embedded bytes are aligned for words.
    const vk::raii::ShaderModule module =
        device.createShaderModule(vk::ShaderModuleCreateInfo{}
                                      .setCodeSize(kernel.bytes.size())
                                      .setPCode(reinterpret_cast<const std::uint32_t*>(kernel.bytes.data())));
    const std::array<std::uint32_t, 4> values = {id.tile_height, id.starts_outside ? VK_TRUE : VK_FALSE,
                                                 id.selects_minima ? VK_TRUE : VK_FALSE, id.stack_top};
    std::array<vk::SpecializationMapEntry, values.size()> entries;
    for (std::uint32_t i = 0; i < entries.size(); ++i)
        entries[i].setConstantID(i).setOffset(i * sizeof(values[0])).setSize(sizeof(values[0]));
    const auto constants =
        vk::SpecializationInfo{}.setMapEntries(entries).setDataSize(sizeof(values)).setPData(values.data());
    auto stage = vk::PipelineShaderStageCreateInfo{}
                     .setStage(vk::ShaderStageFlagBits::eCompute)
                     .setModule(*module)
                     .setPName("main");
    if (id.tile_height != 0) stage.setPSpecializationInfo(&constants);
    return device.createComputePipeline(cache, info.setStage(stage).setLayout(*layout));
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
    const auto bindings = bindings_of(id);
    set_layout_ = make_set_layout(context.device(), id);
    layout_ = make_pipeline_layout(context.device(), id, set_layout_);
    if (bindings.empty()) return;
    std::vector<vk::DescriptorPoolSize> sizes;
    for (const auto& binding : bindings)
        sizes.emplace_back(binding.descriptorType, 1);
    pool_ = context.device().createDescriptorPool(vk::DescriptorPoolCreateInfo{}
                                                      .setFlags(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet)
                                                      .setMaxSets(1)
                                                      .setPoolSizes(sizes));
    const std::array sets = {*set_layout_};
    const auto allocation = vk::DescriptorSetAllocateInfo{}.setDescriptorPool(*pool_).setSetLayouts(sets);
    set_ = std::move(vk::raii::DescriptorSets(context.device(), allocation).front());
}

void Program::make_pipeline(const Context& context, const ProgramId& id, const ProgramCache& cache)
{
    vk::PipelineCreationFeedback feedback, stage_feedback;
    auto feedbacks = vk::PipelineCreationFeedbackCreateInfo{}
                         .setPPipelineCreationFeedback(&feedback)
                         .setPipelineStageCreationFeedbackCount(1)
                         .setPPipelineStageCreationFeedbacks(&stage_feedback);
    vk::ComputePipelineCreateInfo info;
    if (context.found().tells_cache_hits) info.setPNext(&feedbacks);
    const std::uint64_t key = key_of(context.found(), id, module_of(id).bytes);
    const vk::raii::PipelineCache pipelines = make_cache(context, cache, key);
    pipeline_ = compile(context.device(), id, layout_, pipelines, info);
    is_cached_ = is_hit(feedback);
    if (!is_cached_) cache.keep(key, pipelines.getData());
}

void Program::bind(const Context& context, std::uint32_t binding, const Buffer& buffer) const
{
    const auto info = vk::DescriptorBufferInfo{}.setBuffer(buffer.handle()).setRange(VK_WHOLE_SIZE);
    const auto write = vk::WriteDescriptorSet{}
                           .setDstSet(*set_)
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
                           .setDstSet(*set_)
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
                           .setDstSet(*set_)
                           .setDstBinding(binding)
                           .setDescriptorType(vk::DescriptorType::eAccelerationStructureKHR)
                           .setDescriptorCount(1)
                           .setPNext(&info);
    context.device().updateDescriptorSets(write, {});
}

void Program::record(const vk::raii::CommandBuffer& commands) const
{
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
    if (*set_) commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *set_, {});
}

} // namespace tetrace::vulkan
