#include "core/device/absent_backend.h"

#include "core/base/error.h"
#include "core/device/device_facts.h"

namespace tetrace {

AbsentBackend::AbsentBackend(std::string name, const std::string& reason) : name_(std::move(name))
{
    devices_.push_back(unusable_device("none", reason));
}

std::unique_ptr<Session> AbsentBackend::open(std::size_t, const KernelId&, const SceneData&, const SessionOptions&)
{
    throw Error(ErrorKind::missing, devices_.front().reason);
}

} // namespace tetrace
