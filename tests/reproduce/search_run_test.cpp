#include "bench/reproduce/tables/tables.h"

#include "backends/openmp/backend.h"
#include "tests/reproduce/timed_runs.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wrapped_session.h"

#include <algorithm>
#include <functional>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Faces = std::span<std::uint32_t>;
/// What becomes of the faces that were found; count: of outputs that were read back before.
using Damage = std::function<void(Faces faces, std::size_t count)>;

class DamagedSession : public WrappedSession {
public:
    DamagedSession(std::unique_ptr<Session> session, Damage damage)
        : WrappedSession(std::move(session)), damage_(std::move(damage))
    {
    }
    void read_output(std::span<std::uint32_t> words) override
    {
        std::fill(words.begin(), words.end(), POISON);
        const Faces faces = words.subspan(GUARD_WORDS, words.size() - 2 * std::size_t{GUARD_WORDS});
        inner().read_back(faces);
        damage_(faces, count_++);
    }

private:
    Damage damage_;
    std::size_t count_ = 0;
};

/// A device that answers as openmp does, and then damages the answers.
class DamagedBackend : public Backend {
public:
    DamagedBackend(std::string name, Damage damage) : name_(std::move(name)), damage_(std::move(damage)) {}
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] std::string clock() const override { return inner_.clock(); }
    [[nodiscard]] const std::vector<Device>& devices() const override { return inner_.devices(); }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return inner_.has_kernel(kernel); }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        return inner_.why_not(device, kernel);
    }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        return std::make_unique<DamagedSession>(inner_.open(device, kernel, scene, options), damage_);
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        return inner_.probe(device, math, operations);
    }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    std::string name_;
    Damage damage_;
    Backend& inner_ = openmp_backend();
};

void leave_as_they_are(Faces, std::size_t) {}

/// 45 tets of 64 rays in 23 batches, the last one of a single tet.
Options options_of(const std::string& methods, const char* threads)
{
    return parse_options({"reproduce", "table5", "--searches", "45x64", "--samples", "3", "--sample-time", "0",
                          "--threads", threads, "--method", methods, "--layout", "tet80"});
}

/// One thread: two wait for each other at each of many launches, long where the machine has other work.
SearchRun run_on(const std::vector<Backend*>& backends, const std::string& methods = "maria", const char* threads = "1")
{
    const Options options = options_of(methods, threads);
    SearchRun run = open_search_run(options, backends);
    run_searches(run, options, {});
    return run;
}

std::string text_cell(const PaperTable& table, std::size_t row, const std::string& key)
{
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].key == key)
            if (const auto* text = std::get_if<std::string>(&table.rows.at(row).at(c))) return *text;
    return {};
}

std::optional<double> number_cell(const PaperTable& table, std::size_t row, const std::string& key)
{
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        if (table.columns[c].key == key)
            if (const auto* number = std::get_if<Quantity>(&table.rows.at(row).at(c))) return number->ours.value;
    return {};
}

/// A row of openmp that takes so long for all searches.
RowRun timed_row(Method method, unsigned threads, double seconds)
{
    RowRun row;
    row.key = {search_scene, reference_backend().name(), {Structure::cdt, method, Layout::tet80}};
    row.key.threads = threads;
    row.device.kind = DeviceKind::cpu;
    Traced result;
    result.totals.rays = result.verdicts.rays = result.verdicts.agreed = 1000;
    row.outcome = result;
    row.samples_s = {seconds, seconds, seconds};
    return row;
}

/// Four batches of it.
std::vector<ImageRecord> timed_batches(double seconds)
{
    ImageRecord record;
    constexpr std::size_t batches = 20;
    record.samples_s.assign(3, seconds / batches);
    return std::vector<ImageRecord>(batches, record);
}

} // namespace

TEST(SearchRun, openmp_has_a_row_on_one_thread_and_one_on_all)
{
    std::string names;
    for (const RowKey& key : select_search_rows(options_of("maria,stp", "2"), {&openmp_backend()}))
        names += row_name(key) + " " + device_label(key) + "\n";
    EXPECT_EQ(names, "search/stp/tet80/random-tets/math:exact/api:openmp/threads:1 openmp, 1 thread\n"
                     "search/stp/tet80/random-tets/math:exact/api:openmp openmp\n"
                     "search/maria/tet80/random-tets/math:exact/api:openmp/threads:1 openmp, 1 thread\n"
                     "search/maria/tet80/random-tets/math:exact/api:openmp openmp\n");
    EXPECT_EQ(select_search_rows(options_of("maria", "1"), {&openmp_backend()}).size(), 1u);
    EXPECT_TRUE(contains(error_of([] { (void)select_search_rows(options_of("single", "1"), {&openmp_backend()}); }),
                         "usage: no row has this combination"));
}

TEST(SearchRun, batches_are_whole_tets_and_enough_for_an_interval)
{
    EXPECT_EQ(tets_of_batch({10'000, 16'384}), 100u);
    EXPECT_EQ(batch_count({10'000, 16'384}), 100u);
    EXPECT_EQ(tets_of_batch({1'000'000, 1u << 20}), 1u) << "a tet is never cut";
    EXPECT_EQ(batch_count({400, 8}), 20u);
    EXPECT_EQ(batch_count({7, 8}), 7u) << "a batch has a tet at least";
    EXPECT_EQ(batch_count({45, 64}), 23u);
}

TEST(SearchRun, every_search_is_judged_and_compared)
{
    DamagedBackend other("other", leave_as_they_are);
    const SearchRun run = run_on({&openmp_backend(), &other}, "plane,maria");
    ASSERT_EQ(run.rows.size(), 4u);
    for (const RowRun& row : run.rows) {
        EXPECT_NE(status_of(row), Status::wrong) << row_name(row.key) << ": " << reason_of(row);
        const Verdicts& verdicts = traced(row)->verdicts;
        EXPECT_EQ(traced(row)->totals.rays, 45u * 64);
        EXPECT_EQ(verdicts.rays, 45u * 64);
        EXPECT_EQ(verdicts.agreed + verdicts.ties + verdicts.wrong + verdicts.lost, 45u * 64);
        EXPECT_GT(verdicts.agreed, 44u * 64);
        EXPECT_EQ(traced(row)->compared, !is_reference(row.key));
        EXPECT_EQ(row.samples_s.size(), 3u);
    }
    const PaperTable table = table5(run, {});
    EXPECT_EQ(text_cell(table, 0, "faces"), "reference");
    EXPECT_EQ(text_cell(table, 1, "faces"), "the same");
    EXPECT_GT(number_cell(table, 1, "msearches_per_s"), 0);
    EXPECT_EQ(number_cell(table, 0, "threads"), 1);
    EXPECT_FALSE(number_cell(table, 1, "threads").has_value());
}

TEST(SearchRun, a_device_with_one_other_face_a_batch_is_wrong_and_has_no_rate)
{
    DamagedBackend other("other", [](Faces faces, std::size_t) { faces[17] = (faces[17] + 1) & 3u; });
    const SearchRun run = run_on({&openmp_backend(), &other});
    const PaperTable table = table5(run, {});
    EXPECT_EQ(status_of(run.rows[1]), Status::wrong);
    EXPECT_EQ(text_cell(table, 1, "faces"), "23 differ");
    EXPECT_TRUE(contains(text_cell(table, 1, "status"), "wrong: 23 different from openmp's"));
    EXPECT_FALSE(number_cell(table, 1, "msearches_per_s").has_value());
    EXPECT_TRUE(number_cell(table, 0, "msearches_per_s").has_value());
    EXPECT_TRUE(contains(claim_of(table, "table5-maria-exact").evidence, "by 1 row:"))
        << "the wrong row says nothing of the method";
    EXPECT_TRUE(contains(table.notes.back(), "api:other first differs on ray 17 of tet 0: face "));
}

TEST(SearchRun, the_record_of_a_wrong_row_names_its_first_search_and_has_no_rate)
{
    DamagedBackend other("other", [](Faces faces, std::size_t) {
        if (faces.size() > 64) faces[64 + 17] = NO_EXIT; // ray 17 of the batch's second tet
    });
    const auto rows = searches_json(run_on({&openmp_backend(), &other}))["rows"];
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["batch_medians_s"].size(), 23u);
    const auto& row = rows[1];
    EXPECT_EQ(row["status"], "wrong");
    EXPECT_FALSE(row.contains("msearches_per_s"));
    EXPECT_FALSE(row.contains("batch_medians_s"));
    EXPECT_NE(row["face_hash"], rows[0]["face_hash"]);
    const auto& verification = row["verification"];
    EXPECT_EQ(verification["lost"], 22) << "the last batch has one tet";
    EXPECT_EQ(verification["different_from_openmp"], 22);
    const auto& first = verification["first_different"];
    EXPECT_EQ(first["tet"], 1);
    EXPECT_EQ(first["ray"], 17);
    EXPECT_LT(first["openmp_face"], 4);
    EXPECT_FALSE(first.contains("face")) << "it found none";
    EXPECT_LT(verification["first_wrong"]["exact_face"], 4);
}

TEST(SearchRun, a_device_is_compared_where_openmp_has_no_row)
{
    DamagedBackend other("other", [](Faces faces, std::size_t) { faces[0] ^= 1u; });
    const SearchRun run = run_on({&other});
    ASSERT_EQ(run.rows.size(), 1u);
    EXPECT_EQ(traced(run.rows[0])->different, 23u) << reason_of(run.rows[0]);
}

TEST(SearchRun, faces_that_change_from_one_launch_to_the_next_are_wrong)
{
    DamagedBackend while_timed("other", [](Faces faces, std::size_t count) { faces[5] ^= count == 3 ? 1u : 0u; });
    EXPECT_EQ(reason_of(run_on({&while_timed}).rows[0]), "the answers of batch 1 changed while they were timed");
    constexpr std::size_t read_backs = 2 * 23; // of the batches: after the first launch, and after the last
    DamagedBackend at_the_end("other",
                              [](Faces faces, std::size_t count) { faces[5] ^= count == read_backs ? 1u : 0u; });
    const RowRun row = std::move(run_on({&at_the_end}).rows[0]);
    EXPECT_EQ(status_of(row), Status::wrong);
    EXPECT_EQ(reason_of(row), "the answers of batch 0 changed when it was traced again");
}

TEST(SearchRun, wrong_and_lost_faces_are_the_methods_own_where_openmp_has_them)
{
    DamagedBackend openmp("openmp", [](Faces faces, std::size_t) {
        faces[3] = NO_EXIT;
        faces[4] = NO_EXIT;
        for (std::uint32_t& face : faces.subspan(8, 8))
            face = 0; // right for some
    });
    const SearchRun run = run_on({&openmp});
    const Verdicts& verdicts = traced(run.rows[0])->verdicts;
    EXPECT_EQ(status_of(run.rows[0]), Status::flawed);
    EXPECT_EQ(verdicts.lost, 2u * 23);
    EXPECT_GT(verdicts.wrong, 3u * 23);
    EXPECT_LT(verdicts.wrong, 8u * 23);
    const PaperTable table = table5(run, {});
    EXPECT_DOUBLE_EQ(number_cell(table, 0, "lost").value_or(0), 1e6 * 2 * 23 / (45 * 64));
    EXPECT_TRUE(number_cell(table, 0, "msearches_per_s").has_value()) << "flawed rows keep their rate";
    EXPECT_EQ(claim_of(table, "table5-maria-exact").verdict, ClaimVerdict::does_not_hold);
    EXPECT_TRUE(contains(table.notes.back(), "is first wrong on ray 3 of tet 0: no face, but the exact face is "));
    EXPECT_TRUE(fails(run.rows[0], true)) << "maria loses none";
}

TEST(SearchRun, rows_on_all_threads_say_how_many)
{
    const PaperTable table = table5(run_on({&openmp_backend()}, "maria", "2"), {});
    EXPECT_EQ(number_cell(table, 0, "threads"), 1);
    EXPECT_EQ(number_cell(table, 1, "threads"), 2);
    EXPECT_EQ(text_cell(table, 1, "faces"), "the same");
    EXPECT_EQ(table.claims[0].verdict, ClaimVerdict::not_testable);
    EXPECT_TRUE(contains(table.claims[0].evidence, "ms06 and maria do not both have rates"));
}

TEST(SearchRun, the_fastest_is_taken_from_the_rows_on_one_thread)
{
    SearchRun run;
    const auto add = [&](Method method, unsigned threads, double seconds) {
        run.rows.push_back(timed_row(method, threads, seconds));
        run.images.push_back(timed_batches(seconds));
    };
    for (const KernelId& kernel : kernels_of(Task::search))
        if (kernel.layout == Layout::tet80 && kernel.math == MathMode::exact)
            for (const unsigned threads : {0u, 1u}) // rows of one thread are not the first
                add(kernel.method, threads, (kernel.method == Method::maria) == (threads == 1) ? 0.1 : 0.2);
    ASSERT_EQ(run.rows.size(), 12u);
    const Claim claim = table5(run, {}).claims[0];
    EXPECT_EQ(claim.id, "table5-maria-fastest-cpu");
    EXPECT_EQ(claim.verdict, ClaimVerdict::holds) << claim.evidence;
    run.images[1] = timed_batches(0.05); // plane on one thread
    EXPECT_EQ(table5(run, {}).claims[0].verdict, ClaimVerdict::does_not_hold);
    run.rows[1].outcome = Skipped{Status::unsupported, "a reason"};
    EXPECT_EQ(table5(run, {}).claims[0].verdict, ClaimVerdict::not_testable) << "not of all five";
}

TEST(SearchRun, claims_of_older_methods_are_decided_on_one_thread_and_tested_against_the_papers_share)
{
    SearchRun run;
    const auto seconds_of = [](Method method) {
        return method == Method::maria ? 0.1 : method == Method::stp ? 0.183 : 0.3;
    };
    for (const KernelId& kernel : kernels_of(Task::search))
        if (kernel.layout == Layout::tet80 && kernel.math == MathMode::exact) {
            run.rows.push_back(timed_row(kernel.method, 1, seconds_of(kernel.method)));
            run.images.push_back(timed_batches(seconds_of(kernel.method)));
        }
    const auto verdict = [&](const std::string& id) { return claim_of(table5(run, {}), id).verdict; };
    const std::string fastest = "table5-stp-is-the-fastest-older-cpu", slower = "table5-stp-is-83-percent-slower-cpu";
    EXPECT_EQ(verdict(fastest), ClaimVerdict::holds);
    EXPECT_EQ(verdict(slower), ClaimVerdict::holds);
    EXPECT_EQ(verdict("table5-ms06-is-the-fastest-older-gpu"), ClaimVerdict::not_testable) << "no GPU";
    EXPECT_EQ(verdict("table5-ms06-is-59-percent-slower-gpu"), ClaimVerdict::not_testable);
    EXPECT_EQ(verdict("table5-maria-fastest-gpu"), ClaimVerdict::not_testable);
    for (std::size_t row = 0; row < run.rows.size(); ++row)
        if (run.rows[row].key.kernel.method == Method::stp) run.images[row] = timed_batches(0.21);
    EXPECT_EQ(verdict(fastest), ClaimVerdict::holds);
    EXPECT_EQ(verdict(slower), ClaimVerdict::does_not_hold) << "2.1 is over 1.83 by more than a tenth";
    for (std::size_t row = 0; row < run.rows.size(); ++row)
        if (run.rows[row].key.kernel.method == Method::ms06) run.images[row] = timed_batches(0.15);
    EXPECT_EQ(verdict(fastest), ClaimVerdict::does_not_hold);
    for (RowRun& row : run.rows)
        row.device.kind = DeviceKind::gpu;
    EXPECT_EQ(verdict("table5-ms06-is-the-fastest-older-gpu"), ClaimVerdict::holds);
    EXPECT_EQ(verdict("table5-ms06-is-59-percent-slower-gpu"), ClaimVerdict::holds) << "1.5 is within a tenth of 1.59";
}

TEST(SearchRun, times_are_scaled_to_the_papers_searches_and_are_next_to_its_device_of_that_kind)
{
    SearchRun run;
    run.rows.push_back(timed_row(Method::maria, 1, 0.1));
    run.images.push_back(timed_batches(0.1));
    const auto cell = [&] {
        const PaperTable table = table5(run, {});
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            if (table.columns[c].key == "all_ms") return std::get<Quantity>(table.rows.at(0).at(c));
        throw std::runtime_error("no such column");
    };
    const double all_ms = 1e3 * 0.1 * paper::searches / static_cast<double>(traced(run.rows[0])->totals.rays);
    EXPECT_NEAR(cell().ours.value, all_ms, 1e-9 * all_ms);
    EXPECT_EQ(cell().paper, 2663);
    run.rows[0].key.threads = 0;
    EXPECT_FALSE(cell().paper) << "its CPU has one thread there";
    run.rows[0].device.kind = DeviceKind::gpu;
    EXPECT_EQ(cell().paper, 13);
    run.rows[0].device.kind = DeviceKind::emulated;
    EXPECT_FALSE(cell().paper);
}

TEST(SearchRun, a_gpu_decides_whether_plucker_overtakes_stp)
{
    class Gpu : public DamagedBackend {
    public:
        Gpu() : DamagedBackend("gpu", leave_as_they_are), devices_(openmp_backend().devices())
        {
            devices_[0].kind = DeviceKind::gpu;
        }
        [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }

    private:
        std::vector<Device> devices_;
    } gpu;
    const PaperTable table = table5(run_on({&gpu}, "stp,plucker,maria"), {});
    EXPECT_TRUE(contains(claim_of(table, "table5-plucker-overtakes-stp-gpu").evidence, "stp / plucker "));
    EXPECT_TRUE(contains(claim_of(table, "table5-plucker-overtakes-stp-gpu").evidence, "random-tets tet80 gpu"));
}

TEST(SearchRun, no_wrong_one_among_the_papers_number_of_searches_makes_the_claim_hold)
{
    SearchRun run;
    run.rows.resize(1);
    Traced result;
    result.totals.rays = result.verdicts.rays = run.size.count();
    result.verdicts.ties = 5;
    result.verdicts.agreed = run.size.count() - 5;
    run.rows[0].outcome = result;
    EXPECT_EQ(claim_of(table5(run, {}), "table5-maria-exact").verdict, ClaimVerdict::holds);
    EXPECT_TRUE(contains(claim_of(table5(run, {}), "table5-maria-exact").evidence,
                         "163,840,000 searches by 1 row: 0 wrong, 0 lost, 5 ties"));
    run.size.tets -= 1;
    EXPECT_EQ(claim_of(table5(run, {}), "table5-maria-exact").verdict, ClaimVerdict::not_testable);
    result.verdicts.wrong = 1;
    run.rows[0].outcome = result;
    EXPECT_EQ(claim_of(table5(run, {}), "table5-maria-exact").verdict, ClaimVerdict::does_not_hold);
}

TEST(SearchRun, rays_that_no_buffer_holds_end_a_row_as_unsupported)
{
    class SmallBackend : public DamagedBackend {
    public:
        SmallBackend() : DamagedBackend("other", leave_as_they_are) {}
        [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId&, const SceneData&,
                                                    const SessionOptions&) override
        {
            throw Error(ErrorKind::unsupported, "the rays have 2 bytes, the device's largest buffer 1");
        }
    } small;
    const SearchRun run = run_on({&openmp_backend(), &small});
    const PaperTable table = table5(run, {});
    EXPECT_EQ(text_cell(table, 1, "status"), "unsupported: the rays have 2 bytes, the device's largest buffer 1");
    EXPECT_FALSE(number_cell(table, 1, "searches").has_value());
    EXPECT_EQ(status_of(run.rows[0]), Status::ok) << "the others go on";
}
