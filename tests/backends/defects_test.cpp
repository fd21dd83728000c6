// Reduced kernels of the compiler defects that were met, on every Vulkan device: what comes out is what
// tests/expected/<implementation>.json says, right or wrong. tests/expected/README.md describes each.
#include "backends/vulkan/program.h"
#include "core/base/error.h"
#include "tests/backends/defects/defects.h"

#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace tetrace;

namespace {

using Words = std::vector<std::uint32_t>;
constexpr std::uint32_t items = 16; // of a group, of which there is one

struct Defect {
    std::string name;
    Words values; ///< that the kernel reads
    std::function<std::uint32_t(std::uint32_t item)> expected;
};

std::uint32_t after_70000_steps(std::uint32_t value)
{
    for (int i = 0; i < 70000; ++i)
        value = value * 1664525u + 1013904223u;
    return value;
}

std::vector<Defect> all_defects()
{
    Words counting(64);
    for (std::uint32_t i = 0; i < counting.size(); ++i)
        counting[i] = i;
    return {{"value_after_divergent_loop", counting, [](std::uint32_t item) { return item; }},
            {"loop_of_70000_iterations", counting, after_70000_steps}};
}

Words run(const vulkan::Context& context, const Defect& defect)
{
    const vulkan::ProgramId id{.name = defect.name, .bindings = {0, 1}, .kernels = defects::embedded_kernels()};
    const vulkan::Program program(context, id, ProgramCache({}));
    Words results(items);
    const std::span<std::byte> bytes = std::as_writable_bytes(std::span(results));
    context.run("running " + defect.name, 0, [&] {
        const vulkan::Buffer from(context, defect.values.size() * sizeof(std::uint32_t), vulkan::Place::device);
        const vulkan::Buffer to(context, bytes.size(), vulkan::Place::device);
        const vulkan::Buffer staging(context, bytes.size(), vulkan::Place::read_back);
        vulkan::upload(context, from, std::as_bytes(std::span(defect.values)));
        program.bind(context, 0, from);
        program.bind(context, 1, to);
        const vk::raii::CommandBuffer commands = context.make_commands();
        commands.begin({});
        program.record(commands);
        commands.dispatch(1, 1, 1);
        vulkan::record_barrier(commands);
        commands.end();
        context.submit(commands);
        context.finish();
        vulkan::read_back(context, to, staging, bytes);
    });
    return results;
}

std::size_t wrong_items(const Defect& defect, const Words& results)
{
    std::size_t count = 0;
    for (std::uint32_t item = 0; item < items; ++item)
        count += results[item] == defect.expected(item) ? 0 : 1;
    return count;
}

nlohmann::json expected_defects(const std::string& implementation)
{
    std::ifstream file(std::string(TETRACE_EXPECTED_FOLDER "/") + implementation + ".json");
    if (!file) return {};
    return nlohmann::json::parse(file).value("defects", nlohmann::json());
}

} // namespace

TEST(Defects, are_those_that_each_implementation_is_known_for)
{
    std::string skipped;
    for (const vulkan::FoundDevice& found : vulkan::find_devices()) {
        if (!found.facts.usable) {
            skipped += found.facts.reason + "\n";
            continue;
        }
        const vulkan::Context context(found);
        const std::string& implementation = found.facts.implementation;
        const nlohmann::json expected = expected_defects(implementation);
        nlohmann::json outcomes;
        for (const Defect& defect : all_defects()) {
            const std::size_t wrong = wrong_items(defect, run(context, defect));
            const std::string outcome = wrong == 0 ? "right" : "wrong";
            outcomes[defect.name] = outcome;
            if (expected.is_null()) continue;
            EXPECT_EQ(expected.value(defect.name, "missing"), outcome)
                << defect.name << " on " << found.facts.name << ", " << found.facts.driver << ": " << wrong << " of "
                << items << " items are wrong. Where it was right before, report it upstream as "
                << "tests/expected/README.md describes it; then correct tests/expected/" << implementation << ".json";
        }
        if (expected.is_null())
            skipped += "tests/expected/" + implementation + ".json has no \"defects\"; it would be " +
                       nlohmann::json{{"defects", outcomes}}.dump() + "\n";
    }
    if (!skipped.empty()) GTEST_SKIP() << skipped;
}

TEST(Defects, a_kernels_wrong_items_are_counted)
{
    const Defect defect = all_defects().front();
    Words results(items);
    for (std::uint32_t item = 0; item < items; ++item)
        results[item] = defect.expected(item);
    EXPECT_EQ(wrong_items(defect, results), 0u);
    ++results[3];
    EXPECT_EQ(wrong_items(defect, results), 1u);
}
