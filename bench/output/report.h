#pragma once

#include "bench/options/options.h"
#include "bench/terminal/table.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tetrace {

/// What a verb found out, in each form that it can be asked for.
struct Report {
    std::string text; ///< for people
    Table table;      ///< flat, for CSV and Markdown
    nlohmann::json json;
    std::string markdown = {}; ///< where it is more than the table's; empty: the table's
};

/// Fails early where deliver() would: the form cannot be told from the file's ending, or the file cannot be written.
/// Throws Error{usage} or Error{invalid_input} naming the file.
void check_output(const Options& options);

/// Fails before a result replaces one that it is made from. Throws Error{usage} naming the option and both files where
/// `out` is one of the inputs, by whatever name.
void check_not_an_input(const std::filesystem::path& out, const std::vector<std::filesystem::path>& inputs);

/// Leaves no file behind that was not there. Throws Error{invalid_input} naming the option, the file and the system's
/// reason where it cannot be written.
void check_writable(const char* option, const std::filesystem::path& path);

/// Writes the report where --format and --out say: standard output, the file, or both; with --anonymous, as
/// bench/options/anonymous.h has it.
/// Throws Error{invalid_input} naming the file and the system's reason.
void deliver(const Options& options, const Report& report);

/// Writes it to the file of --out alone. Precondition: there is one.
void deliver_to_file(const Options& options, const Report& report);

/// The rows of a table as an array of objects, keyed by its columns' keys; empty cells are left out.
[[nodiscard]] nlohmann::json to_json(const Table& table);

/// The head that every result of tetrace has: schema version, what made it, on what, when, with which command line.
[[nodiscard]] nlohmann::json result_head(const Options& options);

/// Writes a file. Throws Error{invalid_input} naming it and the system's reason.
void write_text(const std::filesystem::path& path, const std::string& text);

} // namespace tetrace
