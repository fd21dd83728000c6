#include "tests/reproduce/journal_lines.h"
#include "tests/reproduce/reproduce_fixture.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>

using namespace tetrace;
using namespace tetrace::test;
using nlohmann::json;

namespace {

class Resume : public ReproduceTest {
protected:
    /// What a run without a journal says that Ctrl-C ends, once it handles the signal.
    std::string interrupted(const std::string& arguments) const
    {
        const pid_t child = start(arguments);
        const auto handles = [&] {
            const std::string status = read_text("/proc/" + std::to_string(child) + "/status");
            if (contains(status, "State:\tZ")) return true; // it has ended, which the test will see
            const std::size_t at = status.find("SigCgt:");
            return at != std::string::npos &&
                   (std::stoull(status.substr(at + 7), nullptr, 16) >> (SIGINT - 1)) % 2 == 1;
        };
        while (!handles())
            ::usleep(1000);
        ::kill(child, SIGINT);
        const Ended ended = end(child);
        EXPECT_EQ(ended.code, -1) << "the signal ends it: it has nothing to keep";
        return ended.errors;
    }
};

} // namespace

TEST_F(Resume, a_damaged_journal_is_refused)
{
    const std::string arguments = "table5 --searches 20x8 --method maria --layout tet80 --samples 3 --out r.json";
    ASSERT_EQ(run(arguments).code, 0);
    const std::vector<json> journal = entries_of(read_text(folder_ / "r.json.journal"));
    const auto resumed = [&](const std::function<void(json & entry, json & row)>& damage) {
        std::vector<json> damaged = journal;
        damage(damaged[1], damaged[1]["rows"].front());
        write_file(folder_ / "r.json.journal", journal_of(damaged));
        const Ended ended = run(arguments + " --resume");
        return std::to_string(ended.code) + " " + ended.errors;
    };
    const auto refused = [&](const std::string& why, const std::function<void(json & entry, json & row)>& damage) {
        const std::string text = resumed(damage);
        EXPECT_EQ(text.rfind("2 ", 0), 0u) << text;
        EXPECT_TRUE(contains(text, "line 2 of the journal is damaged: ")) << text;
        EXPECT_TRUE(contains(text, why)) << text;
        EXPECT_TRUE(contains(text, "remove 'r.json.journal' to begin anew")) << text;
    };
    EXPECT_EQ(resumed([](json&, json&) {}), "0 ") << "as it was";
    refused("'rows' not found", [](json& entry, json&) { entry = {{"batch", 0}}; });
    refused("'verdict' not found", [](json&, json& row) { row.erase("verdict"); });
    refused("type must be string", [](json&, json& row) { row["chained_hash"] = 5; });
    refused("stoull", [](json&, json& row) { row["chained_hash"] = "none"; });
    refused("no such status", [](json&, json& row) { row = {{"skipped", "so"}, {"status", 99}}; });
    refused("has 9 rays, not 8", [](json&, json& row) { row["verdict"]["totals"][0] = 9; });
    refused("1e+308 is not a count", [](json&, json& row) { row["verdict"]["totals"][1] = 1e308; });
    refused("-1.5 is not a count", [](json&, json& row) { row["lost_at_cap"] = -1.5; });
    refused("9 of 8 rays", [](json&, json& row) { row["verdict"]["verdicts"]["counts"][4] = 9; });
    refused("-1.0 is not a number, negative", [](json&, json& row) { row["verdict"]["seconds"][0] = -1.0; });
    const std::string samples = "3 samples are wanted, all above 0 s";
    refused(samples, [](json&, json& row) { row["samples_s"] = json::array(); });
    refused(samples, [](json&, json& row) { row["samples_s"][1] = -1e-6; });
    refused(samples, [](json&, json& row) { row["wall_samples_s"][1] = 0; });
    refused("0 passes of a sample", [](json&, json& row) { row["passes"] = 0; });
    refused("a GPU's readings of 3 samples are wanted", [](json&, json& row) {
        row["gpu"] = {{"states", json::array()}, {"dropped", 1}, {"reasons", "heat"}};
    });
    EXPECT_TRUE(contains(resumed([](json& entry, json&) {
                             entry = {{"bench", 0}};
                         }),
                         "that does not belong to this run"));
    EXPECT_TRUE(contains(resumed([](json& entry, json&) {
                             entry = {{"scene", 7}};
                         }),
                         "that does not belong to this run"));
    refused("number", [](json&, json& row) { row["samples_s"][0] = "fast"; });
}

TEST_F(Resume, ctrl_c_says_how_to_go_on_or_to_begin_again)
{
    const std::string long_run = "table4 --size 4096 --views 0-1281";
    EXPECT_TRUE(contains(interrupted(long_run), "interrupted; an earlier result is unchanged. To begin again: tetrace "
                                                "reproduce table4"));
    const Ended ended = end(start("table4 --size 8 --views 0-1281:100 --out r.json", 4, SIGINT));
    EXPECT_EQ(ended.code, 130);
    const std::string& resumed = ended.errors;
    EXPECT_TRUE(contains(resumed, "what is finished is in 'r.json.journal'; to go on: tetrace reproduce")) << resumed;
    EXPECT_TRUE(contains(resumed, " --threads 1 --resume")) << resumed;
}

TEST_F(Resume, a_run_that_is_interrupted_keeps_the_views_that_it_has_and_goes_on_to_the_whole_result)
{
    const std::string command = "table4 --method maria --layout tet80 --size 16 --views 0-1281:100 ";
    ASSERT_EQ(run(command + "--out whole.json").code, 0);
    const Ended ended = end(start(command + "--out r.json", 6, SIGTERM));
    EXPECT_EQ(ended.code, 130) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "Stopped   by a signal")) << ended.out;
    EXPECT_TRUE(contains(ended.errors, "--resume")) << ended.errors;
    const json part = result("r.json"), whole = result("whole.json");
    EXPECT_EQ(part.at("interrupted"), true);
    const std::size_t views = part.at("scenes").at(0).at("views").size();
    EXPECT_GT(views, 0u);
    EXPECT_LT(views, 13u);
    EXPECT_EQ(part.at("rows").at(0).at("counts").at("rays"), views * 16 * 16);
    EXPECT_EQ(part.at("rows").at(0).at("status"), "ok");
    ASSERT_EQ(run(command + "--out r.json --resume").code, 0);
    EXPECT_FALSE(result("r.json").contains("interrupted"));
    EXPECT_EQ(result("r.json").at("rows").at(0).at("hit_hash"), whole.at("rows").at(0).at("hit_hash"));
}

TEST_F(Resume, check_goes_on_with_the_views_that_it_has_and_leaves_no_journal)
{
    verb_ = "check";
    const std::string command = "--method maria --layout tet80,tet96 --size 16 --views 0-3 ";
    ASSERT_EQ(run(command + "--out whole.json").code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "whole.json.journal"));
    EXPECT_EQ(kill_in_the_middle(command + "--out r.json", "r.json.journal"), 3u);
    ASSERT_EQ(run(command + "--out r.json --resume").code, 0);
    json resumed = result("r.json").at("rows"), whole = result("whole.json").at("rows");
    for (json* const rows : {&resumed, &whole})
        for (json& row : *rows)
            row.erase("times");
    EXPECT_EQ(resumed, whole);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r.json.journal"));
    kill_in_the_middle(command + "--out r.json", "r.json.journal");
    const Ended other = run("--method maria --layout tet80,tet96 --size 32 --views 0-3 --out r.json --resume");
    EXPECT_EQ(other.code, 2);
    EXPECT_TRUE(contains(other.errors, "size: [16,16] there, [32,32] here")) << other.errors;
    const Ended elsewhere = run(command + "--camera-set orbit --out r.json --resume");
    EXPECT_EQ(elsewhere.code, 2);
    EXPECT_TRUE(contains(elsewhere.errors, "cameras: \"frame\" there, \"orbit\" here")) << elsewhere.errors;
    EXPECT_EQ(run(command + "--out r.json").code, 0) << "takes seconds: a new run begins anew";
    write_file(folder_ / "r.json.journal", "a diary");
    EXPECT_EQ(run(command + "--out r.json").code, 2) << "not a journal";
    EXPECT_EQ(read_text(folder_ / "r.json.journal"), "a diary");
}

TEST_F(Resume, bench_goes_on_with_the_samples_that_it_has)
{
    verb_ = "bench";
    const std::string command = "--method maria --layout tet80,tet96 --size 16 --views 0,1 --samples 30 --runs 2 "
                                "--sample-time 0.05 --out r.json";
    const auto counts = [](const json& result) {
        std::vector<std::size_t> taken;
        for (const json& row : result.at("rows"))
            taken.push_back(row.at("times").at("samples_s").size());
        return taken;
    };
    const Ended ended =
        end(start(command + " --benchmark_out=g.json", 5, SIGTERM)); // its head, two views, and samples of some seconds
    EXPECT_EQ(ended.code, 130) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "to go on: tetrace bench")) << ended.errors;
    EXPECT_FALSE(contains(ended.errors, "--benchmark_out")) << "with --resume it is refused";
    EXPECT_TRUE(json::parse(read_text(folder_ / "g.json")).contains("benchmarks")) << "whole JSON";
    const json part = result("r.json");
    EXPECT_EQ(part.at("interrupted"), true);
    for (const std::size_t taken : counts(part)) {
        EXPECT_GT(taken, 0u);
        EXPECT_LT(taken, 60u);
    }
    EXPECT_EQ(run(command + " --resume --benchmark_out=g.json").code, 2) << "which would lack some";
    const Ended whole = run(command + " --resume");
    ASSERT_EQ(whole.code, 0) << whole.errors;
    const json resumed = result("r.json");
    EXPECT_FALSE(resumed.contains("interrupted"));
    EXPECT_EQ(counts(resumed), (std::vector<std::size_t>{60, 60}));
    for (std::size_t row = 0; row < 2; ++row) {
        const json &before = part["rows"][row]["times"].at("samples_s"),
                   &after = resumed["rows"][row]["times"].at("samples_s");
        EXPECT_EQ(resumed["rows"][row]["times"].at("runs").size(), 2u);
        EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin())) << "not taken again";
        EXPECT_EQ(part["rows"][row].at("hit_hash"), resumed["rows"][row].at("hit_hash"));
    }
}

TEST_F(Resume, junit_of_an_interrupted_check_says_so)
{
    verb_ = "check";
    const Ended ended =
        end(start("--method maria --layout tet80 --size 16 --views 0-3 --junit j.xml --out r.json", 3, SIGTERM));
    EXPECT_EQ(ended.code, 130) << ended.errors;
    EXPECT_TRUE(contains(read_text(folder_ / "j.xml"), "the check was interrupted"));
}

TEST_F(Resume, a_check_that_is_interrupted_before_it_has_a_view_still_writes_junit_and_json)
{
    verb_ = "check";
    for (const int signal : {SIGTERM, SIGINT}) {
        // The journal's head is written before the scene is opened.
        const Ended ended =
            end(start("--method maria --layout tet80 --size 16 --views 0-3 --junit j.xml --out r.json", 1, signal));
        EXPECT_EQ(ended.code, 130) << ended.errors;
        EXPECT_TRUE(contains(read_text(folder_ / "j.xml"), "the check was interrupted")) << ended.errors;
        const json part = result("r.json");
        EXPECT_EQ(part.at("interrupted"), true);
        EXPECT_EQ(part.at("rows").at(0).at("status"), "skipped");
        for (const char* const file : {"j.xml", "r.json", "r.json.journal"})
            std::filesystem::remove(folder_ / file);
    }
}

TEST_F(Resume, bench_keeps_the_samples_of_each_run_apart)
{
    verb_ = "bench";
    const std::string command = "--method maria --layout tet80,tet96 --size 16 --views 0 --samples 10 --runs 2 "
                                "--sample-time 0 --out r.json";
    EXPECT_EQ(end(start(command, 4)).code, -1) << "its head, a view, and the samples of each run";
    ASSERT_EQ(run(command + " --resume").code, 0);
    for (const json& row : result("r.json").at("rows")) {
        EXPECT_EQ(row.at("times").at("samples_s").size(), 20u);
        EXPECT_EQ(row.at("times").at("runs").size(), 2u);
    }
}

TEST_F(Resume, a_row_that_goes_on_has_every_key_of_the_whole_run)
{
    const std::string command = "table3 --method maria --layout tet80 --size 16 --views 0-1281:200 --samples 3 ";
    ASSERT_EQ(run(command + "--out whole.json").code, 0);
    EXPECT_LT(kill_in_the_middle(command + "--out r.json", "r.json.journal"), 7u);
    ASSERT_EQ(run(command + "--out r.json --resume").code, 0);
    const auto keys_of_row = [](const json& result) {
        std::vector<std::string> keys;
        const json flat = result.at("rows").at(0).flatten();
        for (const auto& [path, value] : flat.items())
            if (path.find("_samples_s/") == std::string::npos) keys.push_back(path);
        return keys;
    };
    EXPECT_EQ(keys_of_row(result("r.json")), keys_of_row(result("whole.json")));
}

TEST_F(Resume, a_damaged_yardstick_in_the_journal_is_refused)
{
    const std::string arguments = "table5 --searches 20x8 --method maria --layout tet80 --samples 3 --out r.json";
    ASSERT_EQ(run(arguments).code, 0);
    std::vector<json> journal = entries_of(read_text(folder_ / "r.json.journal"));
    const auto entry = std::ranges::find_if(journal, [](const json& one) { return one.contains("yardstick"); });
    ASSERT_NE(entry, journal.end());
    (*entry)["copy_bytes_per_s"] = -1.0;
    write_file(folder_ / "r.json.journal", journal_of(journal));
    const Ended ended = run(arguments + " --resume");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "a microbenchmark in the journal is damaged; remove 'r.json.journal'"));
}

TEST_F(Resume, table5_goes_on_after_kill_9_to_the_same_result)
{
    const std::string arguments =
        "table5 --searches 200x2048 --method maria,stp --layout tet80 --samples 3 --out r.json";
    const std::size_t batches = kill_in_the_middle(arguments, "r.json.journal");
    ASSERT_LT(batches, 20u);
    const std::string before = read_text(folder_ / "r.json.journal");
    EXPECT_TRUE(contains(run("table5 --searches 200x2056 --method maria,stp --layout tet80 --samples 3 --out r.json "
                             "--resume")
                             .errors,
                         "searches: [200,2048] there, [200,2056] here"));
    ASSERT_EQ(run(arguments + " --resume").code, 0);
    const json resumed = result("r.json");
    EXPECT_GT(resumed["tables"][0]["rows"][0]["copy_percent"]["value"], 0);
    const std::string after = read_text(folder_ / "r.json.journal");
    const std::string kept = before.substr(0, before.rfind('\n') + 1);
    EXPECT_EQ(after.substr(0, kept.size()), kept) << "finished batches are not done again";
    EXPECT_EQ(lines("r.json.journal"), 1u + 20 + 1 + 1) << "head, batches, yardstick, end";
    ASSERT_EQ(run(arguments + " --resume").code, 0) << "once more, only from the journal";
    const json again = result("r.json");
    EXPECT_EQ(again["tables"], resumed["tables"]);
    EXPECT_EQ(again["devices"], resumed["devices"]) << "their bandwidth is not measured again";
}

TEST_F(Resume, goes_on_after_kill_9_to_the_same_result)
{
    const std::string arguments =
        "table4,figure6 --method maria,ms06 --layout tet80 --size 48 --samples 3 --views 0-1281:40 --out ";
    const std::size_t views = kill_in_the_middle(arguments + "killed.json", "killed.json.journal");
    ASSERT_LT(views, 33u);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "killed.json"));
    std::ofstream(folder_ / "killed.json.journal", std::ios::app)
        << R"({"scene": "cub)"; // as a cut-off write leaves it
    EXPECT_EQ(run(arguments + "killed.json").code, 2) << "not overwritten unasked";
    const std::string journal = read_text(folder_ / "killed.json.journal");
    const Ended ended = run(arguments + "killed.json --resume");
    ASSERT_EQ(ended.code, run(arguments + "whole.json").code) << ended.errors;
    const json resumed = result("killed.json"), whole = result("whole.json");
    EXPECT_EQ(of_id(resumed["tables"], "table4"), of_id(whole["tables"], "table4"));
    EXPECT_EQ(resumed["rows"][0]["hit_hash"], whole["rows"][0]["hit_hash"]);
    EXPECT_EQ(resumed["rows"][0]["verification"], whole["rows"][0]["verification"]);
    // Times of finished views are the journal's, not measured again.
    std::istringstream before(journal), after(read_text(folder_ / "killed.json.journal"));
    std::string first, second;
    for (std::size_t line = 0; line <= views; ++line) {
        std::getline(before, first), std::getline(after, second);
        EXPECT_EQ(first, second) << "line " << line;
    }
    EXPECT_EQ(lines("killed.json.journal"), 1u + 33 + 1 + 1) << "head, views, yardstick, end";
    EXPECT_EQ(run(arguments + "killed.json --resume").code, ended.code) << "once more, only from the journal";
    const json again = result("killed.json");
    EXPECT_EQ(of_id(again["figures"], "figure6-cubes-cpu")["series"],
              of_id(resumed["figures"], "figure6-cubes-cpu")["series"]);
}

TEST_F(Resume, a_journal_of_other_options_is_refused)
{
    const std::string arguments = "table4 --method maria --size 32 --views 0-1281:20 --out r.json ";
    (void)kill_in_the_middle(arguments + "--layout tet80", "r.json.journal");
    const Ended other = run(arguments + "--layout tet96 --resume");
    EXPECT_EQ(other.code, 2);
    EXPECT_TRUE(contains(other.errors, "is of another run"));
    EXPECT_TRUE(contains(other.errors, "rows:")) << "it says what differs";
    EXPECT_EQ(run("table4 --size 33 --method maria --layout tet80 --views 0-1281:20 --out r.json --resume").code, 2);
}

TEST_F(Resume, a_check_goes_on_after_its_finished_repetitions)
{
    verb_ = "check";
    const std::string check = "--size 8 --views 0 --layout tet80 --method maria --repeat 4 --out r.json";
    const auto shown = [&] { return result("r.json").at("rows").at(0).at("repeated"); };
    const Ended ended = end(start(check, 3, SIGINT)); // after the head and two repetitions
    ASSERT_EQ(ended.code, 130) << ended.out << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "--resume")) << ended.errors;
    EXPECT_EQ(shown(), json({"reference", "reference"}));
    const std::string journal = read_text(folder_ / "r.json.journal");
    ASSERT_EQ(run(check + " --resume").code, 0);
    EXPECT_EQ(shown(), json({"reference", "reference", "reference", "reference"}));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r.json.journal"));

    // What the journal has counts.
    std::vector<json> entries = entries_of(journal);
    json& first = entries.at(1).at("tetrace").at("rows").at(0);
    first["hit_hash"] = first["views_hash"] = "0123456789abcdef";
    write_file(folder_ / "r.json.journal", journal_of(entries));
    EXPECT_EQ(run(check + " --resume").code, 1);
    EXPECT_EQ(shown(), json({"reference", "other answers", "other answers", "other answers"}));

    const auto refused = [&](const std::string& arguments, const std::string& text, const std::string& why) {
        write_file(folder_ / "r.json.journal", text);
        const Ended damaged = run(arguments + " --resume");
        EXPECT_EQ(damaged.code, 2) << damaged.out;
        EXPECT_TRUE(contains(damaged.errors, why)) << damaged.errors;
    };
    const json whole = entries.at(1);
    const auto damaged = [&](const std::string& why, const std::function<void(json & entry)>& damage) {
        entries.at(1) = whole;
        damage(entries.at(1));
        refused(check, journal_of(entries), why);
    };
    const std::string begins = "repetition 1 in the journal is damaged: ";
    damaged(begins, [](json& entry) { entry["tetrace"]["rows"][0].erase("status"); });
    damaged(begins + "it has 0 rows, not 1", [](json& entry) { entry["tetrace"]["rows"].clear(); });
    damaged(begins + "this run does not have the row 'other'",
            [](json& entry) { entry["tetrace"]["rows"][0]["name"] = "other"; });
    damaged(begins + "65 of 64 rays", [](json& entry) { entry["tetrace"]["rows"][0]["counts"]["hits"] = 65; });
    damaged(begins, [](json& entry) { entry.erase("usable"); });
    damaged("the journal has rows of another cubes: its mesh or its tets have changed",
            [](json& entry) { entry["tetrace"]["scenes"][0]["hash"] = "0123456789abcdef"; });
    entries.at(1) = {{"batch", 0}};
    refused(check, journal_of(entries), "that does not belong to this run");
    refused("--size 8 --views 0 --layout tet80 --method maria --out r.json", journal, "repeats");
}
