#pragma once

#include "core/isolation/driver_child.h"

#include <mutex>

namespace tetrace {

/// A backend whose drivers run in processes of their own, one for each device; this process never loads them. A driver
/// that ends its process, or gives no answer, is an Error{driver} of the call; the next call for the device starts
/// another process. A driver that does so while it lists its devices gives one that is broken, with the reason.
class IsolatedBackend : public Backend {
public:
    /// inner: answers here what no driver is needed for; the process finds it by its name.
    IsolatedBackend(const Backend& inner, DriverProcesses processes);

    void restart() override { children_.assign(children_.size(), nullptr); }

    [[nodiscard]] std::string name() const override { return inner_->name(); }
    [[nodiscard]] std::string clock() const override { return inner_->clock(); }
    [[nodiscard]] const std::vector<Device>& devices() const override;
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return inner_->has_kernel(kernel); }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override;
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override;
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override;
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override;
    [[nodiscard]] bool runs_defects() const override { return inner_->runs_defects(); }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name) override;

    /// The device's process, started where there is none. Throws Error{missing} if the device cannot be used,
    /// Error{driver} where it cannot be found again.
    [[nodiscard]] std::shared_ptr<DriverChild> child_of(std::size_t device) const;

private:
    [[nodiscard]] std::vector<Device> list(DriverChild& child) const;
    void find_devices() const;
    [[nodiscard]] std::shared_ptr<DriverChild> start(std::size_t device) const;

    const Backend* inner_;
    DriverProcesses processes_;
    mutable std::once_flag once_;
    mutable std::vector<Device> devices_;
    mutable std::vector<std::shared_ptr<DriverChild>> children_; ///< device by device; null if none was needed yet
    mutable std::shared_ptr<DriverChild> spare_;                 ///< listed the devices; for the first that is used
};

} // namespace tetrace
