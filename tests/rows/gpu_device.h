#pragma once

#include "core/device/backend.h"

namespace tetrace::test {

/// A GPU as two APIs name it: by its UUID, and by its place on the bus.
[[nodiscard]] inline Device gpu(const char* uuid, const char* pci)
{
    Device device;
    device.kind = DeviceKind::gpu;
    device.uuid = uuid;
    device.pci = pci;
    return device;
}

} // namespace tetrace::test
