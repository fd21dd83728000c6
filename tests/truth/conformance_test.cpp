// Every usable device against what tests/expected/ says of its implementation: a change in either direction fails.
#include "bench/measuring/conformity.h"
#include "bench/measuring/view_recorder.h"
#include "bench/output/device_json.h"
#include "core/base/error.h"
#include "scenes/procedural.h"
#include "tests/support/damaged_scene.h"
#include "tests/support/packet_widths.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <ostream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using nlohmann::json;

/// What is tested at once: a backend without its packets, or openmp's packets of one width.
struct Part {
    std::string backend;
    unsigned packet_lanes = 0; ///< 0: no packets
};

std::string name_of(const Part& part)
{
    if (part.packet_lanes != 0) return fmt::format("packets_of_{}", part.packet_lanes);
    std::string name = part.backend;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

void PrintTo(const Part& part, std::ostream* out)
{
    *out << name_of(part);
}

/// Small: interpreters of kernels are among the devices.
Options small_run(const Part& part, const std::string& rays, const std::string& structures)
{
    std::vector<std::string> words = {"check",    "--backend", part.backend, "--structure", structures,
                                      "--method", "all",       "--rays",     rays,          "--size",
                                      "32x24",    "--views",   "0,2",        "--schedule"};
    if (part.packet_lanes == 0)
        words.emplace_back("tiles,persistent");
    else
        words.insert(words.end(), {"packets", "--packet-lanes", std::to_string(part.packet_lanes)});
    return parse_options(words);
}

LoadedScene small_cubes()
{
    LoadedScene loaded;
    loaded.scene = make_cubes(6);
    loaded.scene.name = "cubes";
    return loaded;
}

/// Walks in them enter tets that their rays miss.
LoadedScene damaged_cubes()
{
    LoadedScene loaded;
    loaded.scene = make_damaged_cubes(6);
    loaded.scene.name = "cubes";
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

const std::vector<RayKind> traced_kinds = {RayKind::primary, RayKind::shadow, RayKind::diffuse, RayKind::random};

std::string names_of(const std::vector<RayKind>& kinds)
{
    std::string names;
    for (const RayKind kind : kinds)
        names.append(names.empty() ? "" : ",").append(name_of(kind));
    return names;
}

/// "cdt/maria/tet80", followed by "/persistent", "/packets" or the kind of rays that it is given.
std::string expected_name(const KernelId& kernel, RayKind kind)
{
    std::string name = name_of(kernel);
    if (kernel.schedule != Schedule::tiles) name.append("/").append(name_of(kernel.schedule));
    return kind == RayKind::primary ? name : name.append("/").append(name_of(kind));
}

/// What a file of tests/expected/ says of each row: every kernel of ours, of the schedules that the file names, has the
/// status of its schedule, but for the exceptions.
json expected_rows(const json& file)
{
    json rows = json::object();
    for (const RayKind kind : traced_kinds)
        for (const KernelId& kernel : kernels_of(kind == RayKind::primary ? Task::trace : Task::rays)) {
            const auto status = file.at("rows").find(name_of(kernel.schedule));
            if (is_portable(kernel) && kernel.math == MathMode::exact && status != file.at("rows").end())
                rows[expected_name(kernel, kind)] = *status;
        }
    rows.update(file.at("exceptions"));
    return rows;
}

json found_rows(const std::vector<RowRun>& rows)
{
    json statuses = json::object();
    for (const RowRun& row : rows)
        statuses[expected_name(row.key.kernel, row.key.rays)] = name_of(conformity_of(row));
    return statuses;
}

json found_self_test(const std::vector<RowRun>& rows)
{
    for (const RowRun& row : rows)
        if (row.self_test) return self_test_json(*row.self_test);
    return nullptr;
}

/// The file of tests/expected/ for a device that shows this.
json file_of(const std::vector<RowRun>& rows)
{
    json file = {{"self_test", found_self_test(rows)}, {"rows", json::object()}, {"exceptions", json::object()}};
    for (const RowRun& row : rows)
        file["rows"].emplace(name_of(row.key.kernel.schedule), name_of(conformity_of(row)));
    const json found = found_rows(rows), expected = expected_rows(file);
    for (const auto& [name, status] : found.items())
        if (expected.at(name) != status) file["exceptions"][name] = status;
    return file;
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
               "status: write what is found into the file, as an exception where it is not that of its schedule.";
    for (const auto& [key, value] : expected.items())
        EXPECT_TRUE(found.contains(key)) << file << ": " << part << ", " << key << " is expected, and not there now";
}

Backend& backend_named(const std::string& name)
{
    const auto& backends = all_backends();
    return **std::find_if(backends.begin(), backends.end(), [&](const Backend* b) { return b->name() == name; });
}

/// All that run kernels of ours: Embree traces a structure of its own.
std::vector<Part> all_parts()
{
    std::vector<Part> parts;
    for (const Backend* backend : all_backends())
        if (backend->name() != "embree") parts.push_back({backend->name()});
    for (const unsigned lanes : packet_widths)
        parts.push_back({"openmp", lanes});
    return parts;
}

/// The rows of tests/expected/ that a part has.
json rows_of(const Part& part, const json& rows)
{
    json result = json::object();
    for (const auto& [name, status] : rows.items())
        if ((name.find("/packets") != std::string::npos) == (part.packet_lanes != 0)) result[name] = status;
    return result;
}

bool may_find_no_exit(Method method)
{
    return method == Method::plane || method == Method::plucker || method == Method::stp;
}

class Conformance : public testing::TestWithParam<Part> {
protected:
    void SetUp() override
    {
        const std::string reason = why_no_packets_of(GetParam().packet_lanes);
        if (!reason.empty()) GTEST_SKIP() << reason;
    }

    /// Returns the text of the file to write where there is none.
    static std::string check_device(Backend& backend, std::size_t device)
    {
        const Options options = small_run(GetParam(), names_of(traced_kinds), "cdt,bvh");
        SceneWork scene(small_cubes(), options);
        const auto rows = verified_rows(rows_on(backend, device, options), scene, options);
        const std::string name = backend.devices()[device].implementation + ".json";
        const std::filesystem::path path = std::filesystem::path(TETRACE_EXPECTED_FOLDER) / name;
        if (!std::filesystem::exists(path)) return fmt::format("tests/expected/{}:\n{}\n", name, file_of(rows).dump(2));
        const json file = json::parse(read_text(path));
        compare(name, "self_test", file.at("self_test"), found_self_test(rows));
        compare(name, "rows", rows_of(GetParam(), expected_rows(file)), found_rows(rows));
        return {};
    }
};

} // namespace

TEST_P(Conformance, of_each_device_is_what_is_expected_of_its_implementation)
{
    Backend& backend = backend_named(GetParam().backend);
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
    Backend& backend = backend_named(GetParam().backend);
    const Options options = small_run(GetParam(), "primary", "cdt");
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

INSTANTIATE_TEST_SUITE_P(each, Conformance, testing::ValuesIn(all_parts()),
                         [](const auto& test) { return name_of(test.param); });
