#include "bench/reproduce/flat_tets.h"
#include "tests/temporary_folder.h"

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace tetrace;
using nlohmann::json;

namespace {

struct Ended {
    int code = -1;
    std::string out, errors;
};

/// The program in a folder of its own, on a scene that it makes itself.
class reproduce : public testing::Test {
protected:
    /// Starts it; its process.
    [[nodiscard]] pid_t start(const std::string& arguments) const
    {
        const bool names_backends = arguments.find("--backend") != std::string::npos;
        std::istringstream words("tetrace reproduce " + arguments + (names_backends ? "" : " --backend openmp") +
                                 " --threads 1 --scene cubes --resolution 6");
        std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
        std::vector<char*> pointers;
        for (std::string& word : list)
            pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t child = ::fork();
        if (child != 0) return child;
        if (::chdir(folder_.path().c_str()) != 0) ::_exit(126);
        ::dup2(::open("stdout", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        ::dup2(::open("stderr", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        ::execv(TETRACE_PROGRAM, pointers.data());
        ::_exit(127);
    }

    [[nodiscard]] Ended end(pid_t child) const
    {
        int status = 0;
        ::waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "stdout"),
                read_text(folder_ / "stderr")};
    }

    [[nodiscard]] Ended run(const std::string& arguments) const { return end(start(arguments)); }

    [[nodiscard]] json result(const std::string& name) const
    {
        return json::parse(read_text(folder_ / name)).at("tetrace");
    }

    [[nodiscard]] std::size_t lines(const std::string& name) const
    {
        const std::string text = read_text(folder_ / name);
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

    /// Kills the run when its journal has a few views, and gives back how many.
    std::size_t kill_in_the_middle(const std::string& arguments, const std::string& journal) const
    {
        const pid_t child = start(arguments);
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (lines(journal) < 4 && std::chrono::steady_clock::now() < deadline)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ::kill(child, SIGKILL);
        EXPECT_EQ(end(child).code, -1) << "it ended before it was killed";
        return lines(journal) - 1;
    }

    TemporaryFolder folder_;
};

const json& claim(const json& table, const std::string& id)
{
    for (const json& one : table.at("claims"))
        if (one.at("id") == id) return one;
    throw std::runtime_error("no claim " + id);
}

const json& of_id(const json& list, const std::string& id)
{
    for (const json& one : list)
        if (one.at("id") == id) return one;
    throw std::runtime_error("nothing of id " + id);
}

} // namespace

TEST_F(reproduce, table4_of_a_sample_of_views)
{
    const Ended ended = run("table4 --method maria --size 24 --views 0-1281:100 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    EXPECT_EQ(section["verb"], "reproduce");
    const json table = of_id(section["tables"], "table4");
    ASSERT_EQ(table["rows"].size(), 2u) << "tet80 and tet96";
    for (const json& row : table["rows"]) {
        EXPECT_EQ(row["scene"], "cubes");
        EXPECT_EQ(row["method"], "maria");
        EXPECT_EQ(row["status"], "ok");
        EXPECT_EQ(row["views"]["value"], 13);
        EXPECT_EQ(row["flawed"]["value"], 0);
        EXPECT_EQ(row["flawed"]["paper"], 0);
        EXPECT_FALSE(row["flawed"].contains("ratio")) << "nothing over nothing";
        EXPECT_FALSE(row["flawed"].contains("high")) << "none in a sample bounds nothing";
    }
    EXPECT_EQ(claim(table, "maria-has-no-wrong-result")["verdict"], "not testable here");
    EXPECT_EQ(claim(table, "maria-has-the-fewest")["verdict"], "not testable here") << "nothing to compare with";
    EXPECT_EQ(section["rows"][0]["verification"]["rays"], 13 * 24 * 24);
    EXPECT_FALSE(section["rows"][0].contains("rates")) << "nothing was timed";
    EXPECT_TRUE(contains(ended.out, "table4: Rays with a wrong result"));
}

TEST_F(reproduce, all_views_of_smaller_images_are_a_sample_still)
{
    const Ended ended = run("table4 --method maria --layout tet80 --size 4 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json table = result("r.json")["tables"][0];
    EXPECT_EQ(table["rows"][0]["views"]["value"], 1282);
    EXPECT_EQ(claim(table, "maria-has-no-wrong-result")["verdict"], "not testable here");
}

TEST_F(reproduce, figure6_has_a_point_a_view_and_pictures_of_the_extremes)
{
    const Ended ended =
        run("figure6 --method maria --layout tet80 --size 64 --samples 3 --views 0-1281:60 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    const json figure = of_id(section["figures"], "figure6-cubes-cpu");
    EXPECT_EQ(figure["series"][0]["name"], "maria") << "the one layout and device go without saying";
    ASSERT_EQ(figure["series"].size(), 1u);
    EXPECT_EQ(figure["series"][0]["points"].size(), 22u);
    for (const json& point : figure["series"][0]["points"])
        EXPECT_GT(point[1].get<double>(), 0);
    EXPECT_EQ(figure["pictures"].size(), 4u);
    for (const json& name : figure["pictures"])
        EXPECT_TRUE(std::filesystem::exists(folder_ / name.get<std::string>())) << name;
    const json row = of_id(section["tables"], "figure6")["rows"][0];
    EXPECT_LE(row["correlation"]["low"], row["correlation"]["value"]);
    EXPECT_LT(row["fewest_tets"]["value"], row["most_tets"]["value"]);
    EXPECT_EQ(section["rows"][0]["times"]["samples_s"].size(), 3u);
    EXPECT_GT(section["rows"][0]["rates"]["mrays_per_s"], 0);
    EXPECT_EQ(claim(of_id(section["tables"], "figure6"), "time-is-proportional-to-tets-gpu")["verdict"],
              "not testable here");
}

TEST_F(reproduce, figure6_draws_an_emulated_device_apart_from_the_processor)
{
    const Ended ended = run("figure6 --method maria,ms06 --layout tet80 --backend openmp,cuda-host --size 16 "
                            "--samples 3 --views 0-3 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json figures = result("r.json")["figures"];
    ASSERT_EQ(figures.size(), 2u);
    for (const char* const id : {"figure6-cubes-cpu", "figure6-cubes-emulated"}) {
        const json& figure = of_id(figures, id);
        ASSERT_EQ(figure["series"].size(), 2u) << id;
        EXPECT_EQ(figure["series"][0]["name"], "ms06");
        EXPECT_EQ(figure["series"][1]["name"], "maria");
    }
    EXPECT_EQ(figures[0]["pictures"].size(), 4u);
    EXPECT_EQ(figures[1]["pictures"].size(), 0u) << "they are the scene's";
}

TEST_F(reproduce, table3_has_the_scenes_counts_and_a_rate_a_row)
{
    const Ended ended = run("table3 --method maria --size 24 --samples 3 --views 0,1 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    const json scenes = of_id(section["tables"], "table3")["rows"];
    ASSERT_EQ(scenes.size(), 1u) << "no TetGen makes this scene: there is no paper's build of it";
    EXPECT_EQ(scenes[0]["tets"]["value"], 6 * 6 * 6 * 6);
    EXPECT_LT(scenes[0]["tet80_mb"]["value"], scenes[0]["tet96_mb"]["value"]);
    const json rates = of_id(section["tables"], "table3-rates")["rows"];
    ASSERT_EQ(rates.size(), 2u);
    EXPECT_GT(rates[0]["mrays_per_s"]["value"], 0);
}

TEST_F(reproduce, table5_has_every_search_of_every_method_without_a_scene)
{
    const Ended ended = run("table5 --searches 40x64 --samples 3 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    EXPECT_TRUE(section["scenes"].empty());
    EXPECT_TRUE(section["missing_scenes"].empty());
    EXPECT_EQ(section["devices"].size(), 1u) << "compare and report read them";
    const json table = of_id(section["tables"], "table5");
    ASSERT_EQ(table["rows"].size(), 10u) << "five methods, two layouts, one thread";
    for (const json& row : table["rows"]) {
        EXPECT_EQ(row["device"], "openmp, 1 thread");
        EXPECT_EQ(row["threads"]["value"], 1);
        EXPECT_EQ(row["searches"]["value"], 40 * 64);
        EXPECT_EQ(row["faces"], "reference");
        EXPECT_NEAR(row["ns_a_search"]["value"].get<double>() * row["msearches_per_s"]["value"].get<double>(), 1e3,
                    1e-6);
        EXPECT_GT(row["copy_percent"]["value"].get<double>(), 0);
        if (row["method"] == "maria") {
            EXPECT_EQ(row["wrong"]["value"], 0);
            EXPECT_EQ(row["lost"]["value"], 0);
        }
    }
    EXPECT_EQ(claim(table, "table5-maria-exact")["verdict"], "not testable here") << "a part of the paper's searches";
    EXPECT_TRUE(contains(claim(table, "table5-maria-exact")["evidence"], "5,120 searches by 2 rows: 0 wrong"));
    EXPECT_TRUE(contains(claim(table, "table5-maria-fastest-cpu")["evidence"], "plane / maria"));
    EXPECT_TRUE(contains(claim(table, "table5-plucker-overtakes-stp-gpu")["evidence"], "No row of a GPU"));
    EXPECT_EQ(lines("r.json.journal"), 1u + 20 + 1 + 1) << "head, batches, yardstick, end";
}

TEST_F(reproduce, table5_records_what_it_was_made_from)
{
    const Ended ended = run("table5 --searches 40x64 --method maria --layout tet80 --samples 3 --out r.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const json section = result("r.json");
    EXPECT_EQ(section["samples_a_row"], 3);
    EXPECT_EQ(section["searches"]["tets"], 40);
    EXPECT_EQ(section["searches"]["rays_a_tet"], 64);
    EXPECT_EQ(section["searches"]["batches"], 20);
    ASSERT_EQ(section["searches"]["rows"].size(), 1u);
    const json row = section["searches"]["rows"][0];
    EXPECT_EQ(row["name"], "search/maria/tet80/random-tets/math:exact/api:openmp/threads:1");
    EXPECT_EQ(row["status"], "ok");
    EXPECT_EQ(row["host_threads"], 1);
    EXPECT_EQ(row["times"]["clock"], "host steady clock");
    EXPECT_EQ(row["times"]["samples_s"].size(), 3u);
    EXPECT_EQ(row["batch_medians_s"].size(), 20u);
    EXPECT_EQ(row["face_hash"].get<std::string>().size(), 16u);
    EXPECT_EQ(row["verification"]["searches"], 40 * 64);
    EXPECT_EQ(row["verification"]["wrong"], 0);
    const json table = of_id(section["tables"], "table5");
    EXPECT_EQ(row["msearches_per_s"], table["rows"][0]["msearches_per_s"]["value"]);
}

TEST_F(reproduce, samples_a_row_are_none_where_nothing_is_timed)
{
    ASSERT_EQ(run("table4 --method maria --layout tet80 --size 8 --views 0 --samples 7 --out r.json").code, 0);
    EXPECT_EQ(result("r.json")["samples_a_row"], 0);
    EXPECT_FALSE(result("r.json").contains("searches"));
}

TEST_F(reproduce, a_damaged_journal_is_refused)
{
    const std::string arguments = "table5 --searches 20x8 --method maria --layout tet80 --samples 3 --out r.json";
    ASSERT_EQ(run(arguments).code, 0);
    const std::string journal = read_text(folder_ / "r.json.journal");
    const auto resumed = [&](const std::function<void(json & entry, json & row)>& damage) {
        std::istringstream whole(journal);
        std::string damaged, line;
        for (std::size_t number = 1; std::getline(whole, line); ++number) {
            json entry = json::parse(line);
            if (number == 2) damage(entry, entry["rows"].front());
            damaged += entry.dump() + "\n";
        }
        write_text(folder_ / "r.json.journal", damaged);
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
    const std::string samples = "wants 3 samples, all above 0 s";
    refused(samples, [](json&, json& row) { row["samples_s"] = json::array(); });
    refused(samples, [](json&, json& row) { row["samples_s"][1] = -1e-6; });
    refused(samples, [](json&, json& row) { row["wall_samples_s"][1] = 0; });
    refused("number", [](json&, json& row) { row["samples_s"][0] = "fast"; });
}

TEST_F(reproduce, a_damaged_yardstick_in_the_journal_is_refused)
{
    const std::string arguments = "table5 --searches 20x8 --method maria --layout tet80 --samples 3 --out r.json";
    ASSERT_EQ(run(arguments).code, 0);
    std::string journal = read_text(folder_ / "r.json.journal");
    const std::size_t place = journal.find("\"copy_bytes_per_s\":");
    ASSERT_NE(place, std::string::npos);
    write_text(folder_ / "r.json.journal", journal.insert(place + 19, 1, '-'));
    const Ended ended = run(arguments + " --resume");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "a yardstick in the journal is damaged; remove 'r.json.journal'"));
}

TEST_F(reproduce, table5_goes_on_after_kill_9_to_the_same_result)
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
    ASSERT_EQ(run(arguments + " --resume").code, 0) << "once more, from the journal alone";
    const json again = result("r.json");
    EXPECT_EQ(again["tables"], resumed["tables"]);
    EXPECT_EQ(again["devices"], resumed["devices"]) << "their bandwidth is not measured again";
}

TEST_F(reproduce, goes_on_after_kill_9_to_the_same_result)
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
    EXPECT_EQ(run(arguments + "killed.json --resume").code, ended.code) << "once more, from the journal alone";
    const json again = result("killed.json");
    EXPECT_EQ(of_id(again["figures"], "figure6-cubes-cpu")["series"],
              of_id(resumed["figures"], "figure6-cubes-cpu")["series"]);
}

TEST_F(reproduce, a_journal_of_other_options_is_refused)
{
    const std::string arguments = "table4 --method maria --size 32 --views 0-1281:20 --out r.json ";
    (void)kill_in_the_middle(arguments + "--layout tet80", "r.json.journal");
    const Ended other = run(arguments + "--layout tet96 --resume");
    EXPECT_EQ(other.code, 2);
    EXPECT_TRUE(contains(other.errors, "is of another run"));
    EXPECT_TRUE(contains(other.errors, "rows:")) << "it says what differs";
    EXPECT_EQ(run("table4 --size 33 --method maria --layout tet80 --views 0-1281:20 --out r.json --resume").code, 2);
}

TEST_F(reproduce, refuses_what_it_does_not_make)
{
    const Ended unknown = run("table9");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_TRUE(contains(unknown.errors, "table3, table4, table5 or figure6"));
    const Ended later = run("table6");
    EXPECT_EQ(later.code, 2);
    EXPECT_TRUE(contains(later.errors, "makes no table6 yet"));
    EXPECT_TRUE(contains(run("table4 --resume").errors, "--out"));
}

TEST_F(reproduce, as_csv_and_markdown)
{
    const std::string arguments = "table4 --method maria --layout tet80 --size 24 --views 0,1 --format ";
    const Ended csv = run(arguments + "csv");
    ASSERT_EQ(csv.code, 0) << csv.errors;
    EXPECT_EQ(csv.out.rfind("table,scene,build,method,layout,device,quantity,unit,value,low,high,paper,ratio\n", 0),
              0u);
    EXPECT_TRUE(contains(csv.out, "table4,cubes,,maria,tet80,openmp,flawed,rays an image,0,0,"));
    const Ended searches = run("table5 --searches 20x8 --method maria --layout tet96 --format csv");
    EXPECT_TRUE(contains(searches.out, "table5,,,maria,tet96,\"openmp, 1 thread\",searches,,160,"));
    EXPECT_TRUE(contains(searches.out, "table5,,,maria,tet96,\"openmp, 1 thread\",wrong,a million,0,"));
    const Ended markdown = run(arguments + "markdown");
    EXPECT_TRUE(contains(markdown.out, "## table4: Rays with"));
    EXPECT_TRUE(contains(markdown.out, "| maria has no wrong result | not testable here |"));
}

TEST(flat_tets, flatness_is_the_shortest_altitude_over_the_longest_edge)
{
    TetMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25f, 0.25f, 1e-4f}};
    mesh.tets = {{{0, 1, 2, 3}, {}, {}}, {{0, 1, 2, 4}, {}, {}}};
    // The corner of a cube: volume 1/6, largest face sqrt(3)/2, longest edge sqrt(2).
    EXPECT_NEAR(flatness(mesh, 0), 1 / std::sqrt(3.0) / std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(flatness(mesh, 1), 1e-4 / std::sqrt(2.0), 1e-9);
    EXPECT_LT(flatness(mesh, 1), flat_below);
}
