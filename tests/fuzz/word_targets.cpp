// Options, results, expectations, journals, cameras, pictures and the messages of drivers' processes.
#include "bench/expectations/expectation_files.h"
#include "bench/measuring/image_record.h"
#include "bench/measuring/journal.h"
#include "bench/options/benchmark_flags.h"
#include "bench/options/camera_file.h"
#include "bench/options/options.h"
#include "bench/report/png.h"
#include "bench/results/result_file.h"
#include "bench/results/result_value.h"
#include "core/isolation/messages.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/targets.h"
#include "tests/reproduce/journal_lines.h"

#include <array>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace tetrace::fuzz {

namespace {

using nlohmann::json;

/// A word a line.
void read_options(std::string_view bytes)
{
    std::istringstream lines{std::string(bytes)};
    std::vector<std::string> words;
    for (std::string word; std::getline(lines, word);)
        words.push_back(word);
    may_refuse([&] { (void)parse_options(words); });
    if (!words.empty())
        may_refuse([&] { (void)benchmark_filter_keeps(words[0], "cdt/maria/tet80/cubes/primary/math:exact"); });
}

void read_result_file(std::string_view bytes)
{
    const MemoryFile file(bytes);
    may_refuse([&] { (void)result_text(read_result(file.path()).json); });
    may_refuse([&] { (void)read_result(file.path()); });
}

void read_expectation_file(std::string_view bytes)
{
    const MemoryFile file(bytes);
    may_refuse([&] {
        for (const auto& [name, one] : read_expectations({file.path()}))
            (void)expectation_json(one).dump();
    });
}

void read_camera_file(std::string_view bytes)
{
    const MemoryFile file(bytes);
    may_refuse([&] { (void)read_cameras(file.path()).hash(); });
}

void read_picture_file(std::string_view bytes)
{
    const MemoryFile file(bytes);
    may_refuse([&] { (void)read_picture(file.path()); });
}

/// The lines with the checksums that they should have.
std::string with_checksums(std::string_view bytes)
{
    std::istringstream lines{std::string(bytes)};
    std::string text;
    std::uint64_t checksum = 0;
    for (std::string entry; std::getline(lines, entry);) {
        checksum = hash_of(entry, checksum);
        text += R"({"checksum":")" + hash_text(checksum) + R"(","entry":)" + entry + "}\n";
    }
    return text;
}

/// As the rows of a resumed run are: what it cannot be is an exception of the library or a logic error.
void read_outcome(const json& entry)
{
    try {
        (void)outcome_json(outcome_from_json(entry));
    } catch (const json::exception&) {
        return;
    } catch (const std::logic_error&) {
        return;
    }
}

/// An entry a line; the first byte says whether they get their checksums.
void read_journal_file(std::string_view bytes)
{
    if (bytes.empty()) return;
    const std::string_view given = bytes.substr(1);
    const MemoryFile file(bytes[0] % 4 == 0 ? std::string(given) : with_checksums(given));
    const json head = {{"commit", "abc"}, {"views", {1, 2, 3}}};
    may_refuse([&] {
        for (const json& entry : read_journal(file.path()).entries)
            for (const json& row : entry.contains("rows") ? entry["rows"] : json::array())
                read_outcome(row);
    });
    may_refuse([&] { Journal(file.path(), head, true).append({{"view", 1}}); });
}

/// The answer of a driver's process, in which a driver may have written where it should not.
void read_message(std::string_view bytes)
{
    const auto all = std::as_bytes(std::span(bytes));
    ByteReader reader({all.begin(), all.end()});
    try {
        get_outcome(reader);
        for (const Device& device : get_devices(reader))
            (void)name_of(device.kind);
    } catch (const Error&) {
        return;
    } catch (const std::bad_alloc&) {
        return;
    } catch (const std::runtime_error&) {
        return; // the other process's words
    }
}

constexpr std::array<Target, 7> targets = {{{"options", read_options},
                                            {"result", read_result_file},
                                            {"expectation", read_expectation_file},
                                            {"cameras", read_camera_file},
                                            {"picture", read_picture_file},
                                            {"journal", read_journal_file},
                                            {"message", read_message}}};

} // namespace

std::span<const Target> word_targets()
{
    return targets;
}

} // namespace tetrace::fuzz
