#include "bench/output/report.h"
#include "bench/report/campaign/portability.h"
#include "bench/report/page.h"
#include "bench/report/standalone.h"
#include "bench/results/result_folder.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

/// The page of all results in folders. Other files there are left out.
std::string page_of_folders(const Campaign& campaign, const Options& options,
                            const std::vector<std::filesystem::path>& files)
{
    if (const std::size_t count = campaign.left_out.size(); count > 0)
        say(fmt::format("{} of these {} left out, which the page lists; the first: {}", count, files.size(),
                        campaign.left_out.front().second));
    return campaign_page(campaign, options.report_pictures);
}

void write_portability(const std::filesystem::path& path, const Campaign& campaign)
{
    const auto efficiencies = efficiencies_of(campaign);
    write_whole(path, portability_table(efficiencies).csv());
    say(fmt::format("{}: {}", path.string(), counted(efficiencies.size(), "efficiency", "efficiencies")));
}

void make_chart_folder(const std::filesystem::path& folder)
{
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--charts: cannot create the folder '{}': {}", folder.string(), failed.message()));
}

void write_charts(const std::filesystem::path& folder, const std::string& page)
{
    for (const StandaloneChart& chart : standalone_charts(page)) {
        write_whole(folder / chart.name, chart.text);
        say((folder / chart.name).string());
    }
}

/// Next to the page.
void write_other_files(const Options& options, const std::optional<Campaign>& campaign, const std::string& page)
{
    if (options.portability_csv) write_portability(*options.portability_csv, *campaign);
    if (options.chart_folder) write_charts(*options.chart_folder, page);
}

} // namespace

int report_command(const Options& options)
{
    const std::filesystem::path out = options.out.value_or("report.html");
    const bool is_campaign = has_folder(options.files);
    const auto files = is_campaign ? files_below(options.files) : options.files;
    check_not_an_input(out, files);
    check_not_an_input(out, options.report_pictures);
    if (options.portability_csv) check_not_an_input(*options.portability_csv, files, "--portability");
    if (options.chart_folder) make_chart_folder(*options.chart_folder);
    std::optional<Campaign> campaign;
    if (is_campaign || options.portability_csv) campaign = read_campaign(files);
    const std::string page = is_campaign ? page_of_folders(*campaign, options, files)
                                         : report_page(read_report_input(files, options.report_pictures));
    write_other_files(options, campaign, page);
    if (out == "-") {
        print(page);
        return 0;
    }
    write_whole(out, page);
    say(fmt::format("{}: {}, from {}", out.string(), size_text(page.size()),
                    counted(files.size(), "result", "results")));
    return 0;
}

} // namespace tetrace
