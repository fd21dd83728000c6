#pragma once

#include "backends/cuda/program.h"
#include "core/device/backend.h"

namespace tetrace::cuda {

/// The devices that the driver lists, usable or not; one unusable device if there is no driver or no device.
/// Throws Error{driver} if the driver fails.
[[nodiscard]] std::vector<Device> list_devices(const LoadedDriver& driver, const Programs& programs);

/// The driver's handle of a device, by its index in list_devices(). Throws Error{driver}.
[[nodiscard]] Ordinal ordinal_of(const Driver& driver, std::size_t index);

/// 10 * major + minor of a device's compute capability.
[[nodiscard]] int capability_of(const Driver& driver, Ordinal device);

/// A device's attribute by its number in the API; 0 if the driver does not know it.
[[nodiscard]] int attribute_of(const Driver& driver, Ordinal device, int attribute);

/// A device opened for work: its context and a stream in it.
struct OpenDevice {
    OpenDevice(const Driver& driver, Ordinal ordinal);

    Context context;
    Owned<StreamHandle> stream;
    int capability;

    [[nodiscard]] const Driver& driver() const { return context.driver(); }
    /// Waits for all work in the stream. Throws Error{driver} if any of it failed.
    void synchronize();
    /// Starts a kernel on a line of blocks. parameters: addresses of its arguments.
    void launch(FunctionHandle function, unsigned blocks, unsigned block_threads, std::span<void* const> parameters)
    {
        launch(function, blocks, block_threads, parameters, 0, stream.get());
    }
    /// The same in another stream. shared_bytes: of a block's memory, in addition to what the function declares.
    void launch(FunctionHandle function, unsigned blocks, unsigned block_threads, std::span<void* const> parameters,
                unsigned shared_bytes, StreamHandle other);
};

} // namespace tetrace::cuda
