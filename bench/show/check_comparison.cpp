#include "bench/show/check_comparison.h"

#include "bench/measuring/conformity.h"
#include "bench/options/name_filter.h"
#include "bench/output/compare_report.h"
#include "bench/results/self_test_json.h"
#include "bench/show/recorded_rows.h"
#include "bench/terminal/text.h"
#include "core/base/printable.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

CheckedItem item_of(const RowRecord& row)
{
    const Finding finding = finding_of(row, false);
    return {row_name(row.key),
            std::string(name_of(finding)),
            conformity_text(row),
            fails(finding),
            finding != Finding::skipped && finding != Finding::unsupported,
            reason_of(row)};
}

void add_self_tests(std::vector<CheckedItem>& items, const std::vector<RowRecord>& rows)
{
    std::set<std::string> devices;
    for (const RowRecord& row : rows) {
        const std::string device = device_label(row.key);
        if (!row.self_test || row.key.kernel.math != MathMode::exact || !devices.insert(device).second) continue;
        const nlohmann::json findings = self_test_json(*row.self_test);
        for (const auto& [key, value] : findings.items())
            if (key != "text")
                items.push_back({fmt::format("self_test/{} on {}", key, device), value.dump(), value.dump()});
    }
}

CheckedItem item_of_defect(const ResultValue& run)
{
    const std::string outcome = run.at("outcome").line();
    const std::uint64_t device = run.at("device_index").count();
    return {fmt::format("defect/{} on {}", run.at("defect").line(), api_name(run.at("backend").line(), device)),
            outcome,
            outcome,
            outcome == "seen" || outcome == "error",
            outcome != "skipped",
            printable_text(run.text_at("reason"))};
}

std::vector<CheckedItem> items_of(const ResultFile& file, const NameFilter& names)
{
    std::vector<CheckedItem> items;
    const std::vector<RowRecord> rows = file.rows.empty() ? std::vector<RowRecord>() : read_rows(file);
    for (const RowRecord& row : rows)
        items.push_back(item_of(row));
    add_self_tests(items, rows);
    if (const auto defects = file.section().find("defects"))
        for (const ResultValue& run : defects->items())
            items.push_back(item_of_defect(run));
    std::erase_if(items, [&](const CheckedItem& item) { return !names.keeps(item.name); });
    return items;
}

CheckChange change_of(const ComparedItem& item)
{
    const bool was = item.before && item.before->has_result, is = item.after && item.after->has_result;
    if (was != is) return was ? CheckChange::missing : CheckChange::added;
    if (!was || item.before->finding == item.after->finding) return CheckChange::same;
    if (item.before->fails == item.after->fails) return CheckChange::changed;
    return item.after->fails ? CheckChange::became_wrong : CheckChange::became_right;
}

bool is_self_test(const CheckedItem& item)
{
    return item.name.starts_with("self_test/");
}

const CheckedItem* find_item(const std::vector<CheckedItem>& items, const std::string& name)
{
    const auto found = std::ranges::find(items, name, &CheckedItem::name);
    return found == items.end() ? nullptr : &*found;
}

std::vector<ComparedItem> paired(const std::vector<CheckedItem>& before, const std::vector<CheckedItem>& after)
{
    std::vector<ComparedItem> items;
    for (const CheckedItem& item : before) {
        const CheckedItem* const other = find_item(after, item.name);
        if (other != nullptr)
            items.push_back({item, *other});
        else if (!is_self_test(item))
            items.push_back({item, std::nullopt});
    }
    for (const CheckedItem& item : after)
        if (find_item(before, item.name) == nullptr && !is_self_test(item)) items.push_back({std::nullopt, item});
    for (ComparedItem& item : items)
        item.change = change_of(item);
    return items;
}

std::string shown_text(const std::optional<CheckedItem>& item)
{
    return item ? item->shown : std::string();
}

Table changes_table(const CheckComparison& comparison)
{
    Table table({{"name", "row"},
                 {.key = "before", .title = "A", .rank = 2},
                 {.key = "after", .title = "B", .rank = 2},
                 {.key = "verdict", .title = "verdict", .coloured = true, .rank = 0}});
    for (const ComparedItem& item : comparison.items)
        if (item.change != CheckChange::same)
            table.add({item.name(), text_cell(shown_text(item.before)), text_cell(shown_text(item.after)),
                       std::string(name_of(item.change))});
    return table;
}

Table all_items_table(const CheckComparison& comparison)
{
    Table table({{"name", "name"}, {"verdict", "verdict"}, {"before", "A"}, {"after", "B"}, {"note", "note"}});
    for (const ComparedItem& item : comparison.items)
        table.add({item.name(), std::string(name_of(item.change)), text_cell(shown_text(item.before)),
                   text_cell(shown_text(item.after)), text_cell(item.note())});
    return table;
}

std::string compared_text(const CheckComparison& comparison)
{
    std::string text;
    for (const CheckChange change :
         {CheckChange::became_wrong, CheckChange::became_right, CheckChange::changed, CheckChange::added,
          CheckChange::missing, CheckChange::different, CheckChange::same})
        if (const std::size_t count = comparison.count(change); count > 0)
            append_item(text, ", ", fmt::format("{} {}", count, name_of(change)));
    return fmt::format("{}, self-tests included: {}.", counted(comparison.items.size(), "result", "results"), text);
}

/// Both, for the devices of rows and what else differs.
ResultComparison whole_comparison(const CheckComparison& comparison)
{
    ResultComparison whole{comparison.before, comparison.after, 0, {}};
    for (const ResultRow& row : comparison.before->rows)
        if (const ResultRow* const other = comparison.after->find_row(row.name))
            whole.rows.push_back({&row, other, RowOutcome::compared, {}, {}});
    return whole;
}

Sheet changes_sheet(const CheckComparison& comparison, bool allow_missing)
{
    Sheet sheet = comparison_head(whole_comparison(comparison));
    sheet.gap();
    if (const Table table = changes_table(comparison); !table.rows().empty()) {
        sheet.table(table);
        sheet.gap();
    }
    for (const ComparedItem& item : comparison.items)
        if (item.change != CheckChange::same && !item.note().empty())
            sheet.line(fmt::format("{}: {}", item.name(), item.note()));
    sheet.labelled("Compared", compared_text(comparison));
    for (const ComparedItem* item : comparison.regressions(allow_missing))
        sheet.labelled("Regressed", fmt::format("{}: {}.", item->name(), name_of(item->change)));
    return sheet;
}

} // namespace

bool is_check(const ResultFile& file)
{
    return file.head.verb == name_of(Verb::check);
}

std::string ComparedItem::note() const
{
    if (!difference.empty()) return difference;
    for (const auto& [label, item] : {std::pair("B", &after), std::pair("A", &before)}) {
        if (!*item) return fmt::format("{}: no such row", label);
        if (!(*item)->reason.empty()) return fmt::format("{}: {}: {}", label, (*item)->finding, (*item)->reason);
    }
    return {};
}

std::size_t CheckComparison::count(CheckChange change) const
{
    return static_cast<std::size_t>(std::ranges::count(items, change, &ComparedItem::change));
}

std::vector<const ComparedItem*> CheckComparison::regressions(bool allow_missing) const
{
    std::vector<const ComparedItem*> found;
    for (const ComparedItem& item : items)
        if (item.change == CheckChange::became_wrong || (item.change == CheckChange::added && item.after->fails) ||
            (item.change == CheckChange::missing && !allow_missing))
            found.push_back(&item);
    return found;
}

CheckComparison compare_checks(const ResultFile& before, const ResultFile& after, const std::string& filter)
{
    const NameFilter names("--filter", filter);
    CheckComparison comparison{&before, &after, paired(items_of(before, names), items_of(after, names))};
    const auto reject = [&](ErrorKind kind, const std::string& why) {
        throw Error(kind, fmt::format("comparing the checks A, '{}', and B, '{}': {}", before.path.string(),
                                      after.path.string(), why));
    };
    if (comparison.items.empty())
        reject(filter.empty() ? ErrorKind::invalid_input : ErrorKind::usage,
               filter.empty() ? "neither has a result" : fmt::format("--filter '{}' matches no row", filter));
    bool any_same = false, any_shared = false;
    for (ComparedItem& item : comparison.items) {
        const ResultRow *const a = before.find_row(item.name()), *const b = after.find_row(item.name());
        if (a == nullptr || b == nullptr) continue;
        any_shared = true;
        item.difference = different_rays(before, *a, after, *b);
        if (!item.difference.empty()) item.change = CheckChange::different;
        any_same = any_same || item.difference.empty();
    }
    if (any_shared && !any_same)
        reject(ErrorKind::invalid_input,
               fmt::format(
                   "no row did the same work in both; {}: {}",
                   std::ranges::find(comparison.items, CheckChange::different, &ComparedItem::change)->name(),
                   std::ranges::find(comparison.items, CheckChange::different, &ComparedItem::change)->difference));
    if (std::ranges::none_of(comparison.items, [](const ComparedItem& item) { return item.before && item.after; }))
        reject(ErrorKind::invalid_input, fmt::format("they share no row; one has {}", comparison.items.front().name()));
    return comparison;
}

Report check_comparison_report(const CheckComparison& comparison, const Options& options)
{
    nlohmann::json section = result_head(options);
    const Table all = all_items_table(comparison);
    nlohmann::json& json = section["check_comparison"];
    json = {{"before", source_json(*comparison.before)},
            {"after", source_json(*comparison.after)},
            {"rows", to_json(all)},
            {"regressions", nlohmann::json::array()}};
    for (const ComparedItem* item : comparison.regressions(options.allow_missing))
        json["regressions"].push_back(item->name());
    Report report{changes_sheet(comparison, options.allow_missing), all, {{"tetrace", std::move(section)}}};
    check_columns(options, {"name", "before", "after", "verdict"});
    report.markdown = report.sheet.markdown({.columns = options.columns});
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

} // namespace tetrace
