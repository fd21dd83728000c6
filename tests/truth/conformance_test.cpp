// Every usable device against what tests/expected/ says of its implementation: a change in either direction fails.
#include "bench/measuring/conformity.h"
#include "bench/measuring/verify.h"
#include "bench/output/self_test_json.h"
#include "core/base/error.h"
#include "scenes/procedural.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using nlohmann::json;

/// Small: interpreters of kernels are among the devices.
Options small_run(const std::string& backend, const std::string& rays, const std::string& structures)
{
    return parse_options({"check", "--backend", backend, "--structure", structures, "--method", "all", "--schedule",
                          "tiles,persistent,packets", "--rays", rays, "--size", "32x24", "--views", "0,2"});
}

LoadedScene small_cubes()
{
    LoadedScene loaded;
    loaded.scene = make_cubes(6);
    loaded.scene.name = "cubes";
    return loaded;
}

/// Cubes whose free faces lead anywhere: walks enter tets that their rays miss.
LoadedScene damaged_cubes()
{
    LoadedScene loaded = small_cubes();
    auto& tets = loaded.scene.tets.tets;
    const auto count = static_cast<std::uint32_t>(tets.size());
    Random random(30);
    for (Tet& tet : tets)
        for (std::size_t face = 0; face < 4; ++face)
            if (tet.links[face] != NO_LINK && tet.faces[face] == FREE_FACE)
                tet.links[face] = make_link(random.below(count), random.below(4));
    return loaded;
}

std::vector<RowRun> verified_rows(const std::vector<RowKey>& keys, SceneWork& scene, const Options& options)
{
    std::vector<RowRun> rows;
    std::vector<RowRun*> pointers;
    for (const RowKey& key : keys)
        rows.push_back(open_row(key, scene, options));
    for (RowRun& row : rows)
        pointers.push_back(&row);
    verify_rows(pointers, scene, options);
    return rows;
}

/// "cdt/maria/tet80", with "/persistent", "/packets" or the kind of rays that it is given behind it.
std::string expected_name(const RowKey& key)
{
    std::string name = name_of(key.kernel);
    if (key.kernel.schedule != Schedule::tiles) name.append("/").append(name_of(key.kernel.schedule));
    return key.rays == RayKind::primary ? name : name.append("/").append(name_of(key.rays));
}

/// What a device shows here, in the form of tests/expected/.
json status_of_device(const std::vector<RowRun>& rows)
{
    json status = {{"self_test", nullptr}, {"rows", json::object()}};
    for (const RowRun& row : rows) {
        status["rows"][expected_name(row.key)] = name_of(conformity_of(row));
        if (row.self_test) status["self_test"] = self_test_json(*row.self_test);
    }
    return status;
}

std::vector<RowKey> rows_on(Backend& backend, std::size_t device, const Options& options)
{
    std::vector<RowKey> keys = select_rows(options, {"cubes"}, {&backend});
    // A driver's own BVH is compared with nothing.
    std::erase_if(keys, [&](const RowKey& key) { return key.device != device || !is_portable(key.kernel); });
    return keys;
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

bool may_find_no_exit(Method method)
{
    return method == Method::plane || method == Method::plucker || method == Method::stp;
}

class Conformance : public testing::TestWithParam<std::string> {
protected:
    /// Returns the text of the file to write where there is none.
    static std::string check_device(Backend& backend, std::size_t device)
    {
        const Options options = small_run(backend.name(), "primary,shadow,diffuse,random", "cdt,bvh");
        SceneWork scene(small_cubes(), options);
        const json found = status_of_device(verified_rows(rows_on(backend, device, options), scene, options));
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

TEST_P(Conformance, of_each_device_is_what_is_expected_of_its_implementation)
{
    Backend& backend = backend_named(GetParam());
    std::string missing;
    bool found = false;
    for (std::size_t i = 0; i < backend.devices().size(); ++i)
        if (backend.devices()[i].usable) {
            found = true;
            missing += check_device(backend, i);
        }
    if (!found) GTEST_SKIP() << backend.devices().front().reason;
    if (!missing.empty())
        GTEST_SKIP() << "nothing is known of this implementation; where its answers are right, write " << missing;
}

TEST_P(Conformance, of_lost_rays_is_that_of_all_others)
{
    Backend& backend = backend_named(GetParam());
    const Options options = small_run(backend.name(), "primary", "cdt");
    SceneWork scene(damaged_cubes(), options);
    std::size_t compared = 0;
    for (std::size_t device = 0; device < backend.devices().size(); ++device) {
        if (!backend.devices()[device].usable) continue;
        for (const RowRun& row : verified_rows(rows_on(backend, device, options), scene, options)) {
            if (status_of(row) == Status::unsupported) continue;
            EXPECT_EQ(status_of(row), Status::flawed) << row_name(row.key) << ": " << reason_of(row);
            ASSERT_NE(traced(row), nullptr);
            EXPECT_EQ(traced(row)->different, 0u) << row_name(row.key);
            if (may_find_no_exit(row.key.kernel.method)) {
                EXPECT_GT(traced(row)->totals.lost, 100u) << row_name(row.key);
            }
            ++compared;
        }
    }
    if (compared == 0) GTEST_SKIP() << backend.devices().front().reason;
}

INSTANTIATE_TEST_SUITE_P(each, Conformance, testing::ValuesIn(backend_names()), [](const auto& test) {
    std::string name = test.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});
