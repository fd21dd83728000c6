#include "bench/show/recorded_rows.h"

#include "bench/output/row_fields.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::vector<std::filesystem::path> stored_results()
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(TETRACE_RESULTS))
        if (entry.path().extension() == ".json" && entry.path().filename() != "result.schema.json")
            files.push_back(entry.path());
    return files;
}

/// What a record holds of the row, as the result has it; a field that the result lacks is left out.
nlohmann::json stored_fields(const nlohmann::json& row, const nlohmann::json& of)
{
    nlohmann::json fields;
    for (const RowField& field : row_fields()) {
        if (field.schema == nullptr || !field.value.is_stored()) continue;
        const std::string path =
            *field.group == '\0' ? std::string("/") + field.key : std::string("/") + field.group + "/" + field.key;
        const nlohmann::json::json_pointer place(path);
        if (of.contains(place)) fields[path] = row.contains(place) ? row.at(place) : nlohmann::json("missing");
    }
    return fields;
}

} // namespace

/// Older results wrote these in another form.
class StoredRows : public testing::Test {
protected:
    static void drop_older_forms(nlohmann::json& fields)
    {
        fields.erase("/verification/first_wrong");
        if (!fields.contains("/self_test")) return;
        fields["/self_test"].erase("text");
        fields["/self_test"].erase("reassociates"); // a probe that older results lack
    }
};

TEST_F(StoredRows, come_back_from_every_stored_result_as_they_were_written)
{
    std::size_t compared = 0;
    for (const auto& path : stored_results()) {
        const ResultFile file = read_result(path);
        if (file.head.verb != "bench" && file.head.verb != "check" && file.head.verb != "reproduce") continue;
        const auto rows = read_rows(file);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const nlohmann::json& before = file.json["tetrace"]["rows"][i];
            nlohmann::json expected = stored_fields(before, before),
                           found = stored_fields(row_json(RowFacts(rows[i])), before);
            drop_older_forms(expected);
            drop_older_forms(found);
            ASSERT_EQ(found, expected) << path << " row " << i << nlohmann::json::diff(expected, found).dump(2);
            ++compared;
        }
    }
    EXPECT_GT(compared, 1000u);
}
