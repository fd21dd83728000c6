#include "bench/output/report.h"
#include "bench/report/page.h"
#include "bench/results/result_folder.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/files.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

/// The page of all results in folders. Other files there are left out.
std::string page_of_folders(const Options& options, const std::vector<std::filesystem::path>& files)
{
    const Campaign campaign = read_campaign(files);
    if (const std::size_t count = campaign.left_out.size(); count > 0)
        say(fmt::format("{} of these {} left out, which the page lists; the first: {}", count, files.size(),
                        campaign.left_out.front().second));
    return campaign_page(campaign, options.report_pictures);
}

} // namespace

int report_command(const Options& options)
{
    const std::filesystem::path out = options.out.value_or("report.html");
    const bool is_campaign = has_folder(options.files);
    const auto files = is_campaign ? files_below(options.files) : options.files;
    check_not_an_input(out, files);
    check_not_an_input(out, options.report_pictures);
    const std::string page =
        is_campaign ? page_of_folders(options, files) : report_page(read_report_input(files, options.report_pictures));
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
