#pragma once

#include "core/base/error.h"
#include "core/device/backend.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace tetrace::test {

/// A backend made of what a test says: one device, and what measuring it gives.
class FakeBackend : public Backend {
public:
    FakeBackend(std::string name, Device device) : name_(std::move(name)), devices_{std::move(device)} {}

    std::function<std::optional<Yardstick>()> measure = [] { return std::nullopt; };
    std::function<std::unique_ptr<Session>()> make_session = []() -> std::unique_ptr<Session> { return nullptr; };

    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] std::string clock() const override { return "fake"; }
    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }
    [[nodiscard]] bool has_kernel(const KernelId&) const override { return true; }
    [[nodiscard]] std::string why_not(std::size_t, const KernelId&) const override { return {}; }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId&, const SceneData&,
                                                const SessionOptions&) override
    {
        return make_session();
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode, std::span<const Quad>) override { return {}; }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return measure(); }

private:
    std::string name_;
    std::vector<Device> devices_;
};

} // namespace tetrace::test
