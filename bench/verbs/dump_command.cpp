#include "bench/debugging/case_files.h"
#include "bench/debugging/dump.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/isolation/isolation.h"

#include <algorithm>
#include <filesystem>
#include <unistd.h>

namespace tetrace {

namespace {

void write_all(const std::vector<KernelFile>& files, const std::filesystem::path& folder)
{
    for (const KernelFile& file : files)
        write_whole(folder / file.name, file.bytes);
}

void make_folder(const std::filesystem::path& folder)
{
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (!std::filesystem::is_directory(folder))
        throw Error(ErrorKind::invalid_input, "--out: the folder '" + folder.string() + "' cannot be made: " +
                                                  (failed ? failed.message() : "a file has that name"));
}

void print_readme(const std::string& title, const std::vector<KernelFile>& files, const std::vector<std::string>& notes)
{
    const std::size_t columns = terminal_columns(STDOUT_FILENO);
    print(columns == 0 ? readme_of(title, files, notes)
                       : readme_of(title, files, notes, std::min<std::size_t>(columns, 110)));
}

int dump_case(const Options& options)
{
    const DumpedCase dumped = dumped_case(options, direct_backends());
    make_folder(*options.out);
    write_all(dumped.files, *options.out);
    write_whole(*options.out / "README.txt", readme_of(dumped.title, dumped.files, {}));
    print_readme(dumped.title, dumped.files, {});
    return 0;
}

} // namespace

int dump_command(const Options& options)
{
    if (!options.defect.empty() || !options.scenes.empty()) return dump_case(options);
    const auto& backends = direct_backends();
    std::vector<KernelFile> files = dumped_files(options, backends);
    std::vector<std::string> notes;
    const std::string title = dump_title(options);
    make_folder(*options.out);
    write_all(files, *options.out);
    write_whole(*options.out / "README.txt", readme_of(title, files, notes)); // before a driver can crash
    const std::vector<KernelFile> code = driver_code(options, backends, notes);
    write_all(code, *options.out);
    files.insert(files.end(), code.begin(), code.end());
    write_whole(*options.out / "README.txt", readme_of(title, files, notes));
    print_readme(title, files, notes);
    return 0;
}

} // namespace tetrace
