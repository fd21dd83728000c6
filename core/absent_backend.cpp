#include "core/absent_backend.h"

#include "core/error.h"

namespace tetrace {

AbsentBackend::AbsentBackend(std::string name, std::string reason) : name_(std::move(name))
{
    Device device;
    device.name = "none";
    device.type = "gpu";
    device.usable = false;
    device.reason = std::move(reason);
    devices_.push_back(std::move(device));
}

std::unique_ptr<Session> AbsentBackend::open(std::size_t, const KernelId&, const SceneData&, const SessionOptions&)
{
    throw Error(ErrorKind::missing, devices_.front().reason);
}

} // namespace tetrace
