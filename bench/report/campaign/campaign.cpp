#include "bench/report/campaign/campaign.h"

#include "bench/output/trust.h"
#include "bench/results/result_comparison.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <unordered_map>

namespace tetrace {

namespace {

/// A rate before machines, groups and works have numbers.
struct ReadRate {
    CampaignMachine machine;
    std::string group, title, hash; ///< group: unique for rays and kind of device
    std::string work, label, application;
    CampaignRate rate;
};

struct ReadResult {
    CampaignResult result;
    std::vector<ReadRate> rates;
};

/// The host's name. If neither a label nor the CPU's family distinguishes hosts, its folder does: results are in one of
/// their machine's (results/README.md).
std::string host_name(const ResultFile& file)
{
    const ResultValue section = file.section();
    const std::string folder = std::filesystem::absolute(file.path).parent_path().filename().string();
    if (section.find("label") || section.at("host").find("family") || folder.empty()) return file.head.machine;
    return fmt::format("{} (folder {})", file.head.machine, folder);
}

std::string machine_name(const ResultFile& file, const ResultRow& row)
{
    const std::string host = host_name(file);
    const std::string in_flight = row.in_flight > 1 ? fmt::format(", {} launches in flight", row.in_flight) : "";
    if (*row.device_kind == DeviceKind::gpu) return fmt::format("{} in {}{}", row.device, host, in_flight);
    const auto all = file.section().find("threads");
    const std::uint64_t threads = row.threads > 0 ? row.threads : all ? all->count() : 0;
    return host + (threads == 0 ? "" : ", " + counted(threads, "thread", "threads")) + in_flight;
}

std::string title_of(const ResultFile& file, const ResultRow& row, const std::string& rays)
{
    if (row.scene.empty()) return fmt::format("exit searches only, {} (Table 5)", file.search_size);
    return rays_title(scene_of(file, row), rays);
}

/// Nothing for a row without a rate, or whose work nobody can tell.
/// application: see CampaignWork.
void add_rate(ReadResult& read, const ResultFile& file, const ResultRow& row, const std::string& label,
              const std::string& application, const std::string& rays)
{
    const std::string work = work_of(file, row);
    if (!row.device_kind || !row.mrays_per_s || row.samples_s.empty() || work.empty()) return;
    if (!(*row.mrays_per_s >= 1e-18 && *row.mrays_per_s <= 1e18))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("reading the result '{}': the rate of row '{}' is not between "
                                "1e-18 and 1e18",
                                file.path.string(), row.name));
    ReadRate rate;
    rate.machine = {*row.device_kind, machine_name(file, row)};
    rate.title = title_of(file, row, rays);
    rate.hash = row.scene.empty() ? "" : scene_of(file, row).hash;
    rate.group = fmt::format("{} {} {}", rays_of(file, row), rays, name_of(*row.device_kind));
    rate.work = fmt::format("{} {}", work, name_of(*row.device_kind));
    rate.label = label;
    rate.application = application;
    rate.rate.mrays_per_s = *row.mrays_per_s;
    rate.rate.samples_s = row.samples_s;
    rate.rate.pulse = pulse_of(file.head, row);
    rate.rate.noisy = row.noisy;
    rate.rate.is_right = row.status == Status::ok;
    read.rates.push_back(std::move(rate));
}

/// "search/maria/tet80/random-tets/math:exact/api:openmp": what is left of it without what all searches have.
std::string search_label(const ResultRow& row)
{
    std::string label = row.name;
    for (const char* const part : {"search/", "random-tets/", "math:exact/"})
        if (const std::size_t at = label.find(part); at != std::string::npos)
            label.erase(at, std::string_view(part).size());
    std::ranges::replace(label, '/', ' ');
    return label;
}

ReadResult read_one(const std::filesystem::path& path)
{
    const ResultFile file = read_result(path);
    ReadResult read{{path, file.head, day_of(file.head.date)}, {}};
    const Steadiness steadiness = read_steadiness(file.section());
    read.result.timed = steadiness.timed;
    read.result.noisy = steadiness.noisy;
    for (const ResultRow* row : file.timed_rows())
        ++read.result.statuses[row->status];
    if (const auto load = file.section().find("load"))
        read.result.others = fmt::format("{:.2f}", load->at("others").number());
    for (const ReportRow& row : report_rows(file, 0))
        if (row.rate)
            add_rate(read, file, *row.row, row.kernel() + "  " + row.api, row.row->backend + " " + row.layout,
                     rays_text(row.rays, row.task));
    for (const ResultRow& row : file.searches)
        add_rate(read, file, row, search_label(row), "", "searches");
    return read;
}

/// Gives machines, groups and works their numbers, as they appear.
class Assembly {
public:
    void add(ReadResult read)
    {
        const std::size_t result = campaign_.results.size();
        for (ReadRate& rate : read.rates) {
            rate.rate.result = result;
            rate.rate.machine = machine(rate.machine);
            auto& own = read.result.machines;
            if (std::ranges::find(own, rate.rate.machine) == own.end()) own.push_back(rate.rate.machine);
            work(rate).rates.push_back(std::move(rate.rate));
        }
        campaign_.results.push_back(std::move(read.result));
    }
    [[nodiscard]] Campaign& campaign() { return campaign_; }

private:
    std::size_t machine(const CampaignMachine& wanted)
    {
        const auto [found, is_new] =
            machines_.try_emplace(fmt::format("{} {}", name_of(wanted.kind), wanted.name), campaign_.machines.size());
        if (is_new) campaign_.machines.push_back(wanted);
        return found->second;
    }
    CampaignWork& work(const ReadRate& rate)
    {
        const auto [group, new_group] = groups_.try_emplace(rate.group, campaign_.groups.size());
        if (new_group) campaign_.groups.push_back({rate.title, rate.hash, rate.machine.kind, {}});
        auto& works = campaign_.groups[group->second].works;
        const auto [work, new_work] = works_.try_emplace(rate.group + "\n" + rate.work, works.size());
        if (new_work) works.push_back({rate.label, rate.application, {}});
        return works[work->second];
    }

    Campaign campaign_;
    std::unordered_map<std::string, std::size_t> machines_, groups_, works_;
};

} // namespace

const CampaignRate* CampaignWork::newest_of(std::size_t machine) const
{
    const auto found =
        std::find_if(rates.rbegin(), rates.rend(), [&](const CampaignRate& rate) { return rate.machine == machine; });
    return found == rates.rend() ? nullptr : &*found;
}

std::optional<double> day_of(const std::string& date)
{
    int year = 0;
    unsigned month = 0, day = 0, hour = 0, minute = 0, second = 0;
    if (std::sscanf(date.c_str(), "%4d-%2u-%2uT%2u:%2u:%2uZ", &year, &month, &day, &hour, &minute, &second) != 6)
        return std::nullopt;
    const std::chrono::year_month_day whole{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
    if (!whole.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
    const double seconds = hour * 3600.0 + minute * 60.0 + second;
    return static_cast<double>(std::chrono::sys_days(whole).time_since_epoch().count()) + seconds / 86400;
}

Campaign read_campaign(const std::vector<std::filesystem::path>& files)
{
    std::vector<ReadResult> read;
    std::vector<std::pair<std::filesystem::path, std::string>> left_out;
    for (const std::filesystem::path& file : files) {
        try {
            read.push_back(read_one(file));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::invalid_input) throw;
            left_out.emplace_back(file, error.what());
        }
    }
    if (read.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("none of the {} files is a result; the first: {}", files.size(),
                                left_out.empty() ? "none was given" : left_out.front().second));
    std::ranges::stable_sort(read, [](const ReadResult& a, const ReadResult& b) {
        return a.result.day.value_or(0) < b.result.day.value_or(0);
    });
    Assembly assembly;
    for (ReadResult& one : read)
        assembly.add(std::move(one));
    assembly.campaign().left_out = std::move(left_out);
    return std::move(assembly.campaign());
}

} // namespace tetrace
