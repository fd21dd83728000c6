#pragma once

#include "bench/options/options.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>
#include <string>

namespace tetrace {

/// A verb's result, in each form that can be requested.
struct Report {
    Sheet sheet; ///< for people; may be in colour
    Table table; ///< flat, for CSV, and for Markdown where no other is given
    nlohmann::json json;
    std::string markdown = {}; ///< empty: the table's
};

/// Fails early where deliver() would fail: the file's ending does not determine the form, or the file cannot be
/// written; and if a shard has no JSON file, since only that can be merged. Throws Error{usage} or Error{invalid_input}
/// naming the file.
void check_output(const Options& options);

/// Fails before a result overwrites one of its own inputs. Throws Error{usage} naming the option and both files where
/// `out` is one of the inputs, even under another name. option: that names `out`.
void check_not_an_input(const std::filesystem::path& out, const std::vector<std::filesystem::path>& inputs,
                        const char* option = "--out");

/// Leaves no new file. Throws Error{invalid_input} naming the option, the file and the system's reason if the file
/// cannot be written.
void check_writable(const char* option, const std::filesystem::path& path);

/// Writes the report where --format and --out say: to standard output, the file, or both. With --anonymous, writes it
/// as bench/options/identity.h describes.
/// Throws Error{invalid_input} naming the file and the system's reason.
void deliver(const Options& options, const Report& report);

/// Throws Error{usage} if --columns names a column that none of the tables has; the message lists those that they
/// have.
void check_columns(const Options& options, const std::vector<std::string>& keys);

/// Writes the report only to the file of --out. Precondition: --out is given.
void deliver_to_file(const Options& options, const Report& report);

/// The rows of a table as an array of objects, keyed by its columns' keys; empty cells are left out.
[[nodiscard]] nlohmann::json to_json(const Table& table);

/// The head of every tetrace result: schema version, program, machine, time, and command line.
[[nodiscard]] nlohmann::json result_head(const Options& options);

/// What an interrupted run prints under "Stopped", and `show` prints again.
inline constexpr const char* interrupted_sentence =
    "by a signal: this is what the run had by then. Rows without an answer are skipped.";

} // namespace tetrace
