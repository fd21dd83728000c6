#include "bench/expectations/expectation.h"

#include "bench/results/self_test_json.h"
#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 5> known_keys = {"self_test", "rows", "exceptions", "defects", "flakes"};

void require_known(const ResultValue& value)
{
    for (const auto& [key, member] : value.members())
        if (std::ranges::find(known_keys, key) == known_keys.end())
            member.reject(fmt::format("is not a key of an expectation, which may have {}; tests/expected/README.md "
                                      "describes them",
                                      fmt::join(known_keys, ", ")));
}

/// Statuses that a file can expect: skipped rows have no result, and one that varies is among the flakes.
void read_status(Finding& to, const ResultValue& from)
{
    read_into(to, from);
    if (to == Finding::skipped || to == Finding::other_answers)
        from.reject(fmt::format("'{}' cannot be expected; 'flakes' names rows that vary", name_of(to)));
}

std::map<std::string, Finding> statuses_at(const ResultValue& object, const char* key)
{
    std::map<std::string, Finding> statuses;
    if (const auto values = object.find(key))
        for (const auto& [name, value] : values->members())
            read_status(statuses[name], value);
    return statuses;
}

void require_schedules(const ResultValue& object)
{
    if (const auto rows = object.find("rows"))
        for (const auto& [name, value] : rows->members())
            if (const auto& all = values_of<Schedule>();
                std::ranges::none_of(all, [&](Schedule one) { return name_of(one) == name; }))
                value.reject("is not a schedule, which --schedule lists; single rows are among 'exceptions'");
}

json self_test_of(const ResultValue& object)
{
    const auto given = object.find("self_test");
    if (!given) return json::object();
    static_cast<void>(self_test_from(*given)); // each value is of its kind
    const json known = self_test_json({});
    for (const auto& [key, value] : given->members()) {
        if (!known.contains(key)) value.reject("is not an item of the self-test (core/device/self_test.h)");
        if (key == "exact") static_cast<void>(value.flag());
    }
    json findings = given->json();
    return findings;
}

Expectation::Flakes flakes_from(const ResultValue& value)
{
    const std::string expression = value.line();
    if (expression.empty()) value.reject("is empty, which would be every row");
    try {
        return {expression, NameFilter("flakes", expression)};
    } catch (const Error& error) {
        value.reject(error.what());
    }
}

template <class Status>
json names_json(const std::map<std::string, Status>& statuses)
{
    json object = json::object();
    for (const auto& [name, status] : statuses)
        object[name] = name_of(status);
    return object;
}

} // namespace

std::string expected_name(const RowKey& key)
{
    std::string name = name_of(key.kernel);
    const auto add = [&](bool is_unusual, const char* prefix, std::string_view value) {
        if (is_unusual) name.append("/").append(prefix).append(value);
    };
    add(key.kernel.schedule != Schedule::tiles, "", name_of(key.kernel.schedule));
    add(key.rays != RayKind::primary, "", name_of(key.rays));
    add(key.ray_order != RayOrder::tiles, "rays:", name_of(key.ray_order));
    add(key.order != TetOrder::chains, "order:", name_of(key.order));
    add(key.kernel.math != MathMode::exact, "math:", name_of(key.kernel.math));
    return name;
}

namespace {

/// The kernels that rows of a kind of rays may have.
std::vector<KernelId> kernels_for(RayKind kind)
{
    std::vector<KernelId> kernels;
    for (const Task task : values_of<Task>())
        if (task == asked_task(task) && task != Task::search)
            std::ranges::copy(kernels_for(task, kind), std::back_inserter(kernels));
    return kernels;
}

/// The names that rows of the backend may have among exceptions.
std::set<std::string> names_on(const Backend& backend)
{
    std::set<std::string> names;
    for (const RayKind kind : values_of<RayKind>())
        for (const KernelId& kernel : kernels_for(kind)) {
            if (!backend.has_kernel(kernel)) continue;
            for (const RayOrder ray_order : values_of<RayOrder>())
                for (const TetOrder order : values_of<TetOrder>())
                    names.insert(expected_name({{}, {}, kernel, kind, order, 0, 0, ray_order}));
        }
    return names;
}

} // namespace

std::vector<std::string> names_of_no_row(const Expectation& expectation, const Backend& backend)
{
    std::vector<std::string> unknown;
    if (expectation.exceptions.empty()) return unknown;
    const auto names = names_on(backend);
    for (const auto& [name, status] : expectation.exceptions)
        if (!names.contains(name) && !names.contains(name.substr(name.find('/') + 1))) unknown.push_back(name);
    return unknown;
}

const Finding* Expectation::status_of(const RowKey& key) const
{
    const std::string name = expected_name(key);
    for (const std::string& one : {key.scene + "/" + name, name})
        if (const auto found = exceptions.find(one); found != exceptions.end()) return &found->second;
    if (!is_portable(key.kernel) || key.kernel.math != MathMode::exact) return nullptr;
    const auto found = rows.find(std::string(name_of(key.kernel.schedule)));
    return found == rows.end() ? nullptr : &found->second;
}

bool Expectation::is_flake(const std::string& name) const
{
    return std::ranges::any_of(flakes, [&](const Flakes& some) { return some.names.keeps(name); });
}

void Expectation::add_flake(const std::string& name)
{
    std::string expression = "^";
    for (const char c : name) {
        if (std::string_view(".+*?()[]{}|^$\\").find(c) != std::string_view::npos) expression += '\\';
        expression += c;
    }
    expression += '$';
    if (std::ranges::find(flakes, expression, &Flakes::expression) == flakes.end())
        flakes.push_back({expression, NameFilter("flakes", expression)});
}

Expectation expectation_from(const ResultValue& value)
{
    require_known(value);
    require_schedules(value);
    Expectation expectation{self_test_of(value), statuses_at(value, "rows"), statuses_at(value, "exceptions"), {}, {}};
    if (const auto defects = value.find("defects"))
        for (const auto& [name, status] : defects->members())
            read_into(expectation.defects[name], status);
    if (const auto flakes = value.find("flakes"))
        for (const ResultValue& flake : flakes->items())
            expectation.flakes.push_back(flakes_from(flake));
    return expectation;
}

json expectation_json(const Expectation& expectation)
{
    json object = {{"rows", names_json(expectation.rows)}, {"exceptions", names_json(expectation.exceptions)}};
    if (!expectation.self_test.empty()) object["self_test"] = expectation.self_test;
    if (!expectation.defects.empty()) object["defects"] = names_json(expectation.defects);
    for (const Expectation::Flakes& some : expectation.flakes)
        object["flakes"].push_back(some.expression);
    return object;
}

} // namespace tetrace
