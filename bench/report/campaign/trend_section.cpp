#include "bench/report/campaign/campaign.h"
#include "bench/report/charts/axis.h"
#include "bench/report/charts/line_chart.h"
#include "bench/statistics/speed_verdict.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

const char* const how_to_read_trends =
    "Each machine's rates by date, of the same work only; a chart shows them relative to the first. 'Last step' "
    "compares the samples of the last date with those of the one before, 'in all' with those of the first: the "
    "ratio of medians with its interval; above 1 the row has become faster. SAME, FASTER, SLOWER, UNSURE and NOISY "
    "are those of 'tetrace compare' with a tolerance of 3 %; NOISY: the machine's own speed changed, as calibration "
    "shows. The index lists what changed between two dates: commit, driver or system.";

constexpr double tolerance = 0.03;

/// More lines than these are hard to read; the table has all.
constexpr std::size_t max_lines = 28;

/// A work of one machine on several dates.
struct Trend {
    const CampaignWork* work = nullptr;
    std::vector<const CampaignRate*> rates; ///< by date

    /// How far it went from its first rate, up or down.
    [[nodiscard]] double change() const
    {
        double most = 0;
        for (const CampaignRate* rate : rates)
            most = std::max(most, std::abs(std::log(rate->mrays_per_s / rates.front()->mrays_per_s)));
        return most;
    }
};

Trend trend_of(const Campaign& campaign, const CampaignWork& work, std::size_t machine)
{
    Trend trend{&work, {}};
    for (const CampaignRate& rate : work.rates)
        if (rate.machine == machine && campaign.results[rate.result].day) trend.rates.push_back(&rate);
    return trend;
}

std::vector<Trend> trends_of(const Campaign& campaign, const CampaignGroup& group, std::size_t machine)
{
    std::vector<Trend> trends;
    for (const CampaignWork& work : group.works)
        if (Trend trend = trend_of(campaign, work, machine); trend.rates.size() > 1) trends.push_back(std::move(trend));
    return trends;
}

std::vector<HtmlColumn> trend_columns()
{
    return {{"row"},
            {"dates", {}, true},
            {"first", "Mrays/s", true},
            {"last", "Mrays/s", true},
            {"last step", {}, true},
            {"verdict"},
            {"in all", {}, true},
            {"verdict"}};
}

Html ratio_html(const SpeedChange& change)
{
    const Html ratio = text(fmt::format("{:.3f}", change.ratio));
    if (!change.interval) return ratio;
    return ratio +
           text_element("small", "", fmt::format("{:.3f} to {:.3f}", change.interval->low, change.interval->high));
}

Html verdict_html(const SpeedChange& change, const CampaignRate& before, const CampaignRate& after)
{
    // A trend's rates are of one machine with as many threads.
    const std::string disturbance = disturbance_between(before.pulse, after.pulse, true, "the first", "the second");
    if (change.interval && !disturbance.empty())
        return element("span", {{"class", "badge neutral"}, {"title", disturbance}}, text("NOISY"));
    const char* const look = change.verdict == SpeedVerdict::slower   ? "badge bad"
                             : change.verdict == SpeedVerdict::faster ? "badge good"
                                                                      : "badge neutral";
    return text_element("span", look, std::string(name_of(change.verdict)));
}

Html trend_table(const std::vector<Trend>& trends)
{
    HtmlTable table(trend_columns());
    for (const Trend& trend : trends) {
        const auto& rates = trend.rates;
        const auto change_from = [&](const CampaignRate* before) {
            return compare_speed(before->samples_s, rates.back()->samples_s, trends.size(), tolerance);
        };
        const CampaignRate &first = *rates.front(), &last = *rates.back(), &previous = *rates[rates.size() - 2];
        const SpeedChange step = change_from(&previous), all = change_from(&first);
        table.add({text(trend.work->label), text(std::to_string(rates.size())), text(short_number(first.mrays_per_s)),
                   text(short_number(last.mrays_per_s)), ratio_html(step), verdict_html(step, previous, last),
                   ratio_html(all), verdict_html(all, first, last)});
    }
    return table.html();
}

Html trend_chart(const Campaign& campaign, std::vector<Trend> trends, const std::string& title)
{
    std::ranges::stable_sort(trends, [](const Trend& a, const Trend& b) { return a.change() > b.change(); });
    const std::size_t all = trends.size();
    if (all > max_lines) trends.resize(max_lines);
    LineChart chart{"Over dates: " + title, "date, UTC", "rate, relative to the first", {}};
    chart.x_dates = true;
    for (const Trend& trend : trends) {
        Series series{trend.work->label, {}};
        for (const CampaignRate* rate : trend.rates)
            series.points.emplace_back(*campaign.results[rate->result].day,
                                       rate->mrays_per_s / trend.rates.front()->mrays_per_s);
        chart.series.push_back(std::move(series));
    }
    const std::string caption =
        all > max_lines ? fmt::format("The {} of {} rows that changed most.", max_lines, all) : "";
    return figure("", draw(chart), caption);
}

/// Its trends, scene by scene; empty if it has none.
Html machine_trends(const Campaign& campaign, std::size_t machine)
{
    Html html;
    for (const CampaignGroup& group : campaign.groups) {
        const auto trends = trends_of(campaign, group, machine);
        if (trends.empty()) continue;
        const std::string title = fmt::format("{}, {}", campaign.machines[machine].name, group.title);
        html += text_element("h4", "", group.title) + trend_chart(campaign, trends, title) + trend_table(trends);
    }
    if (html.empty()) return html;
    return element("article", {{"id", trend_anchor(campaign, machine)}},
                   heading(fmt::format("{}: {}", campaign.letter(machine), campaign.machines[machine].name)) + html);
}

} // namespace

std::string trend_anchor(const Campaign& campaign, std::size_t machine)
{
    return "trend-" + campaign.letter(machine);
}

bool has_trend(const Campaign& campaign, std::size_t machine)
{
    return std::ranges::any_of(
        campaign.groups, [&](const CampaignGroup& group) { return !trends_of(campaign, group, machine).empty(); });
}

Section trend_section(const Campaign& campaign)
{
    Section section{"trends", "Over dates", {}};
    for (std::size_t machine = 0; machine < campaign.machines.size(); ++machine)
        section.content += machine_trends(campaign, machine);
    if (!section.content.empty()) section.content = note(how_to_read_trends) + section.content;
    return section;
}

} // namespace tetrace
