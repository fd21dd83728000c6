#include "bench/inspection/work_folder.h"

#include "core/base/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace tetrace {

WorkFolder::WorkFolder()
{
    std::error_code none; // then the current folder
    std::string name = (std::filesystem::temp_directory_path(none) / "tetrace-inspect-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw Error(ErrorKind::invalid_input, "no temporary folder '" + name + "': " + std::strerror(errno));
    path_ = name;
}

WorkFolder::~WorkFolder()
{
    std::error_code left_behind;
    std::filesystem::remove_all(path_, left_behind);
}

} // namespace tetrace
