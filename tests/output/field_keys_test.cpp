// The keys of rows: in the sources of the program, bench/results/row_keys.h and row_fields() alone name them.
#include "bench/output/row_fields.h"
#include "tests/house/checkout.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using KeyNames = std::set<std::string>;

/// Those that other objects of JSON have, too, so that a source may name them.
const KeyNames ambiguous_keys = {
    "bvh_build_s", "build_s",      "pack_s",   "triangles",           // of a scene and its builds
    "first_wrong", "device_index", "wrong",                           // of a defect's run
    "nodes",       "rays",         "steps",    "ray_order", "visits", // of `trace`
    "lost",        "reversed",                                        // also words that are printed
    "fastest_s",   "runs",         "self_test"};                      // of calibrations, of a result, of a device

/// Files that name keys for another reason.
const KeyNames files_with_keys = {"bench/output/row_fields.cpp", "bench/output/comparison_fields.cpp",
                                  "bench/results/row_keys.h",
                                  "bench/measuring/image_record.cpp"}; // the journal's form of a view

/// The keys of what results record of rows: those in an object of the row, that object's own, and any with an
/// underscore. Others, such as "name", are keys of most objects.
KeyNames keys_of_rows()
{
    KeyNames keys;
    for (const RowField& field : row_fields()) {
        const std::string group = field.group, key = field.key;
        if (field.schema == nullptr || group == ratio_group) continue;
        if (!group.empty() || key.find('_') != std::string::npos) keys.insert(key);
        if (!group.empty()) keys.insert(group);
    }
    return keys;
}

/// Whether a text in quotes is an argument of a call, as of find("key") or count_at(row, "key"), or is read as ["key"].
/// begin, end: of its quotes.
bool is_looked_up(const std::string& source, std::size_t begin, std::size_t end)
{
    const std::size_t before = source.find_last_of("\"(){};[", begin - 1);
    if (before == std::string::npos || before == 0) return false;
    const std::string after = source.substr(end + 1, 4);
    if (source[before] == '[')
        return before + 1 == begin && after.starts_with("]") && (!after.starts_with("] = ") || after[3] == '=');
    const char of_name = source[before - 1];
    return source[before] == '(' && (std::isalnum(static_cast<unsigned char>(of_name)) != 0 || of_name == '_') &&
           (after.starts_with(")") || after.starts_with(","));
}

/// Whether a text in quotes is in a list of keys: of an array, as in keys[] = {"a", "b"}, or of a loop, as in
/// for (const char* key : {"a", "b"}).
bool is_in_list(const std::string& source, std::size_t begin)
{
    const std::size_t brace = source.find_last_of("{}();", begin);
    if (brace == std::string::npos || source[brace] != '{') return false;
    const std::size_t before = source.find_last_not_of(" \n", brace - 1);
    if (before == std::string::npos) return false;
    const std::string head = source.substr(0, before + 1);
    return head.ends_with(" :") || head.ends_with("[] =");
}

KeyNames keys_looked_up(const std::string& source, const KeyNames& keys)
{
    KeyNames found;
    for (const std::string& key : keys) {
        const std::string quoted = "\"" + key + "\"";
        for (std::size_t at = source.find(quoted); at != std::string::npos; at = source.find(quoted, at + 1))
            if (is_looked_up(source, at, at + quoted.size() - 1) || is_in_list(source, at)) found.insert(key);
    }
    return found;
}

} // namespace

TEST(FieldKeys, are_named_only_by_their_header_and_the_table_of_fields)
{
    const KeyNames keys = keys_of_rows();
    KeyNames ambiguous;
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(checkout / "bench")) {
        const std::string file = entry.path().lexically_relative(checkout).string();
        if ((!file.ends_with(".cpp") && !file.ends_with(".h")) || files_with_keys.contains(file)) continue;
        ++files;
        for (const std::string& key : keys_looked_up(read_text(entry.path()), keys))
            if (ambiguous_keys.contains(key))
                ambiguous.insert(key);
            else
                ADD_FAILURE() << file << " names the key \"" << key << "\": use bench/results/row_keys.h";
    }
    EXPECT_GT(files, 200u);
    EXPECT_EQ(ambiguous, ambiguous_keys) << "each exception is needed";
}

TEST(FieldKeys, are_found_wherever_a_source_looks_them_up)
{
    const KeyNames keys = keys_of_rows();
    for (const std::string source :
         {R"(row.find("mrays_per_s"))", R"(rates->at("mrays_per_s").number())", R"(read_member(to, row,
        "mrays_per_s");)",
          R"(row["mrays_per_s"].get<double>())", R"(if (row["mrays_per_s"] == 1))", R"(row.value("mrays_per_s", 0.0))",
          R"(const char* const shared[] = {"name", "mrays_per_s", "status"};)",
          R"(for (const char* key : {"name", "mrays_per_s"}))"})
        EXPECT_EQ(keys_looked_up(source, keys), KeyNames{"mrays_per_s"}) << source;
    for (const std::string source : {R"(object["mrays_per_s"] = 1;)", R"(Column{"mrays_per_s", "Mrays/s"})",
                                     R"(row.find(row_key::mrays_per_s))", R"(row.find("name"))"})
        EXPECT_EQ(keys_looked_up(source, keys), KeyNames()) << source;
    EXPECT_TRUE(keys.contains("times") && keys.contains("noisy") && keys.contains("hit_hash"));
}
