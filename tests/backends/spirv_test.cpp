// The SPIR-V that devices get: nothing in exact modules may be contracted, and data is at the offsets that the host
// uses.
#include "backends/vulkan/kernels.h"
#include "backends/vulkan/specialized.h"
#include "core/base/error.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"
#include "tests/backends/spirv/module.h"
#include "tests/backends/spirv/twins.h"

#include <array>
#include <cstddef>
#include <gtest/gtest.h>

using namespace tetrace;

using spirv::Array;
using spirv::Member;
using spirv::Module;

namespace {

bool is_exact(std::string_view name)
{
    return name.find("_exact") != std::string_view::npos;
}

bool is_bvh(std::string_view name)
{
    return name.starts_with("single_");
}

bool is_probe(std::string_view name)
{
    return name.starts_with("probe");
}

/// What traces by a driver's BVH reads no scene of ours.
bool is_drivers(std::string_view name)
{
    return name.starts_with("single_rt_");
}

/// Portable kernels and probes; not the empty shader.
std::vector<EmbeddedKernel> modules()
{
    std::vector<EmbeddedKernel> found;
    for (const EmbeddedKernel& kernel : vulkan::embedded_kernels())
        if (kernel.name != "empty" && !is_drivers(kernel.name)) found.push_back(kernel);
    return found;
}

bool takes_rays(std::string_view name)
{
    return name.find("_trace") == std::string_view::npos;
}

/// A kernel's module is called method_layout_math_variant.
Layout layout_of_module(std::string_view name)
{
    for (const KernelId& kernel : all_kernels())
        if (name.starts_with(std::string(name_of(kernel.method)).append("_").append(name_of(kernel.layout)) + "_"))
            return kernel.layout;
    throw std::runtime_error("no kernel is called " + std::string(name));
}

/// What a kernel's storage buffers must be: its layout's arrays (core/device/scene_buffers.h) and
/// kernels/layouts/layout.h.
std::map<std::string, Array> expected_arrays(std::string_view module, bool in_parts)
{
    std::map<std::string, Array> arrays;
    for (const SceneArray& array : scene_arrays(layout_of_module(module)))
        arrays[array.name] = {array.binding, array.element_bytes, false};
    arrays["output_words"] = {OUTPUT_BINDING, 4, true};
    if (takes_rays(module)) arrays["rays"] = {RAYS_BINDING, sizeof(Quad), false};
    for (std::uint32_t part = 1; in_parts && part < MAX_TET_PARTS; ++part) {
        arrays["tet_words_" + std::to_string(part)] = {SECOND_PART_BINDING - 1 + part, 4, false};
        arrays["tet_quads_" + std::to_string(part)] = {SECOND_PART_BINDING - 1 + part, 16, false};
    }
    return arrays;
}

/// What a kernel's texel buffers must be: words at their array's binding, quads FIRST_QUADS_BINDING after it.
std::map<std::string, std::uint32_t> expected_texels(std::string_view module)
{
    std::map<std::string, std::uint32_t> bindings;
    for (const SceneArray& array : scene_arrays(layout_of_module(module)))
        bindings[array.name] = array.binding + (array.element_bytes == sizeof(Quad) ? FIRST_QUADS_BINDING : 0u);
    if (takes_rays(module)) bindings["rays"] = FIRST_QUADS_BINDING + RAYS_BINDING;
    return bindings;
}

/// What the push constants must be: core/device/launch.h, word for word.
std::vector<Member> expected_push_constants()
{
    std::vector<Member> members;
    const auto add_vector = [&](const std::string& name, std::size_t offset) {
        for (const std::string axis : {"x", "y", "z"}) {
            members.push_back({"launch." + name + "." + axis, static_cast<std::uint32_t>(offset), "float"});
            offset += sizeof(float);
        }
    };
    const auto add = [&](const std::string& path, std::size_t offset) {
        members.push_back({"launch." + path, static_cast<std::uint32_t>(offset), "uint"});
    };
    add_vector("trace.origin", offsetof(LaunchParams, origin));
    add_vector("trace.corner", offsetof(LaunchParams, corner));
    add_vector("trace.step_x", offsetof(LaunchParams, step_x));
    add_vector("trace.step_y", offsetof(LaunchParams, step_y));
    add("trace.width", offsetof(LaunchParams, width));
    add("trace.height", offsetof(LaunchParams, height));
    add("trace.start_tet", offsetof(LaunchParams, start_tet));
    add("trace.max_steps", offsetof(LaunchParams, max_steps));
    add("trace.any_hit", offsetof(LaunchParams, any_hit));
    for (std::size_t i = 0; i < 4; ++i)
        add("trace.start_v" + std::to_string(i), offsetof(LaunchParams, start.vertices) + i * sizeof(std::uint32_t));
    add("trace.start_neighbour", offsetof(LaunchParams, start.neighbour));
    add("divisions", offsetof(LaunchParams, divisions));
    add("first_tile", offsetof(LaunchParams, first_tile));
    add("tile_height", offsetof(LaunchParams, tile_height));
    add("part_log2", offsetof(LaunchParams, part_log2));
    add_vector("domain.low", offsetof(LaunchParams, domain_low));
    add_vector("domain.high", offsetof(LaunchParams, domain_high));
    return members;
}

Module twin()
{
    return Module(find_kernel(twins::embedded_kernels(), "vectors")->bytes);
}

} // namespace

TEST(Spirv, no_operation_of_an_exact_module_may_be_contracted_but_that_of_boxes)
{
    std::size_t checked = 0;
    for (const EmbeddedKernel& kernel : modules()) {
        if (!is_exact(kernel.name)) continue;
        const Module module(kernel.bytes);
        EXPECT_GE(module.rounding_operations(), is_probe(kernel.name)                             ? 5u
                                                : kernel.name.find("_search") != kernel.name.npos ? 15u
                                                                                                  : 30u)
            << kernel.name;
        const std::uint32_t of_multiply_add = is_bvh(kernel.name) ? 2 : 0; // a product and a sum, in one function
        EXPECT_EQ(module.contractible_operations(), of_multiply_add) << kernel.name;
        ++checked;
    }
    EXPECT_GE(checked, 23u); // maria on two layouts, seven variants each; two BVHs, four each; the probe
}

TEST(Spirv, the_same_source_without_precise_would_be_found)
{
    for (const EmbeddedKernel& kernel : modules()) { // math mode fast is the text with PRECISE empty
        if (is_exact(kernel.name)) continue;
        const Module module(kernel.bytes);
        EXPECT_EQ(module.contractible_operations(), module.rounding_operations()) << kernel.name;
        EXPECT_GT(module.contractible_operations(), 0u) << kernel.name;
    }
}

TEST(Spirv, storage_buffers_are_those_of_scene_arrays_and_layout)
{
    for (const EmbeddedKernel& kernel : modules()) {
        if (is_probe(kernel.name)) continue;
        const Module module(kernel.bytes);
        if (kernel.name.ends_with("_texels")) {
            EXPECT_EQ(module.texels(), expected_texels(kernel.name)) << kernel.name;
            std::map<std::string, Array> arrays = {{"output_words", {OUTPUT_BINDING, 4, true}}};
            if (kernel.name.find("_leaves_") != kernel.name.npos || kernel.name.find("_left_") != kernel.name.npos)
                arrays["deferred_words"] = {DEFERRED_BINDING, 4, true};
            EXPECT_EQ(module.arrays(), arrays) << kernel.name;
        } else {
            EXPECT_EQ(module.arrays(), expected_arrays(kernel.name, kernel.name.ends_with("_parts"))) << kernel.name;
            EXPECT_TRUE(module.texels().empty());
        }
    }
}

TEST(Spirv, push_constants_are_launch_params_word_for_word)
{
    for (const EmbeddedKernel& kernel : modules()) {
        if (is_probe(kernel.name)) continue;
        EXPECT_EQ(Module(kernel.bytes).push_constants(), expected_push_constants()) << kernel.name;
        EXPECT_TRUE(Module(kernel.bytes).has_specialization_constant(0)) << kernel.name << ": the tile's height";
    }
}

TEST(Spirv, nothing_depends_on_a_constant_that_has_its_value)
{
    const std::array<std::uint32_t, 5> values = {8, 1, 1, 8, 20};
    for (const EmbeddedKernel& kernel : vulkan::embedded_kernels()) {
        const auto words = vulkan::specialized(kernel.bytes, values);
        const Module before(kernel.bytes), after(std::as_bytes(std::span(words)));
        EXPECT_EQ(after.specialized_instructions(), 0u) << kernel.name;
        EXPECT_FALSE(after.has_specialization_constant(0)) << kernel.name << ": only such a constant may have an ID";
        EXPECT_EQ(after.rounding_operations(), before.rounding_operations()) << kernel.name;
        EXPECT_EQ(after.contractible_operations(), before.contractible_operations()) << kernel.name;
    }
}

TEST(Spirv, constants_are_replaced_by_their_values_and_so_is_what_is_computed_of_them)
{
    const auto op = [](std::uint32_t words, spv::Op code) { return words << 16 | code; };
    const std::vector<std::uint32_t> head = {spv::MagicNumber, 0x10300, 0, 20, 0},
                                     ids[] = {{op(4, spv::OpDecorate), 10, spv::DecorationSpecId, 0},
                                              {op(4, spv::OpDecorate), 11, spv::DecorationSpecId, 1},
                                              {op(4, spv::OpDecorate), 12, spv::DecorationSpecId, 7}};
    const std::vector<std::uint32_t> types = {
        op(2, spv::OpTypeBool), 1, op(4, spv::OpTypeInt), 2, 32, 0, op(4, spv::OpTypeVector), 3, 2, 2};
    std::vector<std::uint32_t> module = head, wanted = head;
    const auto add = [](std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& words) {
        to.insert(to.end(), words.begin(), words.end());
    };
    for (const auto& id : ids)
        add(module, id);
    add(wanted, ids[2]);
    add(module, types);
    add(wanted, types);
    const std::vector<std::uint32_t> kept = {
        op(4, spv::OpSpecConstant), 2, 12, 5, op(6, spv::OpSpecConstantOp), 2, 19, spv::OpIMul, 10, 12};
    add(module, {op(4, spv::OpSpecConstant),
                 2,
                 10,
                 1,
                 op(3, spv::OpSpecConstantFalse),
                 1,
                 11,
                 op(5, spv::OpSpecConstantComposite),
                 3,
                 13,
                 10,
                 10,
                 op(6, spv::OpSpecConstantOp),
                 2,
                 14,
                 spv::OpCompositeExtract,
                 13,
                 1,
                 op(6, spv::OpSpecConstantOp),
                 2,
                 15,
                 spv::OpIMul,
                 14,
                 10,
                 op(6, spv::OpSpecConstantOp),
                 1,
                 16,
                 spv::OpULessThan,
                 10,
                 15,
                 op(7, spv::OpSpecConstantOp),
                 2,
                 17,
                 spv::OpSelect,
                 16,
                 15,
                 10,
                 op(6, spv::OpSpecConstantOp),
                 1,
                 18,
                 spv::OpIEqual,
                 10,
                 15});
    add(wanted, {op(4, spv::OpConstant),
                 2,
                 10,
                 6,
                 op(3, spv::OpConstantTrue),
                 1,
                 11,
                 op(5, spv::OpConstantComposite),
                 3,
                 13,
                 10,
                 10,
                 op(4, spv::OpConstant),
                 2,
                 14,
                 6,
                 op(4, spv::OpConstant),
                 2,
                 15,
                 36,
                 op(3, spv::OpConstantTrue),
                 1,
                 16,
                 op(4, spv::OpConstant),
                 2,
                 17,
                 36,
                 op(3, spv::OpConstantFalse),
                 1,
                 18});
    add(module, kept);
    add(wanted, kept);
    const std::array<std::uint32_t, 2> values = {6, 1};
    EXPECT_EQ(vulkan::specialized(std::as_bytes(std::span(module)), values), wanted);
    module.pop_back();
    EXPECT_THROW(static_cast<void>(vulkan::specialized(std::as_bytes(std::span(module)), values)), Error);
}

TEST(Spirv, what_traces_by_a_drivers_bvh_gets_the_same_launches_and_makes_the_same_rays)
{
    std::size_t checked = 0;
    for (const EmbeddedKernel& kernel : vulkan::embedded_kernels()) {
        if (!is_drivers(kernel.name) || kernel.name == vulkan::rt_miss || kernel.name == vulkan::rt_hit) continue;
        const Module module(kernel.bytes);
        std::map<std::string, Array> arrays = {{"output_words", {OUTPUT_BINDING, 4, true}}};
        if (takes_rays(kernel.name)) arrays["rays"] = {RAYS_BINDING, sizeof(Quad), false};
        EXPECT_EQ(module.arrays(), arrays) << kernel.name;
        EXPECT_EQ(module.texels(), (std::map<std::string, std::uint32_t>{{"scene", 0}})) << "the top level";
        EXPECT_EQ(module.push_constants(), expected_push_constants()) << kernel.name;
        EXPECT_TRUE(module.has_specialization_constant(0)) << kernel.name << ": the tile's height";
        EXPECT_EQ(module.contractible_operations(), 0u) << kernel.name;
        ++checked;
    }
    EXPECT_EQ(checked, 4u) << "by ray queries and through a pipeline, for both tasks";
}

TEST(Spirv, what_a_pipeline_runs_for_misses_and_hits_reads_no_buffer_and_computes_nothing)
{
    for (const char* const name : {vulkan::rt_miss, vulkan::rt_hit}) {
        const EmbeddedKernel* const kernel = find_kernel(vulkan::embedded_kernels(), name);
        ASSERT_NE(kernel, nullptr) << name;
        const Module module(kernel->bytes);
        EXPECT_TRUE(module.arrays().empty() && module.push_constants().empty()) << name;
        EXPECT_EQ(module.rounding_operations(), 0u) << name;
    }
}

TEST(Spirv, vectors_of_three_and_quads_read_as_words_would_be_found)
{
    EXPECT_NE(twin().push_constants(), expected_push_constants());
    ASSERT_FALSE(twin().push_constants().empty());
    EXPECT_EQ(twin().push_constants().front().type, "vector");
    EXPECT_NE(twin().arrays().at("triangles"), expected_arrays("maria_tet80_exact_trace", false).at("triangles"));
    EXPECT_EQ(twin().arrays().at("output_words"), expected_arrays("maria_tet80_exact_trace", false).at("output_words"));
}

TEST(Spirv, damaged_modules_are_refused)
{
    const auto bytes = modules().front().bytes;
    EXPECT_THROW(Module{bytes.first(16)}, std::runtime_error);
    EXPECT_THROW(Module{bytes.subspan(4)}, std::runtime_error);
    EXPECT_THROW(Module{bytes.first(24)}, std::runtime_error) << "in its first instruction";
}
