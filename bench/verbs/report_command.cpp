#include "bench/output/report.h"
#include "bench/report/page.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/whole_file.h"

#include <fmt/format.h>

namespace tetrace {

int report_command(const Options& options)
{
    const std::filesystem::path out = options.out.value_or("report.html");
    check_not_an_input(out, options.files);
    check_not_an_input(out, options.report_pictures);
    const std::string page = report_page(read_report_input(options.files, options.report_pictures));
    if (out == "-") {
        print(page);
        return 0;
    }
    write_whole(out, page);
    say(fmt::format("{}: {}, from {} {}", out.string(), size_text(page.size()), options.files.size(),
                    options.files.size() == 1 ? "result" : "results"));
    return 0;
}

} // namespace tetrace
