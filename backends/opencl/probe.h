#pragma once

#include "backends/opencl/context.h"
#include "backends/opencl/program.h"
#include "core/device/defects.h"
#include "core/pack/packed_scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace::opencl {

/// Runs kernels/probe.h, one item and one result per quad. Throws Error if the device fails.
[[nodiscard]] std::vector<std::uint32_t> run_probe(Context& context, MathMode math, std::span<const Quad> operations);

/// The program of a reduced kernel (core/device/defects.h).
[[nodiscard]] ProgramId defect_program(std::string_view name);

/// A reduced kernel or a stressor, compiled for a context's device.
class DefectProgram {
public:
    /// Throws Error{unsupported} if the device lacks what the kernel needs, Error{driver} if it cannot be compiled.
    DefectProgram(std::shared_ptr<Context> context, std::string_view name);

    [[nodiscard]] bool is_of(const Context& context, std::string_view name) const
    {
        return context_.get() == &context && name_ == name;
    }
    /// Returns its output. Throws Error if the device fails.
    [[nodiscard]] std::vector<std::uint32_t> run(const DefectLaunch& launch) const;

private:
    std::shared_ptr<Context> context_;
    std::string name_;
    ProgramCache none_{{}};
    Program program_;
};

/// Copy bandwidth of the device's memory and caches by clEnqueueCopyBuffer and its events (core/device/yardstick.h),
/// buffers of 512 MiB at most, less where one may not be that large, bytes read and written; and the median time of an
/// empty kernel from its enqueueing to the end of clFinish on the host's clock. Throws Error if the device fails.
[[nodiscard]] Yardstick measure_device(Context& context, std::uint64_t max_buffer_bytes);

} // namespace tetrace::opencl
