#include "bench/report/campaign/campaign.h"
#include "bench/report/charts/axis.h"
#include "bench/report/charts/bar_chart.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace tetrace {

namespace {

const char* const how_to_read_comparison =
    "Millions of rays (or of searches) per second, from the median sample of each machine's newest result. Below "
    "each: its ratio to the rate of the first machine of the table. A line is the same work on all its machines: "
    "the same kernel, scene, views and size, and the same hits, bit for bit. Work that only one machine has done is "
    "not shown. NOISY, as in 'tetrace compare': calibration during the row's samples took 1.25 times its fastest, "
    "so the ratio may be the machine's; the means exclude such a row. noisy: by the row's own samples. Emulated "
    "devices are APIs of GPUs that run on "
    "the CPU, and say nothing about a GPU.";

std::size_t machines_with(const CampaignWork& work, const std::vector<std::size_t>& machines)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(machines, [&](std::size_t machine) { return work.newest_of(machine) != nullptr; }));
}

/// The works that several machines did.
std::vector<const CampaignWork*> shared_works(const CampaignGroup& group, const std::vector<std::size_t>& machines)
{
    std::vector<const CampaignWork*> works;
    for (const CampaignWork& work : group.works)
        if (machines_with(work, machines) > 1) works.push_back(&work);
    return works;
}

/// Of these works, the machines that did any.
std::vector<std::size_t> sharing_machines(const std::vector<const CampaignWork*>& works,
                                          const std::vector<std::size_t>& machines)
{
    std::vector<std::size_t> sharing;
    for (const std::size_t machine : machines)
        if (std::ranges::any_of(works, [&](const CampaignWork* work) { return work->newest_of(machine) != nullptr; }))
            sharing.push_back(machine);
    return sharing;
}

Html rate_cell(const CampaignRate* rate, const CampaignRate* first)
{
    if (rate == nullptr) return {};
    Html value = text(short_number(rate->mrays_per_s));
    if (rate->pulse.is_noisy() || rate->noisy)
        value += text_element("small", "", rate->pulse.is_noisy() ? "NOISY" : "noisy");
    if (first == nullptr || first == rate) return value;
    return value + text_element("small", "", fmt::format("× {:.2f}", rate->mrays_per_s / first->mrays_per_s));
}

/// The geometric mean of a machine's ratios to the first, over the works that both have, noisy ones left out.
struct Mean {
    double ratio = 1;
    std::size_t works = 0;
    std::size_t noisy = 0; ///< those of which a rate is not to be relied on

    [[nodiscard]] std::string note() const
    {
        return counted(works, "work", "works") + (noisy > 0 ? fmt::format(", {} noisy", noisy) : "");
    }
};

std::optional<Mean> mean_over(const std::vector<const CampaignWork*>& works, std::size_t first, std::size_t machine)
{
    double sum = 0;
    Mean mean;
    for (const CampaignWork* work : works) {
        const CampaignRate *a = work->newest_of(first), *b = work->newest_of(machine);
        if (a == nullptr || b == nullptr || a->pulse.is_noisy() || b->pulse.is_noisy()) continue;
        sum += std::log(b->mrays_per_s / a->mrays_per_s);
        ++mean.works;
        mean.noisy += a->noisy || b->noisy;
    }
    if (mean.works == 0) return std::nullopt;
    mean.ratio = std::exp(sum / static_cast<double>(mean.works));
    return mean;
}

std::string column_title(const Campaign& campaign, std::size_t machine)
{
    return fmt::format("{}: {}", campaign.letter(machine), campaign.machines[machine].name);
}

Html rate_table(const Campaign& campaign, const std::vector<const CampaignWork*>& works,
                const std::vector<std::size_t>& machines)
{
    std::vector<HtmlColumn> columns = {{"row"}};
    for (const std::size_t machine : machines)
        columns.push_back({column_title(campaign, machine), {}, true});
    HtmlTable table(columns);
    for (const CampaignWork* work : works) {
        std::vector<Html> cells = {text(work->label)};
        for (const std::size_t machine : machines)
            cells.push_back(rate_cell(work->newest_of(machine), work->newest_of(machines.front())));
        table.add(std::move(cells));
    }
    return element("div", {{"class", "machines"}}, table.html());
}

/// Bars of the means; empty if no other machine shares work with the first.
Html mean_chart(const Campaign& campaign, const CampaignGroup& group, const std::vector<const CampaignWork*>& works,
                const std::vector<std::size_t>& machines)
{
    const std::string first = campaign.letter(machines.front());
    BarChart chart{fmt::format("Means of the rates over those of {}: {}", first, group.title),
                   fmt::format("× the rate of {}, geometric mean", first),
                   {}};
    for (const std::size_t machine : machines)
        if (const auto mean = mean_over(works, machines.front(), machine))
            chart.bars.push_back({campaign.letter(machine),
                                  column_title(campaign, machine),
                                  "",
                                  machine,
                                  mean->ratio,
                                  {},
                                  {},
                                  {},
                                  mean->note()});
    return chart.bars.size() < 2 ? Html() : figure("", draw(chart), "");
}

Html group_html(const Campaign& campaign, const CampaignGroup& group)
{
    const auto machines = machines_in(group);
    const auto works = shared_works(group, machines);
    if (works.empty()) return {};
    const auto sharing = sharing_machines(works, machines);
    Html html = heading(fmt::format("{}: {}", plural_of(group.kind), group.title));
    if (!group.hash.empty()) html += note("Scene " + group.hash + ".");
    html += mean_chart(campaign, group, works, sharing) + rate_table(campaign, works, sharing);
    const std::size_t alone = group.works.size() - works.size();
    if (alone > 0) html += note(counted(alone, "work is", "works are") + " not shown: no other machine did the same.");
    return html;
}

} // namespace

std::vector<std::size_t> machines_in(const CampaignGroup& group)
{
    std::set<std::size_t> machines;
    for (const CampaignWork& work : group.works)
        for (const CampaignRate& rate : work.rates)
            machines.insert(rate.machine);
    return {machines.begin(), machines.end()};
}

Section machines_section(const Campaign& campaign)
{
    Section section{"compared-machines", "Machines compared", {}};
    for (const CampaignGroup& group : campaign.groups)
        section.content += group_html(campaign, group);
    if (section.content.empty()) return section;
    section.content = note(how_to_read_comparison) + section.content;
    return section;
}

} // namespace tetrace
