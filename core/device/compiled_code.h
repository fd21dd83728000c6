#pragma once

#include <map>
#include <string>

namespace tetrace {

/// What a device's compiler made of a kernel.
struct CompiledCode {
    std::string compiler;                     ///< driver with version, and the device that it compiled for
    unsigned lanes = 0;                       ///< of a subgroup
    std::map<std::string, double> statistics; ///< under the names that the compiler gives them
    std::string text;                         ///< the code, one instruction per line; empty if the driver shows none
};

/// A file for those who look into a kernel without this program.
struct KernelFile {
    std::string name;
    std::string what;    ///< what it is, and what else compiling it needs; without a full stop
    std::string command; ///< that makes or compiles it without tetrace; empty if there is none
    std::string bytes;
};

} // namespace tetrace
