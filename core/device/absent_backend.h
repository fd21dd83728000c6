#pragma once

#include "core/base/error.h"
#include "core/device/backend.h"
#include "core/device/device_facts.h"

namespace tetrace {

/// A backend that this build was made without: it has one device, without kernels, whose reason says why it cannot be
/// used.
class AbsentBackend : public Backend {
public:
    /// reason: what was missing and which package to install.
    AbsentBackend(std::string name, const std::string& reason) : name_(std::move(name))
    {
        devices_.push_back(unusable_device("none", reason));
    }

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] std::string clock() const override { return "none"; }
    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }
    [[nodiscard]] bool has_kernel(const KernelId&) const override { return false; }
    [[nodiscard]] std::string why_not(std::size_t, const KernelId&) const override { return devices_.front().reason; }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId&, const SceneData&,
                                                const SessionOptions&) override
    {
        throw Error(ErrorKind::missing, devices_.front().reason);
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode, std::span<const Quad>) override { return {}; }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    std::string name_;
    std::vector<Device> devices_;
};

} // namespace tetrace
