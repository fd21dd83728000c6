#pragma once

#include "bench/expectations/expectation.h"

#include <filesystem>
#include <vector>

namespace tetrace {

/// Reads what implementations are expected to show. A file has one implementation, which its name before ".json" says,
/// or an object of them by implementation; of a folder each .json file is read, except for those with `programs`, which
/// are of compilers. Of two files on one implementation the last counts.
/// Throws Error{missing} for a path that is not there, Error{invalid_input} naming file and key for what cannot be
/// read.
[[nodiscard]] Expectations read_expectations(const std::vector<std::filesystem::path>& paths);

/// Where --write-expect writes: a file, or a folder with a file for each implementation.
class ExpectationTarget {
public:
    /// path: a file if it ends in .json, else a folder, which is made. Reads what is there. Throws as
    /// read_expectations() does, and Error{invalid_input} naming the path where it cannot be written.
    explicit ExpectationTarget(std::filesystem::path path);

    /// Writes what implementations showed, and returns the paths of the files. Of what was there it keeps other
    /// implementations, flakes, and what the run says nothing about: rows and self-test, or defects. A file named
    /// after the only implementation has it alone; other files have an object by implementation.
    [[nodiscard]] std::vector<std::filesystem::path> write(const Expectations& shown);

private:
    std::filesystem::path path_;
    bool is_folder_;
    Expectations all_;
};

} // namespace tetrace
