#include "bench/output/row_fields.h"
#include "tests/support/program_fixture.h"

#include <gtest/gtest.h>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Json = nlohmann::json;

/// A field of row_fields(), stated in one place, is in every output that has rows: JSON, CSV, the page, what `show`
/// prints again, what `merge` puts together, and what a run that was killed ends with.
class Columns : public ProgramTest {
protected:
    using Keys = std::set<std::string>; ///< "times/median_s"

    static std::string key_of(const RowField& field)
    {
        return *field.group == '\0' ? field.key : std::string(field.group) + "/" + field.key;
    }

    /// Of the rows of a result.
    [[nodiscard]] Keys recorded(const char* name) const
    {
        Keys keys;
        const Json result = Json::parse(file(name));
        for (const Json& row : result.at("tetrace").at("rows"))
            for (const RowField& field : row_fields())
                if (field.schema != nullptr && row.contains(Json::json_pointer("/" + key_of(field))))
                    keys.insert(key_of(field));
        return keys;
    }

    /// Those of `keys` whose column is not in the text of CSV.
    [[nodiscard]] static Keys without_column(const Keys& keys, const std::string& csv)
    {
        const std::string header = "," + csv.substr(0, csv.find('\n')) + ",";
        Keys missing;
        for (const RowField& field : row_fields()) {
            if (field.csv.title == nullptr || !keys.contains(key_of(field))) continue;
            const std::string key = field.csv.key != nullptr ? field.csv.key : field.key;
            if (!contains(header, "," + key + ",")) missing.insert(key_of(field));
        }
        return missing;
    }

    const std::string job_ = "bench --scene cubes --resolution 6 --size 24 --views 0-3 --camera-set smoke --samples 5 "
                             "--sample-time 0 --backend openmp --layout tet80,bvh2 --schedule tiles ";
};

} // namespace

TEST_F(Columns, of_a_run_are_in_its_json_csv_and_page_and_in_what_show_prints)
{
    ASSERT_EQ(run(job_ + "--out r.json").code, 0);
    const Keys keys = recorded("r.json");
    EXPECT_GT(keys.size(), 50u);
    EXPECT_EQ(without_column(keys, run(job_ + "--format csv").out), Keys());
    EXPECT_EQ(without_column(keys, run("show r.json --format csv").out), Keys());
    ASSERT_EQ(run("report r.json --out page.html").code, 0);
    const std::string page = file("page.html");
    for (const RowField& field : row_fields()) {
        const bool is_shown = field.report.title != nullptr && keys.contains(key_of(field));
        EXPECT_TRUE(!is_shown || contains(page, field.report.title)) << key_of(field);
    }
}

TEST_F(Columns, of_shards_come_back_when_they_are_merged)
{
    for (const char* shard : {"1", "2"})
        ASSERT_EQ(run(fmt::format("{}--shard {}/2 --out {}.json", job_, shard, shard)).code, 0);
    ASSERT_EQ(run("merge 1.json 2.json --out all.json").code, 0);
    Keys expected = recorded("1.json");
    expected.erase("hit_hash"); // of hits, which no shard has all of; views_hash is known
    const Keys merged = recorded("all.json");
    for (const std::string& key : expected)
        EXPECT_TRUE(merged.contains(key)) << key;
    EXPECT_EQ(without_column(merged, run("show all.json --format csv").out), Keys());
}
