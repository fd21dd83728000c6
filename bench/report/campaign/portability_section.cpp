#include "bench/report/campaign/portability.h"
#include "bench/report/charts/line_chart.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <map>

namespace tetrace {

namespace {

const char* const how_to_read_cascades =
    "An application is an API with a layout of the scene, by its fastest row; its efficiency on a platform is that "
    "rate over the best application's there. A line has an application's efficiencies in descending order, and ends "
    "where there are no more platforms that ran it (a cascade plot: Sewall, Pennycook, Jacobsen, Deakin, "
    "McIntosh-Smith, 2020). P is their harmonic mean, and 0 if a platform did not run it (Pennycook, Sewall, Lee, "
    "2016). Only rows whose every ray is right count, and no emulated device.";

/// An application on the platforms of a problem.
struct Cascade {
    std::string application;
    std::map<std::string, const Efficiency*> platforms;
    double portability = 0;
    std::size_t missing = 0; ///< platforms of the problem that did not run it

    [[nodiscard]] std::vector<double> descending() const
    {
        std::vector<double> efficiencies;
        for (const auto& [platform, one] : platforms)
            efficiencies.push_back(one->efficiency);
        std::ranges::sort(efficiencies, std::greater());
        return efficiencies;
    }
    [[nodiscard]] bool is_noisy() const
    {
        return std::ranges::any_of(platforms, [](const auto& one) { return one.second->noisy; });
    }
    [[nodiscard]] std::string label() const
    {
        return fmt::format("{}  P {}{}", application, portability_text(), is_noisy() ? ", noisy" : "");
    }
    /// "0.77", or "0, on 4 of 5".
    [[nodiscard]] std::string portability_text() const
    {
        return missing == 0 ? fmt::format("{:.2f}", portability)
                            : fmt::format("0, on {} of {}", platforms.size(), platforms.size() + missing);
    }
};

/// A problem's platforms, in order of appearance, and its applications, the most portable first.
struct CascadeProblem {
    std::string name;
    std::vector<std::string> platforms;
    std::vector<Cascade> cascades;
};

std::vector<CascadeProblem> problems_of(const std::vector<Efficiency>& all)
{
    std::vector<CascadeProblem> problems;
    for (const Efficiency& one : all) {
        if (problems.empty() || problems.back().name != one.problem) problems.push_back({one.problem, {}, {}});
        CascadeProblem& problem = problems.back();
        if (problem.platforms.empty() || problem.platforms.back() != one.platform)
            problem.platforms.push_back(one.platform);
        auto cascade = std::ranges::find(problem.cascades, one.application, &Cascade::application);
        if (cascade == problem.cascades.end()) cascade = problem.cascades.insert(cascade, Cascade{one.application, {}});
        cascade->platforms[one.platform] = &one;
    }
    for (CascadeProblem& problem : problems) {
        for (Cascade& cascade : problem.cascades) {
            cascade.portability = performance_portability(cascade.descending(), problem.platforms.size());
            cascade.missing = problem.platforms.size() - cascade.platforms.size();
        }
        std::ranges::stable_sort(problem.cascades, [](const Cascade& a, const Cascade& b) {
            return std::pair(a.portability, a.platforms.size()) > std::pair(b.portability, b.platforms.size());
        });
    }
    return problems;
}

Html cascade_chart(const CascadeProblem& problem)
{
    LineChart chart{"Efficiencies of each application: " + problem.name, "platforms", "efficiency", {}};
    chart.x_whole = true;
    for (const Cascade& cascade : problem.cascades) {
        Series series{cascade.label(), {}};
        for (const double efficiency : cascade.descending())
            series.points.emplace_back(static_cast<double>(series.points.size() + 1), efficiency);
        chart.series.push_back(std::move(series));
    }
    return figure("", draw(chart), "");
}

Html cascade_table(const CascadeProblem& problem)
{
    std::vector<HtmlColumn> columns = {{"application"}, {"P", {}, true}};
    for (const std::string& platform : problem.platforms)
        columns.push_back({platform, {}, true});
    HtmlTable table(columns);
    for (const Cascade& cascade : problem.cascades) {
        std::vector<Html> cells = {text(cascade.application), text(cascade.portability_text())};
        for (const std::string& platform : problem.platforms) {
            const auto found = cascade.platforms.find(platform);
            if (found == cascade.platforms.end()) {
                cells.push_back(text("–"));
                continue;
            }
            cells.push_back(text(fmt::format("{:.2f}", found->second->efficiency)) +
                            (found->second->noisy ? text_element("small", "", "noisy") : Html()));
        }
        table.add(std::move(cells));
    }
    return element("div", {{"class", "machines"}}, table.html());
}

} // namespace

Section portability_section(const Campaign& campaign)
{
    Section section{"portability", "Performance portability", {}};
    const auto efficiencies = efficiencies_of(campaign);
    for (const CascadeProblem& problem : problems_of(efficiencies))
        if (problem.platforms.size() > 1)
            section.content += heading(problem.name) + cascade_chart(problem) + cascade_table(problem);
    if (!section.content.empty()) section.content = note(how_to_read_cascades) + section.content;
    return section;
}

} // namespace tetrace
