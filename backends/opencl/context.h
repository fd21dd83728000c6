#pragma once

#include "backends/opencl/device.h"
#include "backends/opencl/errors.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tetrace::opencl {

/// Seconds from the first begin of one of the commands to the last end of one, on the device; all are finished.
[[nodiscard]] double seconds_of(const std::vector<cl::Event>& commands);

/// A context on a device, shared by its sessions. It turns the API's errors into Error.
class Context {
public:
    /// threads: the number to use of an emulated device that can be divided; 0 or more than it has: all.
    /// Throws Error if the driver fails.
    Context(const FoundDevice& found, unsigned threads);

    [[nodiscard]] const FoundDevice& found() const { return found_; }
    [[nodiscard]] const Device& facts() const { return found_.facts; }
    [[nodiscard]] const cl::Context& handle() const { return handle_; }
    /// The device, or the part of it with that many threads.
    [[nodiscard]] const cl::Device& device() const { return device_; }
    [[nodiscard]] unsigned threads() const { return threads_; }
    /// An in-order queue with profiling.
    [[nodiscard]] cl::CommandQueue make_queue() const { return {handle_, device_, CL_QUEUE_PROFILING_ENABLE}; }

    /// Whether a call failed in a way that later calls may not survive: the next session takes a new context.
    [[nodiscard]] bool is_lost() const { return is_lost_; }

    /// Does some work; an error of the API becomes Error, see to_error(). bytes: what the work needs on the device.
    template <class Work>
    auto run(const std::string& doing, std::uint64_t bytes, const Work& work)
    {
        try {
            return work();
        } catch (const cl::Error& failure) {
            is_lost_ = is_lost_ || !is_about_memory(failure.err());
            throw to_error(failure, {doing, facts().name, bytes, facts().memory_bytes});
        }
    }

private:
    FoundDevice found_;
    cl::Device device_;
    unsigned threads_;
    cl::Context handle_;
    bool is_lost_ = false;
};

} // namespace tetrace::opencl
