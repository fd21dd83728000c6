#include "bench/report/campaign/campaign.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

const char* const how_to_read_machines =
    "A machine is a CPU with a number of threads, the devices emulated on it, or a GPU. Hosts are distinguished by "
    "--label of the run, or else by their CPU's name, family, model and stepping, or by folder if a result does not "
    "have these: give equal hosts different labels.";

std::vector<const CampaignResult*> results_of(const Campaign& campaign, std::size_t machine)
{
    std::vector<const CampaignResult*> results;
    for (const CampaignResult& result : campaign.results)
        if (std::ranges::find(result.machines, machine) != result.machines.end()) results.push_back(&result);
    return results;
}

std::size_t works_of(const Campaign& campaign, std::size_t machine)
{
    std::size_t count = 0;
    for (const CampaignGroup& group : campaign.groups)
        count += static_cast<std::size_t>(std::ranges::count_if(
            group.works, [&](const CampaignWork& work) { return work.newest_of(machine) != nullptr; }));
    return count;
}

Html link(const std::string& anchor, const std::string& plain)
{
    return element("a", {{"href", "#" + anchor}}, text(plain));
}

Html date_html(const CampaignResult& result)
{
    return text_element("span", "date", minute_of(result.head.date));
}

Html machine_table(const Campaign& campaign)
{
    HtmlTable table({{"machine"},
                     {"name"},
                     {"type"},
                     {"results", {}, true},
                     {"works", {}, true},
                     {"first", "UTC"},
                     {"last", "UTC"},
                     {"trends"}});
    for (std::size_t i = 0; i < campaign.machines.size(); ++i) {
        const CampaignMachine& machine = campaign.machines[i];
        const auto results = results_of(campaign, i);
        table.add({text_element("b", "", campaign.letter(i)), text(machine.name),
                   text_element("span", machine.kind == DeviceKind::emulated ? "type emulated" : "type",
                                std::string(name_of(machine.kind))),
                   text(std::to_string(results.size())), text(std::to_string(works_of(campaign, i))),
                   date_html(*results.front()), date_html(*results.back()),
                   has_trend(campaign, i) ? link(trend_anchor(campaign, i), "over dates") : Html()});
    }
    return table.empty() ? Html() : heading("Machines") + table.html() + note(how_to_read_machines);
}

std::string statuses_text(const CampaignResult& result)
{
    std::vector<std::string> parts;
    for (const auto& [status, count] : result.statuses)
        parts.push_back(fmt::format("{} {}", count, name_of(status)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string letters_of(const Campaign& campaign, const CampaignResult& result)
{
    std::vector<std::string> letters;
    for (const std::size_t machine : result.machines)
        letters.push_back(campaign.letter(machine));
    return fmt::format("{}", fmt::join(letters, " "));
}

Html result_table(const Campaign& campaign)
{
    HtmlTable table({{"date", "UTC"},
                     {"machines"},
                     {"file"},
                     {"verb"},
                     {"commit"},
                     {"host"},
                     {"system"},
                     {"rows"},
                     {"noisy", "of timed", true},
                     {"others", "processors", true}});
    for (const CampaignResult& result : campaign.results)
        table.add({date_html(result), text(letters_of(campaign, result)),
                   text_element("code", "", (result.path.parent_path().filename() / result.path.filename()).string()),
                   text(result.head.verb), text_element("code", "", result.head.commit), text(result.head.machine),
                   text(result.head.system), text(statuses_text(result)),
                   text(result.timed > 0 ? fmt::format("{} of {}", result.noisy, result.timed) : ""),
                   text(result.others)});
    return table.html();
}

Html left_out_list(const Campaign& campaign)
{
    Html items;
    for (const auto& [path, reason] : campaign.left_out)
        items += text_element("li", "", reason);
    return items.empty() ? items : heading("Left out") + element("ul", {{"class", "missing"}}, items);
}

} // namespace

Section index_section(const Campaign& campaign)
{
    return {"index", "Index",
            machine_table(campaign) + heading("Results, by date") + result_table(campaign) + left_out_list(campaign)};
}

} // namespace tetrace
