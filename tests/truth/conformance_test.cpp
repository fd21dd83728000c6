// Every usable device against what tests/expected/ says of its implementation: a change in either direction fails.
#include "bench/expectations/check_verdict.h"
#include "bench/expectations/expectation_files.h"
#include "bench/expectations/judgement.h"
#include "bench/measuring/view_recorder.h"
#include "bench/results/self_test_json.h"
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

std::vector<RowKey> rows_on(Backend& backend, std::size_t device, const Options& options)
{
    std::vector<RowKey> keys = select_rows(options, {"cubes"}, {&backend});
    // A driver's own BVH is compared with nothing.
    std::erase_if(keys, [&](const RowKey& key) { return key.device != device || !is_portable(key.kernel); });
    return keys;
}

/// A row of each kernel of ours whose schedule the file names.
void expect_all(const Part& part, const Expectation& expectation, const std::vector<RowRecord>& rows)
{
    for (const RayKind kind : traced_kinds)
        for (const KernelId& kernel : kernels_of(kind == RayKind::primary ? Task::trace : Task::rays)) {
            const bool is_of_part = (kernel.schedule == Schedule::packets) == (part.packet_lanes != 0);
            const bool is_expected = is_portable(kernel) && kernel.math == MathMode::exact &&
                                     expectation.rows.contains(std::string(name_of(kernel.schedule)));
            if (!is_of_part || !is_expected) continue;
            EXPECT_TRUE(std::ranges::any_of(
                rows, [&](const RowRecord& row) { return row.key.kernel == kernel && row.key.rays == kind; }))
                << name_of(kernel) << " of schedule " << name_of(kernel.schedule) << ", " << name_of(kind)
                << ", is expected, and not there now";
        }
}

/// A name that no row has is a mistake in the file, or of a row that is gone.
void expect_rows_of_exceptions(const Part& part, const Expectation& expectation, const std::vector<RowRecord>& rows)
{
    for (const auto& [name, status] : expectation.exceptions) {
        if ((name.find("/packets") != std::string::npos) != (part.packet_lanes != 0)) continue;
        const auto has_it = [&](const RowRecord& row) {
            return expected_name(row.key) == name || row.key.scene + "/" + expected_name(row.key) == name;
        };
        EXPECT_TRUE(std::ranges::any_of(rows, has_it)) << name << " is an exception, and not there now";
    }
}

/// Each item that the device shows, and none that it does not.
void expect_self_test(const Expectation& expectation, const std::vector<RowRecord>& rows)
{
    const auto row = std::ranges::find_if(rows, [](const RowRecord& one) { return one.self_test.has_value(); });
    ASSERT_EQ(row != rows.end(), !expectation.self_test.empty()) << "either has a self-test";
    if (row == rows.end()) return;
    const nlohmann::json shown = self_test_json(*row->self_test);
    for (const auto& [item, value] : shown.items())
        EXPECT_TRUE(expectation.self_test.contains(item)) << "self_test." << item << " is " << value << " now";
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
        const auto rows = records_of(verified_rows(rows_on(backend, device, options), scene, options));
        const std::string& name = backend.devices()[device].implementation;
        const std::filesystem::path path = std::filesystem::path(TETRACE_EXPECTED_FOLDER) / (name + ".json");
        if (!std::filesystem::exists(path))
            return fmt::format("tests/expected/{}.json:\n{}\n", name,
                               expectation_json(expectations_of(rows, true).at(name)).dump(2));
        const Expectations expectations = read_expectations({path});
        const CheckJudgement judgement = judge_rows(rows, &expectations, true);
        EXPECT_EQ(unknown_of(judgement), std::vector<std::string>());
        for (const Deviation& one : judgement.deviations)
            EXPECT_FALSE(fails(one.judged.judgement))
                << name << ".json: " << one.name << ": " << one.judged.text() << ". A device that got worse has a new "
                << "defect, or its kernel has: find out which. One that got better deserves the new status: write what "
                << "it shows into the file, as an exception where it is not that of its schedule.";
        expect_all(GetParam(), expectations.at(name), rows);
        expect_rows_of_exceptions(GetParam(), expectations.at(name), rows);
        expect_self_test(expectations.at(name), rows);
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
