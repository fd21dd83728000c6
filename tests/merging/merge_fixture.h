#pragma once

#include "tests/reproduce/journal_lines.h"
#include "tests/support/program_fixture.h"

#include <functional>
#include <nlohmann/json.hpp>

namespace tetrace::test {

/// Shards of a run in a folder of its own, and their merging.
class MergeTest : public ProgramTest {
protected:
    using Json = nlohmann::json;

    /// Runs shards 1 to n of the command into 1.json, 2.json and so on; the names of these files.
    std::string shards(const std::string& command, unsigned n)
    {
        std::string files;
        for (unsigned number = 1; number <= n; ++number) {
            const Ended ended = run(fmt::format("{} --shard {}/{} --out {}.json", command, number, n, number));
            EXPECT_EQ(ended.code, 0) << ended.errors;
            files += fmt::format("{}.json ", number);
        }
        return files;
    }

    [[nodiscard]] Json section(const char* name) const { return Json::parse(file(name)).at("tetrace"); }

    void change(const char* name, const std::function<void(Json& section)>& changes)
    {
        Json json = Json::parse(file(name));
        changes(json["tetrace"]);
        write_file(folder_ / name, json.dump());
    }

    /// What merging says where it refuses with exit code 2.
    std::string refusal(const std::string& arguments)
    {
        const Ended ended = run("merge " + arguments + " --out refused.json");
        EXPECT_EQ(ended.code, 2) << ended.out;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.json"));
        return ended.errors;
    }
};

/// Only these keys of each object.
inline nlohmann::json keys_of(const nlohmann::json& list, const std::vector<const char*>& keys)
{
    nlohmann::json all = nlohmann::json::array();
    for (const nlohmann::json& object : list) {
        nlohmann::json kept = nlohmann::json::object();
        for (const char* key : keys)
            kept[key] = object.value(key, nlohmann::json());
        all.push_back(std::move(kept));
    }
    return all;
}

} // namespace tetrace::test
