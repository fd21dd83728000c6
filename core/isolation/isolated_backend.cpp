#include "core/isolation/isolated_backend.h"

#include "core/device/device_facts.h"
#include "core/isolation/isolated_session.h"

#include <tuple>

namespace tetrace {

namespace {

bool is_same(const Device& a, const Device& b)
{
    return std::tie(a.name, a.driver, a.uuid, a.pci) == std::tie(b.name, b.driver, b.uuid, b.pci);
}

Device broken_device(const std::string& reason)
{
    Device device = unusable_device("none", reason);
    device.broken = true;
    return printable(device);
}

} // namespace

IsolatedBackend::IsolatedBackend(const Backend& inner, DriverProcesses processes)
    : inner_(&inner), processes_(std::move(processes))
{
}

const std::vector<Device>& IsolatedBackend::devices() const
{
    std::call_once(once_, [this] { find_devices(); });
    return devices_;
}

void IsolatedBackend::find_devices() const
{
    try {
        spare_ = std::make_shared<DriverChild>(processes_, name());
        devices_ = list(*spare_);
    } catch (const std::exception& error) {
        devices_ = {broken_device(error.what())};
    }
    children_.resize(devices_.size());
}

std::vector<Device> IsolatedBackend::list(DriverChild& child) const
{
    ByteWriter request;
    request.put(Request::devices);
    ByteReader answer = child.call({"listing its devices", request, -1, call_limit_s(0)});
    return get_devices(answer);
}

std::shared_ptr<DriverChild> IsolatedBackend::child_of(std::size_t device) const
{
    const Device& wanted = devices().at(device);
    if (!wanted.usable) throw Error(wanted.broken ? ErrorKind::driver : ErrorKind::missing, wanted.reason);
    std::shared_ptr<DriverChild>& child = children_[device];
    if (child == nullptr || child->is_lost()) child = start(device);
    return child;
}

std::shared_ptr<DriverChild> IsolatedBackend::start(std::size_t device) const
{
    std::shared_ptr<DriverChild> child = std::exchange(spare_, nullptr);
    if (child == nullptr || child->is_lost()) {
        child = std::make_shared<DriverChild>(processes_, name());
        const auto now = list(*child);
        if (device >= now.size() || !is_same(now[device], devices_[device]))
            throw Error(ErrorKind::driver, name() + ": " + devices_[device].name +
                                               " is no longer where the driver listed it: the device was lost");
    }
    child->set_driver(devices_[device].implementation + ", " + devices_[device].name);
    return child;
}

std::string IsolatedBackend::why_not(std::size_t device, const KernelId& kernel) const
{
    if (has_kernel(kernel) && !devices().at(device).usable) return devices_[device].reason;
    ByteWriter request;
    request.put(Request::why_not);
    request.put(std::uint64_t{device});
    request.put(kernel);
    try {
        return child_of(device)
            ->call({"saying whether it runs " + name_of(kernel), request, -1, call_limit_s(0)})
            .get_text();
    } catch (const std::exception& error) {
        return error.what();
    }
}

std::unique_ptr<Session> IsolatedBackend::open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                               const SessionOptions& options)
{
    return std::make_unique<IsolatedSession>(*this, device, kernel, scene, options);
}

std::vector<std::uint32_t> IsolatedBackend::probe(std::size_t device, MathMode math, std::span<const Quad> operations)
{
    ByteWriter request;
    request.put(Request::probe);
    request.put(std::uint64_t{device});
    request.put(math);
    request.put_all(operations);
    return child_of(device)
        ->call({"testing its arithmetic", request, -1, call_limit_s(operations.size())})
        .get_all<std::uint32_t>();
}

std::vector<std::uint32_t> IsolatedBackend::run_defect(std::size_t device, std::string_view name)
{
    ByteWriter request;
    request.put(Request::run_defect);
    request.put(std::uint64_t{device});
    request.put_text(name);
    return child_of(device)
        ->call({"running the reduced kernel " + std::string(name), request, -1, call_limit_s(0)})
        .get_all<std::uint32_t>();
}

std::optional<Yardstick> IsolatedBackend::yardstick(std::size_t device, const SessionOptions& options)
{
    ByteWriter request;
    request.put(Request::yardstick);
    request.put(std::uint64_t{device});
    put_options(request, options);
    ByteReader answer =
        child_of(device)->call({"copying its memory and running empty kernels", request, -1, call_limit_s(0)});
    if (!answer.get<bool>()) return std::nullopt;
    return answer.get<Yardstick>();
}

} // namespace tetrace
