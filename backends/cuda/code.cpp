#include "backends/cuda/code.h"

#include "core/base/error.h"
#include "core/device/launch.h"
#include "core/device/session.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tetrace::cuda {

namespace {

/// CUfunction_attribute values.
constexpr std::array<std::pair<const char*, int>, 8> function_attributes = {{{"MAX_THREADS_PER_BLOCK", 0},
                                                                             {"SHARED_SIZE_BYTES", 1},
                                                                             {"CONST_SIZE_BYTES", 2},
                                                                             {"LOCAL_SIZE_BYTES", 3},
                                                                             {"NUM_REGS", 4},
                                                                             {"PTX_VERSION", 5},
                                                                             {"BINARY_VERSION", 6},
                                                                             {"CACHE_MODE_CA", 7}}};
constexpr int attribute_multiprocessor_threads = 39; // of the device

unsigned block_threads_of(const std::optional<KernelId>& kernel)
{
    const bool is_persistent = kernel && kernel->schedule == Schedule::persistent;
    return is_persistent ? persistent_block_threads : TILE_WIDTH * tile_height_of({});
}

} // namespace

CompiledCode compiled_code(const Driver& driver, Ordinal ordinal, const Device& facts, const Programs& programs,
                           const std::optional<KernelId>& kernel, bool starts_outside)
{
    OpenDevice device(driver, ordinal);
    const ProgramId id = kernel ? program_of(*kernel) : ProgramId{"probe"};
    const LoadedProgram program = load_program(device.context, device.capability, programs, id, {});
    const FunctionHandle function = program.module.function(kernel ? entry_name(*kernel, starts_outside) : id.name());
    CompiledCode code{facts.driver + ", " + facts.name, facts.group_width, {}, {}, {}};
    for (const auto& [name, number] : function_attributes)
        if (int value = 0; driver.function_attribute(&value, number, function) == success)
            code.statistics[name] = value;
    if (code.statistics.empty())
        throw Error(ErrorKind::unsupported, "the driver of '" + facts.name + "' does not report its code");
    const unsigned threads = block_threads_of(kernel);
    const std::size_t shared_bytes = kernel ? std::size_t{stack_bytes_of_item(kernel->layout)} * threads : 0;
    int blocks = 0;
    device.context.check(driver.blocks_per_multiprocessor(&blocks, function, static_cast<int>(threads), shared_bytes),
                         "asking how many blocks fit");
    const unsigned lanes = std::max(1u, facts.group_width);
    code.statistics["blocks per multiprocessor"] = blocks;
    code.statistics["warps per multiprocessor"] = blocks * static_cast<double>((threads + lanes - 1) / lanes);
    code.statistics["max warps per multiprocessor"] =
        attribute_of(driver, ordinal, attribute_multiprocessor_threads) / static_cast<double>(lanes);
    return code;
}

} // namespace tetrace::cuda
