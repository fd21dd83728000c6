#include "bench/merging/shard_results.h"

#include "bench/options/identity.h"
#include "core/base/error.h"
#include "core/base/hash.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace tetrace {

namespace {

[[noreturn]] void refuse(const std::string& why)
{
    throw Error(ErrorKind::usage, "merging shards: " + why);
}

std::string text_at(const ShardResult& shard, const char* key)
{
    return shard.result.section().at(key).text();
}

/// What a key of the heads is in both, if it differs.
void require_same(const ShardResult& a, const ShardResult& b, const char* what, const std::string& in_a,
                  const std::string& in_b)
{
    if (in_a != in_b) refuse(fmt::format("another {}: {} in {}, {} in {}", what, in_a, a.name(), in_b, b.name()));
}

void require_same_heads(const ShardResult& a, const ShardResult& b)
{
    for (const char* key : {"verb", "commit", "version", "compiler", "flags"})
        require_same(a, b, key, text_at(a, key), text_at(b, key));
    require_same(a, b, "number of shards", std::to_string(a.shard.of), std::to_string(b.shard.of));
    require_same(a, b, "command line", fmt::format("'{}'", fmt::join(a.arguments, " ")),
                 fmt::format("'{}'", fmt::join(b.arguments, " ")));
}

/// A scene without a view in one shard is only in the others.
void require_same_scenes(const ShardResult& a, const ShardResult& b)
{
    for (const ResultScene& scene : a.result.scenes)
        if (const ResultScene* other = b.result.find_scene(scene.name))
            require_same(a, b, fmt::format("scene {} (its hash)", scene.name).c_str(), scene.hash, other->hash);
}

bool has_scene(const ShardResult& shard, const std::string& name)
{
    return std::ranges::any_of(shard.result.rows, [&](const ResultRow& row) { return row.scene == name; });
}

void require_rows_of(const ShardResult& a, const ShardResult& b)
{
    for (const ResultRow& row : a.result.rows)
        if (has_scene(b, row.scene) && b.result.find_row(row.name) == nullptr)
            refuse(fmt::format("other rows: {} is in {}, and not in {}", row.name, a.name(), b.name()));
}

[[noreturn]] void refuse_journal(const ShardResult& shard)
{
    refuse(fmt::format("the journal '{}' is not that of {}", journal_file(shard.result.path).string(), shard.name()));
}

void require_all(const std::vector<ShardResult>& shards)
{
    for (std::size_t i = 1; i < shards.size(); ++i)
        if (shards[i].shard == shards[i - 1].shard)
            refuse(fmt::format("shard {} is doubled: '{}' and '{}'", text_of(shards[i].shard),
                               shards[i - 1].result.path.string(), shards[i].result.path.string()));
    std::vector<std::string> missing;
    for (unsigned number = 1; number <= shards.front().shard.of; ++number)
        if (std::ranges::none_of(shards, [&](const ShardResult& one) { return one.shard.number == number; }))
            missing.push_back(text_of(Shard{number, shards.front().shard.of}));
    if (!missing.empty())
        refuse(fmt::format("{} {} missing: {}", missing.size() == 1 ? "shard" : "shards",
                           missing.size() == 1 ? "is" : "are", fmt::join(missing, ", ")));
}

/// Entries mean what the program means that wrote them.
void require_own_commit(const ShardResult& shard)
{
    const BuildIdentity program = build_identity();
    if (text_at(shard, "commit") != program.commit)
        refuse(fmt::format("{} is of commit {}, and this program of {}; merge with the program that wrote it",
                           shard.name(), text_at(shard, "commit"), program.commit));
}

} // namespace

std::string ShardResult::name() const
{
    return fmt::format("shard {} ('{}')", text_of(shard), result.path.string());
}

std::filesystem::path shard_file(const std::filesystem::path& out, const Shard& shard)
{
    const std::string name =
        fmt::format("{}.shard-{}-of-{}{}", out.stem().string(), shard.number, shard.of, out.extension().string());
    return out.parent_path() / name;
}

ShardResult read_shard(const std::filesystem::path& path)
{
    ShardResult shard;
    shard.result = read_result(path);
    const auto head = shard.result.section().find("shard");
    if (!head)
        refuse(fmt::format("'{}' is not a shard's result: 'tetrace {} --shard K/N' writes one", path.string(),
                           shard.result.head.verb));
    const auto number_at = [&](const char* key) {
        const ResultValue value = head->at(key);
        if (value.count() < 1 || value.count() > max_shards) value.reject("is not the number of a shard");
        return static_cast<unsigned>(value.count());
    };
    shard.shard = {number_at("number"), number_at("of")};
    for (const ResultValue& argument : head->at("arguments").items())
        shard.arguments.push_back(argument.text());
    shard.job = head->text_at("job");
    shard.journal = read_journal(journal_file(path));
    if (shard.journal.head.value("shard", "") != text_of(shard.shard)) refuse_journal(shard);
    if (!shard.journal.finished)
        refuse(fmt::format("{} did not end; repeat its command line with --resume", shard.name()));
    return shard;
}

std::vector<ShardResult> read_shards(const std::vector<std::filesystem::path>& results)
{
    std::vector<ShardResult> shards;
    for (const auto& path : results)
        shards.push_back(read_shard(path));
    std::ranges::stable_sort(shards, {}, [](const ShardResult& one) { return one.shard.number; });
    for (std::size_t i = 1; i < shards.size(); ++i) {
        require_same_heads(shards.front(), shards[i]);
        require_same_scenes(shards.front(), shards[i]);
        require_rows_of(shards.front(), shards[i]);
        require_rows_of(shards[i], shards.front());
    }
    require_all(shards);
    require_own_commit(shards.front());
    for (const ShardResult& shard : shards)
        if (shard.journal.head.value("commit", "") != text_at(shard, "commit")) refuse_journal(shard);
    return shards;
}

} // namespace tetrace
