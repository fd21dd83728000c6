#include "bench/output/report.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "scenes/cache.h"
#include "scenes/catalogue.h"
#include "scenes/pinned.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

Table catalogue_table()
{
    Table table({{"scene", "scene"}, {"status", "status"}, {"description", "description"}});
    for (const CatalogueEntry& entry : catalogue())
        table.add({entry.name, std::string(why_not_available(entry.name).empty() ? "available" : "missing"),
                   entry.description});
    for (const PinnedScene& pinned : pinned_scenes()) {
        const std::string name(pinned.name);
        table.add({name, std::string(why_not_available(name).empty() ? "available" : "missing"),
                   fmt::format("{} with pinned tets, the same in every version of tetrace", pinned.of)});
    }
    return table;
}

/// One remedy often applies to several scenes.
void add_remedies(Sheet& sheet)
{
    std::vector<std::string> reasons;
    for (const CatalogueEntry& entry : catalogue()) {
        const std::string reason = why_not_available(entry.name);
        if (!reason.empty() && std::ranges::find(reasons, reason) == reasons.end()) reasons.push_back(reason);
    }
    for (const std::string& reason : reasons)
        sheet.prose("missing: " + reason);
    if (!reasons.empty()) sheet.gap();
}

Table cache_table(const std::vector<CachedFile>& files)
{
    Table table({{"file", "file"}, {"bytes", "size", "bytes"}});
    for (const CachedFile& file : files)
        table.add({file.path.filename().string(), file.bytes});
    return table;
}

bool is_program(const CachedFile& file)
{
    return file.path.parent_path().filename() == "programs";
}

std::uint64_t bytes_of(const std::vector<CachedFile>& files)
{
    std::uint64_t bytes = 0;
    for (const CachedFile& file : files)
        bytes += file.bytes;
    return bytes;
}

/// Each file but the compiled programs, hundreds whose names say nothing: those are one line.
void add_cache(Sheet& sheet, const std::vector<CachedFile>& files)
{
    sheet.line(fmt::format("cache {}: {}, {}", cache_directory().string(), counted(files.size(), "file", "files"),
                           size_text(bytes_of(files))));
    std::vector<CachedFile> others, programs;
    for (const CachedFile& file : files)
        (is_program(file) ? programs : others).push_back(file);
    Table table = cache_table(others);
    if (!programs.empty())
        table.add({counted(programs.size(), "compiled program", "compiled programs"), bytes_of(programs)});
    if (!files.empty()) sheet.table(table);
}

} // namespace

int scenes_command(const Options& options)
{
    check_output(options);
    const std::uint64_t cleared = options.clear ? clear_cache() : 0;
    const Table scenes = catalogue_table();
    const auto files = list_cache();
    Report report{{}, scenes, result_head(options)};
    report.sheet.table(scenes, 0);
    report.sheet.gap();
    add_remedies(report.sheet);
    if (options.clear) report.sheet.line(fmt::format("cleared {} from the cache", size_text(cleared)));
    add_cache(report.sheet, files);
    report.json["scenes"] = to_json(scenes);
    report.json["cache"] = {{"directory", cache_directory().string()}, {"files", to_json(cache_table(files))}};
    if (options.clear) report.json["cache"]["cleared_bytes"] = cleared;
    report.json = {{"tetrace", report.json}};
    deliver(options, report);
    return 0;
}

} // namespace tetrace
