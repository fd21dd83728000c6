#include "bench/rows/physical_device.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace tetrace {

namespace {

bool are_one(const Device& a, const Device& b)
{
    if (runs_on_host(a) || runs_on_host(b)) return runs_on_host(a) && runs_on_host(b) && a.usable && b.usable;
    // Instances of one divided GPU share its PCI address, but each has its own UUID.
    if (!a.uuid.empty() && !b.uuid.empty()) return a.uuid == b.uuid;
    return !a.pci.empty() && a.pci == b.pci;
}

/// The same numbering without gaps.
std::vector<std::size_t> numbered_by_appearance(const std::vector<std::size_t>& numbers)
{
    std::map<std::size_t, std::size_t> seen;
    std::vector<std::size_t> result;
    for (const std::size_t number : numbers)
        result.push_back(seen.emplace(number, seen.size()).first->second);
    return result;
}

} // namespace

bool runs_on_host(const Device& device)
{
    return device.kind != DeviceKind::gpu;
}

std::vector<std::size_t> physical_devices(std::span<const Device> devices)
{
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        numbers.push_back(i);
        // A device with both a UUID and a PCI address can join two devices that have one each.
        for (std::size_t j = 0; j < i; ++j) {
            const auto mine = numbers[i], earlier = numbers[j];
            if (are_one(devices[i], devices[j])) std::replace(numbers.begin(), numbers.end(), mine, earlier);
        }
    }
    return numbered_by_appearance(numbers);
}

namespace {

std::optional<SelfTest> run_self_test(Backend& backend, std::size_t device, MathMode math)
{
    const auto results = backend.probe(device, math, self_test_operations());
    if (results.empty()) return std::nullopt;
    return judge_self_test(results);
}

} // namespace

const std::optional<SelfTest>& self_test_of(Backend& backend, std::size_t device, MathMode math)
{
    static std::map<std::tuple<Backend*, std::size_t, MathMode>, std::optional<SelfTest>> found;
    const std::tuple key{&backend, device, math};
    if (const auto known = found.find(key); known != found.end()) return known->second;
    return found.emplace(key, run_self_test(backend, device, math)).first->second;
}

const std::optional<Yardstick>& yardstick_of(Backend& backend, std::size_t device, const SessionOptions& options)
{
    static std::map<std::pair<Backend*, std::size_t>, std::optional<Yardstick>> found;
    const std::pair key{&backend, device};
    if (const auto known = found.find(key); known != found.end()) return known->second;
    return found.emplace(key, backend.yardstick(device, options)).first->second;
}

} // namespace tetrace
