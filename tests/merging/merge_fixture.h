#pragma once

#include "tests/reproduce/journal_lines.h"
#include "tests/support/program_fixture.h"

#include <functional>
#include <map>
#include <nlohmann/json.hpp>

namespace tetrace::test {

/// Shards of a run in a folder of its own, and their merging.
class MergeTest : public ProgramTest {
protected:
    using Json = nlohmann::json;

    /// The results of shards 1 to n of the command, with their journals, in 1.json, 2.json and so on; the names of
    /// these files. A shard runs once for all tests of a process that want the same.
    std::string shards(const std::string& command, unsigned n)
    {
        static std::map<std::string, std::pair<std::string, std::string>> made; // result and journal
        std::string files;
        for (unsigned number = 1; number <= n; ++number) {
            const std::string name = fmt::format("{}.json", number);
            auto& [result, journal] = made[fmt::format("{} {}/{}", command, number, n)];
            if (result.empty()) {
                const Ended ended = run(fmt::format("{} --shard {}/{} --out {}", command, number, n, name));
                EXPECT_EQ(ended.code, 0) << ended.errors;
                result = file(name.c_str()), journal = file((name + ".journal").c_str());
            }
            write_file(folder_ / name, result);
            write_file(folder_ / (name + ".journal"), journal);
            files += name + " ";
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
