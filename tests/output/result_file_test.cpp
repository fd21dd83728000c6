#include "bench/results/result_file.h"
#include "bench/results/result_value.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

nlohmann::json small_result()
{
    return nlohmann::json::parse(R"({"tetrace": {
        "schema_version": 2, "verb": "bench", "date": "2026-01-31T12:00:00Z", "version": "0.1.0", "commit": "abc1234",
        "host": {"cpu": "a processor", "system": "a system", "threads": 2},
        "scenes": [{"name": "cubes", "hash": "0123456789abcdef", "camera_set": "smoke", "views": [0, 3],
                    "width": 24, "height": 16}],
        "rows": [
            {"name": "cdt/a", "scene": "cubes", "backend": "openmp", "status": "ok", "hit_hash": "00000000000000ff",
             "device": {"name": "cpu 1", "type": "cpu", "driver": "OpenMP"}, "times": {"samples_s": [1, 1.5]}},
            {"name": "cdt/b", "scene": "cubes", "backend": "cuda", "status": "skipped", "reason": "no\ndevice"}]}})");
}

class ResultFiles : public testing::Test {
protected:
    [[nodiscard]] ResultFile read(const std::string& text) const
    {
        write_file(folder_ / "a.json", text);
        return read_result(folder_ / "a.json");
    }
    [[nodiscard]] std::string error_of_text(const std::string& text) const
    {
        return error_of([&] { static_cast<void>(read(text)); });
    }
    /// Of a result of which the value at a JSON pointer is another; null removes it.
    [[nodiscard]] std::string error_with(const char* pointer, const nlohmann::json& value) const
    {
        nlohmann::json json = small_result();
        const nlohmann::json::json_pointer place(std::string("/tetrace") + pointer);
        if (value.is_null())
            json[place.parent_pointer()].erase(place.back());
        else
            json[place] = value;
        return error_of_text(json.dump());
    }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(ResultFiles, name_the_machine_by_its_label_or_else_by_all_that_is_known_of_the_processor)
{
    nlohmann::json json = small_result();
    json["tetrace"]["host"] = {
        {"cpu", "AMD EPYC"}, {"family", 25}, {"model", 1}, {"stepping", 0}, {"system", "a system"}};
    const ResultHead head = read(json.dump()).head;
    EXPECT_EQ(head.machine, "AMD EPYC (family 25, model 1, stepping 0)");
    EXPECT_EQ(head.shown("AMD EPYC"), head.machine);
    EXPECT_EQ(head.shown("a GPU"), "a GPU");
    json["tetrace"]["label"] = "Zen 3";
    EXPECT_EQ(read(json.dump()).head.machine, "Zen 3");
}

TEST_F(ResultFiles, of_older_versions_lose_google_benchmarks_own_part)
{
    nlohmann::json json = small_result();
    json["benchmarks"] = {{{"name", "cdt/a"}, {"real_time", 1.5}}, {{"name", "cdt/a"}, {"nested", {{"a", {1, 2}}}}}};
    json["context"] = {{"date", "today"}};
    EXPECT_EQ(read(json.dump()).json, small_result());
}

TEST_F(ResultFiles, is_read)
{
    const ResultFile result = read(small_result().dump());
    EXPECT_EQ(result.head.verb, "bench");
    EXPECT_EQ(result.head.commit, "abc1234");
    EXPECT_EQ(result.head.cpu, "a processor");
    EXPECT_EQ(result.head.machine, "a processor");
    ASSERT_NE(result.find_scene("cubes"), nullptr);
    EXPECT_EQ(result.find_scene("cubes")->hash, "0123456789abcdef");
    EXPECT_EQ(result.find_scene("cubes")->views, (std::vector<std::uint64_t>{0, 3}));
    EXPECT_EQ(result.find_scene("cubes")->height, 16u);
    ASSERT_EQ(result.rows.size(), 2u);
    ASSERT_NE(result.find_row("cdt/a"), nullptr);
    EXPECT_EQ(result.find_row("cdt/a")->samples_s, (std::vector<double>{1, 1.5}));
    EXPECT_EQ(result.find_row("cdt/a")->device, "cpu 1");
    EXPECT_EQ(result.find_row("cdt/b")->reason, "no\ndevice");
    EXPECT_TRUE(result.find_row("cdt/b")->samples_s.empty());
    EXPECT_EQ(result.find_row("cdt/c"), nullptr);
    EXPECT_EQ(result.section().at("rows").items().at(1).at("backend").text(), "cuda");
}

TEST_F(ResultFiles, of_the_repository_is_read_in_every_schema_version)
{
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(TETRACE_RESULTS)) {
        if (entry.path().extension() != ".json" || entry.path().filename() == "result.schema.json") continue;
        EXPECT_FALSE(read_result(entry.path()).head.date.empty()) << entry.path();
        ++files;
    }
    EXPECT_GT(files, 0);
}

TEST_F(ResultFiles, has_the_schedule_of_its_key_or_of_an_older_rows_name)
{
    const auto schedule_of = [&](const char* name, const char* key) {
        nlohmann::json json = small_result();
        nlohmann::json& row = json["tetrace"]["rows"][0];
        row["name"] = name;
        if (key != nullptr) row["schedule"] = key;
        return read(json.dump()).rows[0].schedule;
    };
    EXPECT_EQ(schedule_of("cdt/a/api:openmp", "packets"), "packets");
    EXPECT_EQ(schedule_of("cdt/a/schedule:persistent/api:opencl", nullptr), "persistent");
    EXPECT_EQ(schedule_of("cdt/a/schedule:packets", nullptr), "packets");
    EXPECT_EQ(schedule_of("cdt/a/api:openmp", nullptr), "tiles");
}

TEST_F(ResultFiles, that_is_not_there_is_missing)
{
    const std::string error = error_of([&] { static_cast<void>(read_result(folder_ / "none.json")); });
    EXPECT_TRUE(contains(error, "missing: "));
    EXPECT_TRUE(contains(error, "none.json"));
    EXPECT_TRUE(
        contains(error_of([&] { static_cast<void>(read_result(folder_.path())); }), "invalid_input: reading the"));
}

TEST_F(ResultFiles, without_an_end_is_refused_and_not_read_for_ever)
{
    EXPECT_TRUE(contains(error_of([] { static_cast<void>(read_result("/dev/zero")); }), "larger than 64 MiB"));
}

TEST_F(ResultFiles, whose_values_are_nested_so_deep_that_writing_them_would_exhaust_the_stack_is_refused)
{
    const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
    EXPECT_TRUE(contains(error_of_text(R"({"extra": )" + deep + "}"), "nested deeper than 64 levels"));
}

TEST_F(ResultFiles, whose_values_would_fill_the_memory_is_refused)
{
    std::string text = R"({"tetrace": [)";
    for (int i = 0; i < 6'100'000; ++i)
        text += "[],";
    EXPECT_TRUE(contains(error_of_text(text + "0]}"), "it has more than 6,000,000 values, which no result has"));
}

TEST_F(ResultFiles, that_is_no_json_or_was_cut_off_names_file_and_place)
{
    const std::string whole = small_result().dump();
    for (const std::string& text :
         {std::string("hello"), std::string("{\"tetrace\": nan}"), whole + "x", whole.substr(0, whole.size() / 2),
          whole.substr(0, whole.size() - 1), std::string("{\"tetrace\": \"\xff\"}")}) {
        const std::string error = error_of_text(text);
        EXPECT_TRUE(contains(error, "invalid_input: reading the result")) << error;
        EXPECT_TRUE(contains(error, "a.json")) << error;
        EXPECT_TRUE(contains(error, "line 1")) << error;
    }
    EXPECT_TRUE(contains(error_of_text(""), "it is empty"));
}

TEST_F(ResultFiles, that_is_another_programs_json_is_no_result)
{
    EXPECT_TRUE(contains(error_of_text("{\"context\": {}, \"benchmarks\": []}"), "section 'tetrace' is missing"));
    EXPECT_TRUE(contains(error_of_text("[1, 2]"), "is not an object (array)"));
    EXPECT_TRUE(contains(error_of_text("{\"tetrace\": 3}"), "tetrace: is not an object (number)"));
}

TEST_F(ResultFiles, of_another_schema_version_is_refused)
{
    for (const int version : {0, 3, 99})
        EXPECT_TRUE(contains(error_with("/schema_version", version), "tetrace.schema_version: is ")) << version;
    EXPECT_TRUE(contains(error_with("/schema_version", "2"), "schema_version: is not a whole number"));
    EXPECT_EQ(error_with("/schema_version", 1), "");
}

TEST_F(ResultFiles, that_lacks_a_key_names_it)
{
    for (const char* const key : {"/schema_version", "/verb", "/date", "/version", "/commit", "/host", "/host/cpu",
                                  "/scenes/0/name", "/scenes/0/hash", "/scenes/0/views", "/rows/0/name",
                                  "/rows/0/scene", "/rows/0/backend", "/rows/0/status", "/rows/0/device/name"}) {
        const std::string error = error_with(key, nullptr);
        const std::string name = nlohmann::json::json_pointer(key).back();
        EXPECT_TRUE(contains(error, "has no '" + name + "'")) << error;
    }
    EXPECT_TRUE(contains(error_with("/rows/0/status", nullptr), "tetrace.rows[0]: has no 'status'"));
}

TEST_F(ResultFiles, with_a_value_of_another_kind_names_its_key)
{
    const auto refused = [&](const char* pointer, const nlohmann::json& value, const char* text) {
        const std::string error = error_with(pointer, value);
        EXPECT_TRUE(contains(error, text)) << error;
    };
    refused("/rows", nlohmann::json::object(), "tetrace.rows: is not an array");
    refused("/rows/0", 7, "tetrace.rows[0]: is not an object");
    refused("/rows/0/status", "fine", "tetrace.rows[0].status: is 'fine'; this tetrace knows ok, flawed");
    refused("/rows/0/device/type", "fpga",
            "tetrace.rows[0].device.type: is 'fpga', and a device is cpu, gpu, emulated");
    refused("/rows/0/hit_hash", "00000000000000FF", "tetrace.rows[0].hit_hash: is not a hash");
    refused("/rows/0/times/samples_s", 1.5, "tetrace.rows[0].times.samples_s: is not an array");
    refused("/rows/0/times/samples_s/1", "1.5", "tetrace.rows[0].times.samples_s[1]: is not a finite number");
    refused("/rows/0/times/samples_s/1", 0, "samples_s[1]: is not a duration");
    refused("/rows/0/times/samples_s/0", -1.5, "samples_s[0]: is not a duration");
    refused("/scenes/0/width", -24, "tetrace.scenes[0].width: is not a whole number");
    refused("/scenes/0/views/1", 0.5, "tetrace.scenes[0].views[1]: is not a whole number");
    refused("/scenes/0/width", 0, "tetrace.scenes[0].width: is 0, not 1 to 16384");
    refused("/scenes/0/height", 1ull << 32, "tetrace.scenes[0].height: is 4294967296, not 1 to 16384");
    refused("/rows/0/threads", 1'000'000'000'000'000'000, "tetrace.rows[0].threads: is");
    refused("/rows/0/name", "cdt/\x1b[2J", "tetrace.rows[0].name: holds a control character");
}

TEST_F(ResultFiles, with_two_rows_of_one_name_is_refused)
{
    EXPECT_TRUE(contains(error_with("/rows/1/name", "cdt/a"), "tetrace.rows[1]: has the name 'cdt/a'"));
}

TEST(ResultText, fills_lines_and_reads_back_the_same)
{
    nlohmann::json value = small_result();
    for (int i = 0; i < 1000; ++i)
        value["tetrace"]["rows"][0]["times"]["samples_s"].push_back(1.0 / (i + 3));
    for (int i = 0; i < 100; ++i)
        value["points"].push_back({i, 0.1 * i});
    value["empty"] = {{"array", nlohmann::json::array()}, {"object", nlohmann::json::object()}, {"none", nullptr}};
    value["long"] = std::string(500, 'x') + "\"\n\xc3\xa9";
    const std::string text = result_text(value);
    EXPECT_EQ(nlohmann::json::parse(text), value);
    EXPECT_LT(text.size(), value.dump().size() * 11 / 10) << "little more than without any line break";
    EXPECT_TRUE(contains(text, "[0,0.0],[1,0.1],[2,0.2],"));
    std::size_t longest = 0, lines = 0;
    for (std::size_t begin = 0; begin < text.size(); ++lines) {
        const std::size_t end = text.find('\n', begin);
        if (!contains(text.substr(begin, end - begin), "xxx")) longest = std::max(longest, end - begin);
        begin = end + 1;
    }
    EXPECT_LE(longest, 120u);
    EXPECT_GT(lines, 150u);
}

TEST(ResultText, replaces_what_is_no_utf_8)
{
    EXPECT_EQ(nlohmann::json::parse(result_text({{"path", "a\xff/b"}})), nlohmann::json({{"path", "a\uFFFD/b"}}));
    EXPECT_EQ(result_text(nlohmann::json::object()), "{}\n");
    EXPECT_EQ(result_text({{"a", 1}, {"b", {1, 2}}}), "{\n \"a\":1,\"b\":[1,2]\n}\n");
}
