#include "bench/output/report.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "scenes/cache.h"
#include "scenes/catalogue.h"

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
    return table;
}

/// One remedy often applies to several scenes.
std::string remedies()
{
    std::vector<std::string> reasons;
    for (const CatalogueEntry& entry : catalogue()) {
        const std::string reason = why_not_available(entry.name);
        if (!reason.empty() && std::ranges::find(reasons, reason) == reasons.end()) reasons.push_back(reason);
    }
    std::string text;
    for (const std::string& reason : reasons)
        text += wrapped("missing: " + reason, 100, 0);
    return text.empty() ? text : text + "\n";
}

Table cache_table(const std::vector<CachedFile>& files)
{
    Table table({{"file", "file"}, {"bytes", "size", "bytes"}});
    for (const CachedFile& file : files)
        table.add({file.path.filename().string(), file.bytes});
    return table;
}

std::string cache_text(const std::vector<CachedFile>& files)
{
    std::uint64_t bytes = 0;
    for (const CachedFile& file : files)
        bytes += file.bytes;
    const std::string head = fmt::format("cache {}: {} {}, {}\n", cache_directory().string(), files.size(),
                                         files.size() == 1 ? "file" : "files", size_text(bytes));
    return files.empty() ? head : head + cache_table(files).text(2);
}

} // namespace

int scenes_command(const Options& options)
{
    check_output(options);
    const std::uint64_t cleared = options.clear ? clear_cache() : 0;
    const Table scenes = catalogue_table();
    const auto files = list_cache();
    Report report{scenes.text() + "\n" + remedies(), scenes, result_head(options)};
    if (options.clear) report.text += fmt::format("cleared {} from the cache\n", size_text(cleared));
    report.text += cache_text(files);
    report.json["scenes"] = to_json(scenes);
    report.json["cache"] = {{"directory", cache_directory().string()}, {"files", to_json(cache_table(files))}};
    if (options.clear) report.json["cache"]["cleared_bytes"] = cleared;
    report.json = {{"tetrace", report.json}};
    deliver(options, report);
    return 0;
}

} // namespace tetrace
