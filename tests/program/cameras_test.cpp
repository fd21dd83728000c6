#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>

using namespace tetrace::test;

namespace {

using Json = nlohmann::json;

/// `--camera-set FILE.json`.
class CameraFiles : public ProgramTest {
protected:
    void write(const char* name, const std::string& text) { write_file(folder_ / name, text); }

    /// bench of two rows with the file's cameras.
    Ended trace(const char* cameras, const std::string& more = {})
    {
        return bench(std::string("--layout tet80,bvh2 --backend openmp --camera-set ") + cameras + " " + more);
    }

    /// What is wrong with a view, or with a whole file.
    std::string refused(const std::string& text)
    {
        write("bad.json", text);
        const Ended ended = trace("bad.json");
        EXPECT_EQ(ended.code, 2) << text;
        EXPECT_TRUE(contains(ended.errors, "--camera-set: reading 'bad.json': ")) << ended.errors;
        return ended.errors;
    }
    std::string refused_view(const std::string& view)
    {
        return refused(R"({"name": "n", "views": [{"origin": [0, 0, 2]}, )" + view + "]}");
    }

    const std::string example_ = read_text(std::filesystem::path(TETRACE_DOCS) / "cameras.example.json");
};

} // namespace

TEST_F(CameraFiles, of_the_documented_example_are_traced_and_named_in_the_result)
{
    write("example.json", example_);
    const Ended ended = trace("example.json", "--out result.json");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    const Json section = Json::parse(file("result.json"))["tetrace"];
    EXPECT_EQ(section["scenes"][0]["camera_set"], "three sides");
    EXPECT_EQ(section["scenes"][0]["camera_set_hash"].get<std::string>().size(), 16u);
    EXPECT_EQ(section["scenes"][0]["views"], (std::vector<int>{0, 1, 2}));
    for (const Json& row : section["rows"]) {
        EXPECT_EQ(row["status"], "ok") << row["name"];
        EXPECT_GT(row["counts"]["hits"], 0) << "the cameras look at the scene";
    }
    const std::string shown = std::regex_replace(run("show result.json").out, std::regex("\\s+"), " ");
    EXPECT_TRUE(contains(shown, "3 views of three sides")) << shown;
    EXPECT_EQ(run("render --scene cubes --resolution 6 --size 24 --camera-set example.json --views 2 --out a.ppm").code,
              0);
    EXPECT_EQ(trace("example.json", "--views 3").code, 2) << "it has three";
}

TEST_F(CameraFiles, with_other_numbers_are_other_work_whatever_their_name)
{
    write("a.cameras.json", R"({"name": "mine", "views": [{"origin": [0, 0, 2]}]})");
    write("b.cameras.json", R"({"name": "mine", "views": [{"origin": [0, 0, 2], "up": [0, 2, 0]}]})");
    ASSERT_EQ(trace("a.cameras.json", "--out a.json").code, 0);
    ASSERT_EQ(trace("a.cameras.json", "--out again.json").code, 0);
    ASSERT_EQ(trace("b.cameras.json", "--out b.json").code, 0);
    EXPECT_NE(run("compare a.json again.json").code, 2);
    const Ended other = run("compare a.json b.json");
    EXPECT_EQ(other.code, 2);
    EXPECT_TRUE(contains(other.errors, "1 views of mine ")) << other.errors;
}

TEST_F(CameraFiles, that_are_not_as_documented_are_refused_by_their_entry)
{
    EXPECT_TRUE(contains(refused("{"), "it is not JSON"));
    EXPECT_TRUE(contains(refused("[]"), "the file: is not an object"));
    EXPECT_TRUE(contains(refused(R"({"views": []})"), "name: is not a line"));
    EXPECT_TRUE(contains(refused(R"({"name": "orbit", "views": []})"), "name: 'orbit' is a camera set of tetrace's"));
    EXPECT_TRUE(contains(refused(R"({"name": "n", "views": []})"), "views: is not a list of at least one view"));
    EXPECT_TRUE(
        contains(refused(R"({"name": "n", "view": []})"), "the file: has a key 'view'; accepted: name or views"));
    EXPECT_TRUE(contains(refused_view(R"({"target": [0, 0, 0]})"), "views[1]: 'origin' is missing"));
    EXPECT_TRUE(contains(refused_view(R"({"origin": [0, 0]})"), "views[1].origin: is not a list of three numbers"));
    EXPECT_TRUE(
        contains(refused_view(R"({"origin": [0, 0, "2"]})"), "views[1].origin: is not a list of three numbers"));
    EXPECT_TRUE(contains(refused_view(R"({"origin": [0, 0, 3.1]})"), "views[1].origin: is more than 3 radii"));
    EXPECT_TRUE(contains(refused_view(R"({"origin": [0, 0, 0]})"), "views[1].target: is where the origin is"));
    EXPECT_TRUE(contains(refused_view(R"({"origin": [0, 2, 0]})"), "views[1].up: is along the line of sight"));
    EXPECT_TRUE(contains(refused_view(R"({"origin": [0, 0, 2], "up": [0, 0, 0]})"), "views[1].up: has a length below"));
    EXPECT_TRUE(contains(refused_view(R"({"origin": [0, 0, 2], "fov": 50})"),
                         "views[1]: has a key 'fov'; accepted: origin, target or up"));
    EXPECT_EQ(trace("missing.json").code, 3);
    EXPECT_TRUE(contains(trace("smok").errors, "frame, smoke, orbit or flight, or a file that ends in .json"));
}

// The mesh decides the cameras of `frame`, so their name does not.
TEST_F(CameraFiles, of_frame_are_pinned_by_a_hash_and_those_of_smoke_by_their_name)
{
    const auto scene_of = [&](const std::string& options) {
        EXPECT_EQ(bench("--layout bvh2 --backend openmp --out result.json " + options).code, 0);
        return Json::parse(file("result.json"))["tetrace"]["scenes"][0];
    };
    const Json frame = scene_of(""), same = scene_of("--camera-set frame");
    EXPECT_EQ(frame["camera_set"], "frame") << "the default";
    EXPECT_EQ(frame["camera_set_hash"].get<std::string>().size(), 16u);
    EXPECT_EQ(frame["camera_set_hash"], same["camera_set_hash"]);
    EXPECT_EQ(frame["views"], (std::vector<int>{0, 1, 2, 3}));
    EXPECT_FALSE(scene_of("--camera-set smoke").contains("camera_set_hash"));
}
