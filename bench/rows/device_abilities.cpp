#include "bench/rows/device_abilities.h"

#include <map>
#include <tuple>

namespace tetrace {

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
