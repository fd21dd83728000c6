#include "bench/report/campaign/portability.h"

#include <algorithm>
#include <map>

namespace tetrace {

namespace {

/// The fastest row of an application on a platform.
struct BestRate {
    double mrays_per_s = 0;
    bool noisy = false;
};
using Applications = std::map<std::string, BestRate>;

/// Of one group: by machine, then by application.
void add_rates(std::map<std::size_t, Applications>& platforms, const Campaign& campaign, const CampaignGroup& group)
{
    for (const CampaignWork& work : group.works)
        for (std::size_t machine = 0; machine < campaign.machines.size(); ++machine) {
            const CampaignRate* const rate = work.newest_of(machine);
            if (rate == nullptr || !rate->is_right || work.application.empty()) continue;
            BestRate& best = platforms[machine][work.application];
            if (rate->mrays_per_s > best.mrays_per_s) best = {rate->mrays_per_s, rate->noisy || rate->pulse.is_noisy()};
        }
}

void add_efficiencies(std::vector<Efficiency>& all, const std::string& problem, const std::string& platform,
                      const Applications& applications)
{
    const BestRate best =
        std::ranges::max_element(applications, {}, [](const auto& one) { return one.second.mrays_per_s; })->second;
    for (const auto& [application, rate] : applications)
        all.push_back({problem, platform, application, rate.mrays_per_s, rate.mrays_per_s / best.mrays_per_s,
                       rate.noisy || best.noisy});
}

} // namespace

std::vector<Efficiency> efficiencies_of(const Campaign& campaign)
{
    std::vector<std::string> problems; // in order of appearance
    std::map<std::string, std::map<std::size_t, Applications>> rates;
    for (const CampaignGroup& group : campaign.groups) {
        if (group.kind == DeviceKind::emulated) continue;
        const std::string problem = group.hash.empty() ? group.title : group.title + ", scene " + group.hash;
        if (rates.find(problem) == rates.end()) problems.push_back(problem);
        add_rates(rates[problem], campaign, group);
    }
    std::vector<Efficiency> all;
    for (const std::string& problem : problems)
        for (const auto& [machine, applications] : rates[problem])
            add_efficiencies(all, problem, campaign.machines[machine].name, applications);
    return all;
}

double performance_portability(const std::vector<double>& efficiencies, std::size_t platforms)
{
    if (efficiencies.size() < platforms) return 0;
    double sum = 0;
    for (const double efficiency : efficiencies)
        sum += 1 / efficiency;
    return static_cast<double>(efficiencies.size()) / sum;
}

Table portability_table(const std::vector<Efficiency>& efficiencies)
{
    Table table({{"problem", "problem"},
                 {"platform", "platform"},
                 {"application", "application"},
                 {"efficiency", "efficiency", "", 3},
                 {"noisy", "noisy"},
                 {"mrays_per_s", "rate", "Mrays/s"}});
    for (const Efficiency& one : efficiencies)
        table.add({one.problem, one.platform, one.application, one.efficiency, one.noisy ? Cell("yes") : Cell(),
                   one.mrays_per_s});
    return table;
}

} // namespace tetrace
