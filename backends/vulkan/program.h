#pragma once

#include "backends/vulkan/buffer.h"
#include "backends/vulkan/kernels.h"
#include "backends/vulkan/rt/shader_table.h"
#include "core/device/launch.h"
#include "core/device/program_cache.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace::vulkan {

/// A binding through which a shader reads a buffer as texels.
struct TexelBinding {
    std::uint32_t binding;
    vk::Format format;
};

/// A part of a buffer, in bytes.
struct BufferPart {
    const Buffer& buffer;
    std::uint64_t offset, bytes;
};

/// What decides a program.
struct ProgramId {
    std::string name;
    std::vector<std::uint32_t> bindings = {}; ///< of its storage buffers
    std::vector<TexelBinding> texels = {};
    std::optional<std::uint32_t> structure = {}; ///< binding of a BVH that the driver has built
    std::uint32_t push_constant_bytes = 0;       ///< 0: none
    unsigned tile_height = 0;                    ///< the height of its work groups; 0: as the module says
    bool is_ray_pipeline = false;                ///< the name is that of its ray generation shader
    bool starts_outside = false;                 ///< no ray starts in a tet
    bool selects_minima = false;                 ///< as FoundDevice has it
    std::uint32_t stack_top = 0;                 ///< as FoundDevice has it
    std::uint32_t stack_entries = 0;             ///< of a ray's stack, if the scene is read as texels; 0: the maximum
    std::span<const EmbeddedKernel> kernels = embedded_kernels(); ///< where the name is looked up
};

// The steps from an id to a pipeline, for those who need no queue.
[[nodiscard]] vk::raii::DescriptorSetLayout make_set_layout(const vk::raii::Device& device, const ProgramId& id);
[[nodiscard]] vk::raii::PipelineLayout make_pipeline_layout(const vk::raii::Device& device, const ProgramId& id,
                                                            const vk::raii::DescriptorSetLayout& set_layout);
/// id: of a compute shader. info: flags and further structures; stage and layout are set here. Throws Error{internal}
/// where id names no program.
[[nodiscard]] vk::raii::Pipeline compile(const vk::raii::Device& device, const ProgramId& id,
                                         const vk::raii::PipelineLayout& layout,
                                         vk::Optional<const vk::raii::PipelineCache> cache,
                                         vk::ComputePipelineCreateInfo info);

/// A pipeline with its buffers: of a compute shader, or of ray tracing.
class Program {
public:
    /// Throws Error{driver} if the driver cannot compile it.
    Program(const Context& context, const ProgramId& id, const ProgramCache& cache);

    /// Whether the driver did not need to compile; false if it does not say.
    [[nodiscard]] bool is_cached() const { return is_cached_; }
    /// Every binding needs a buffer before record() is called; not while commands that use the program run.
    void bind(const Context& context, std::uint32_t binding, const Buffer& buffer) const;
    /// Binds a part of a buffer, in bytes, in one of the program's sets of buffers. Number 0 is the set that bind()
    /// and its like change; each other one is made as a copy of it.
    void bind_part(const Context& context, std::size_t set, std::uint32_t binding, const BufferPart& part);
    /// Keeps only set 0.
    void forget_other_sets() { other_sets_.clear(); }
    /// The previously bound buffer must live until then.
    void bind_texels(const Context& context, const TexelBinding& texels, const Buffer& buffer);
    /// The structure must live as long as the program runs.
    void bind_structure(const Context& context, std::uint32_t binding, vk::AccelerationStructureKHR structure) const;
    /// Records that the program and its buffers are what a dispatch runs.
    /// set: of its buffers.
    void record(const vk::raii::CommandBuffer& commands, std::size_t set = 0) const;
    /// Records the parameters of what is dispatched next.
    void push(const vk::raii::CommandBuffer& commands, const LaunchParams& params) const;
    /// Records this many work-groups; for a ray-tracing pipeline, which has none, the invocations of this many.
    void dispatch(const vk::raii::CommandBuffer& commands, std::uint32_t x, std::uint32_t y, std::uint32_t z) const;

private:
    [[nodiscard]] vk::PipelineBindPoint bind_point() const
    {
        return table_ ? vk::PipelineBindPoint::eRayTracingKHR : vk::PipelineBindPoint::eCompute;
    }
    /// Buffers that a dispatch is given.
    struct Set {
        vk::raii::DescriptorPool pool{nullptr};
        vk::raii::DescriptorSet handle{nullptr}; ///< null without bindings
    };
    void make_layout(const Context& context, const ProgramId& id);
    [[nodiscard]] Set make_set(const Context& context) const;
    [[nodiscard]] Set make_copied_set(const Context& context) const;
    [[nodiscard]] const Set& set(std::size_t number) const { return number == 0 ? set_ : other_sets_[number - 1]; }
    static void bind_buffer(const Context& context, const Set& set, std::uint32_t binding, const BufferPart& part);
    void make_pipeline(const Context& context, const ProgramId& id, const ProgramCache& cache);

    vk::raii::DescriptorSetLayout set_layout_{nullptr};
    vk::raii::PipelineLayout layout_{nullptr};
    std::vector<vk::DescriptorSetLayoutBinding> bindings_;
    Set set_;
    std::vector<Set> other_sets_;                         // from number 1 on
    std::map<std::uint32_t, vk::raii::BufferView> views_; // by binding
    vk::raii::Pipeline pipeline_{nullptr};
    std::optional<ShaderTable> table_; // of ray-tracing pipelines
    std::uint32_t group_items_ = 0;    // of one that is a tile
    bool is_cached_ = false;
};

} // namespace tetrace::vulkan
