// Every usable device against what tests/expected/ says of its implementation: a change in either direction fails.
#include "bench/conformity.h"
#include "bench/self_test_json.h"
#include "bench/verify.h"
#include "core/error.h"
#include "scenes/procedural.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace tetrace;

namespace {

using nlohmann::json;

/// Small: interpreters of kernels are among the devices.
Options small_run(const std::string& backend)
{
    return parse_options({"check", "--backend", backend, "--structure", "cdt", "--schedule", "tiles,persistent",
                          "--size", "32x24", "--views", "0,2"});
}

SceneWork small_cubes(const Options& options)
{
    LoadedScene loaded;
    loaded.scene = make_cubes(6);
    loaded.scene.name = "cubes";
    return {std::move(loaded), options};
}

/// "cdt/maria/tet80", with "/persistent" behind it.
std::string expected_name(const RowKey& key)
{
    return name_of(key.kernel) + (key.kernel.schedule == Schedule::tiles ? "" : "/persistent");
}

/// What a device shows here, in the form of tests/expected/.
json status_of_device(const std::vector<RowKey>& keys, SceneWork& scene, const Options& options)
{
    std::vector<RowRun> rows;
    std::vector<RowRun*> pointers;
    for (const RowKey& key : keys)
        rows.push_back(open_row(key, scene, options));
    for (RowRun& row : rows)
        pointers.push_back(&row);
    verify_rows(pointers, scene, options);
    json status = {{"self_test", nullptr}, {"rows", json::object()}};
    for (const RowRun& row : rows) {
        status["rows"][expected_name(row.key)] = name_of(conformity_of(row));
        if (row.self_test) status["self_test"] = self_test_json(*row.self_test);
    }
    return status;
}

/// Compares key by key, so that the message names what changed.
void compare(const std::string& file, const char* part, const json& expected, const json& found)
{
    for (const auto& [key, value] : found.items())
        EXPECT_EQ(expected.value(key, json("nothing")), value)
            << file << ": " << part << ", " << key << ": expected on the left, found on the right. A device that got "
            << "worse has a new defect, or its kernel has: find out which. One that got better deserves the new "
               "status: "
            << "write what is found into the file.";
    for (const auto& [key, value] : expected.items())
        EXPECT_TRUE(found.contains(key)) << file << ": " << part << ", " << key << " is expected, and not there now";
}

Backend& backend_named(const std::string& name)
{
    const auto& backends = all_backends();
    return **std::find_if(backends.begin(), backends.end(), [&](const Backend* b) { return b->name() == name; });
}

/// All that run kernels of ours: Embree traces a structure of its own.
std::vector<std::string> backend_names()
{
    std::vector<std::string> names;
    for (const Backend* backend : all_backends())
        if (backend->name() != "embree") names.push_back(backend->name());
    return names;
}

class conformance : public testing::TestWithParam<std::string> {
protected:
    /// Returns the text of the file to write where there is none.
    static std::string check_device(Backend& backend, std::size_t device)
    {
        const Options options = small_run(backend.name());
        std::vector<RowKey> keys = select_rows(options, {"cubes"}, {&backend});
        keys.erase(std::remove_if(keys.begin(), keys.end(), [&](const RowKey& key) { return key.device != device; }),
                   keys.end());
        SceneWork scene = small_cubes(options);
        const json found = status_of_device(keys, scene, options);
        const std::string name = backend.devices()[device].implementation + ".json";
        const std::filesystem::path file = std::filesystem::path(TETRACE_EXPECTED) / name;
        if (!std::filesystem::exists(file)) return fmt::format("tests/expected/{}:\n{}\n", name, found.dump(2));
        const json expected = json::parse(read_text(file));
        compare(name, "self_test", expected.at("self_test"), found["self_test"]);
        compare(name, "rows", expected.at("rows"), found["rows"]);
        return {};
    }
};

} // namespace

TEST_P(conformance, of_each_device_is_what_is_expected_of_its_implementation)
{
    Backend& backend = backend_named(GetParam());
    std::string missing;
    bool found = false;
    for (std::size_t i = 0; i < backend.devices().size(); i++)
        if (backend.devices()[i].usable) {
            found = true;
            missing += check_device(backend, i);
        }
    if (!found) GTEST_SKIP() << backend.devices().front().reason;
    if (!missing.empty())
        GTEST_SKIP() << "nothing is known of this implementation; where its answers are right, write " << missing;
}

INSTANTIATE_TEST_SUITE_P(each, conformance, testing::ValuesIn(backend_names()), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});
