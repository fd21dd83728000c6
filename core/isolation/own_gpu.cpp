#include "core/isolation/own_gpu.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

namespace tetrace {

namespace {

std::optional<unsigned>& own_number()
{
    static std::optional<unsigned> made;
    return made;
}

bool is_gpu(const Device& device)
{
    return device.usable && device.kind == DeviceKind::gpu;
}

/// The indices of the devices that stay.
std::vector<std::size_t> kept(const std::vector<Device>& devices, unsigned local)
{
    std::vector<std::size_t> gpus, all;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (is_gpu(devices[i])) gpus.push_back(i);
    const auto has_address = [&](std::size_t i) { return !devices[i].pci.empty(); };
    if (std::ranges::all_of(gpus, has_address))
        std::ranges::stable_sort(gpus, {}, [&](std::size_t i) { return devices[i].pci; });
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (!is_gpu(devices[i]) || i == gpus[local % gpus.size()]) all.push_back(i);
    return all;
}

/// A backend with some of its devices.
class OwnGpuBackend final : public Backend {
public:
    OwnGpuBackend(Backend& inner, unsigned local) : inner_(&inner), local_(local) {}

    [[nodiscard]] std::string name() const override { return inner_->name(); }
    [[nodiscard]] std::string clock() const override { return inner_->clock(); }
    [[nodiscard]] const std::vector<Device>& devices() const override
    {
        std::call_once(once_, [&] {
            indices_ = kept(inner_->devices(), local_);
            for (const std::size_t i : indices_)
                devices_.push_back(inner_->devices()[i]);
        });
        return devices_;
    }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return inner_->has_kernel(kernel); }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        return inner_->why_not(index(device), kernel);
    }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        return inner_->open(index(device), kernel, scene, options);
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        return inner_->probe(index(device), math, operations);
    }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override
    {
        return inner_->yardstick(index(device), options);
    }

private:
    [[nodiscard]] std::size_t index(std::size_t device) const
    {
        static_cast<void>(devices());
        return indices_.at(device);
    }

    Backend* inner_;
    unsigned local_;
    mutable std::once_flag once_;
    mutable std::vector<std::size_t> indices_; ///< in the inner backend's devices
    mutable std::vector<Device> devices_;
};

} // namespace

void set_own_gpu(unsigned local)
{
    own_number() = local;
}

std::vector<Backend*> with_own_gpu(const std::vector<Backend*>& backends)
{
    static std::vector<std::unique_ptr<Backend>> made;
    if (!own_number()) return backends;
    std::vector<Backend*> own;
    for (Backend* backend : backends)
        own.push_back(made.emplace_back(std::make_unique<OwnGpuBackend>(*backend, *own_number())).get());
    return own;
}

} // namespace tetrace
