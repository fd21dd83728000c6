#include "backends/opencl/launch_case.h"

#include "backends/opencl/kernels.h"
#include "backends/opencl/probe.h"
#include "core/base/files.h"
#include "core/device/scene_buffers.h"

#include <algorithm>

namespace tetrace::opencl {

namespace {

LaunchCase case_of(const FoundDevice& device, const ProgramId& id, const std::string& entry, unsigned items,
                   std::uint32_t groups = 1)
{
    const auto text = [](std::string_view name) {
        const EmbeddedKernel* const kernel = find_kernel(embedded_kernels(), name);
        if (kernel == nullptr) throw Error(ErrorKind::internal, "opencl lacks program " + std::string(name));
        return std::string(kernel->text());
    };
    LaunchCase made;
    made.program = {id.source + ".cl", "the program, OpenCL C with its includes resolved", {}, text(id.source)};
    made.host = {"run_case.c", "a host in C, whose head says how to build and run it",
                 "cc -O1 -o run_case run_case.c -l:libOpenCL.so.1 && ./run_case", text("run_case")};
    made.lines = {"OPTIONS \"" + build_options(device, id) + "\"", "ENTRY \"" + entry + "\"",
                  "GROUP " + std::to_string(items), "GROUPS " + std::to_string(groups)};
    return made;
}

template <class Value>
LaunchCase::Input input(const char* kind, cl_uint argument, const std::string& name, const std::string& what,
                        std::span<const Value> values)
{
    const auto bytes = std::as_bytes(values);
    return {kind + (", " + std::to_string(argument)),
            {name + ".bin", what, {}, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())}};
}

} // namespace

LaunchCase tile_case(const Device& device, const KernelId& kernel, const PackedScene& scene, const LaunchParams& launch,
                     std::span<const Quad> rays, const std::filesystem::path& program_file)
{
    FoundDevice found;
    found.facts = device;
    found.stack_top = device.kind == DeviceKind::gpu ? STACK_TOP_OF_GPUS : 0;
    const bool starts_outside =
        kernel.task == Task::trace && kernel.structure == Structure::cdt && launch.start_tet == NO_TET;
    const std::string defines = defines_of(kernel, launch.tile_height, false, starts_outside, found.stack_top);
    LaunchCase made =
        case_of(found, {source_name(kernel), kernel.math, defines}, "run_image", TILE_WIDTH * launch.tile_height);
    if (!program_file.empty()) made.program.bytes = required_bytes(program_file);
    const std::uint32_t end_tile = launch.first_tile + 1, counter = 0;
    made.inputs = {
        input("value", launch_argument, "launch", "LaunchParams of the program", std::span(&launch, 1)),
        input("value", end_tile_argument, "end_tile", "the first tile that is not traced", std::span(&end_tile, 1)),
        input("buffer", counter_argument, "counter", "not read by this program", std::span(&counter, 1)),
        input("buffer", rays_argument, "rays", "given rays, two quads each", rays)};
    const auto buffers = scene_buffers(scene);
    cl_uint argument = first_array_argument;
    for (const SceneArray& array : scene_arrays(kernel.layout))
        made.inputs.push_back(input("buffer", argument++, buffers[array.binding].name, "an array of the packed scene",
                                    buffers[array.binding].bytes));
    made.output = output_argument;
    return made;
}

LaunchCase defect_case(std::string_view name, const DefectLaunch& launch)
{
    FoundDevice any;
    any.facts.kind = DeviceKind::gpu; // without the options for processors
    LaunchCase made = case_of(any, defect_program(name), "run_defect", launch.group_items, launch.groups());
    const auto words = defect_words(launch);
    made.inputs = {input("buffer", 0, "words", "what the kernel reads", std::span(words)),
                   input("value", 2, "count", "the number of items", std::span(&launch.items, 1))};
    if (launch.large_words != 0) made.lines.push_back("LARGE_BYTES " + std::to_string(launch.large_bytes()) + "u");
    made.output = 1;
    return made;
}

} // namespace tetrace::opencl
