#pragma once

#include <stdexcept>
#include <string>

namespace tetrace {

/// What went wrong, as far as callers and the exit code distinguish it.
enum class ErrorKind {
    usage,         ///< an option or a value that is not accepted
    invalid_input, ///< a file or a mesh that cannot be used
    missing,       ///< a required file, program or device is missing
    unsupported,   ///< not possible here: a limit of the device or of the build
    internal,      ///< our own fault
    driver,        ///< a device's driver failed, ended its process, or never answered
    wrong_result,  ///< a device returned what its kernel cannot have written
    interrupted,   ///< by the user
};

/// The one exception of tetrace: its text says what was being done, to what, and what the user can do.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

private:
    ErrorKind kind_;
};

/// The program's exit codes: 1 a wrong result or a driver that failed, 2 usage or bad input, 3 missing, 4 internal; 0
/// is good.
[[nodiscard]] constexpr int exit_code(ErrorKind kind) noexcept
{
    switch (kind) {
    case ErrorKind::usage:
    case ErrorKind::invalid_input: return 2;
    case ErrorKind::missing:
    case ErrorKind::unsupported: return 3;
    case ErrorKind::internal: return 4;
    case ErrorKind::driver:
    case ErrorKind::wrong_result: return 1;
    case ErrorKind::interrupted: return 130;
    }
    return 4;
}

} // namespace tetrace
