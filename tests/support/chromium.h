#pragma once

#include "core/base/files.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string>

namespace tetrace::test {

/// The command of a Chromium; empty if there is none.
inline std::string find_chromium()
{
    for (const char* const name : {"chromium", "chromium-headless-shell", "google-chrome", "chrome"})
        if (std::system(fmt::format("command -v {} > /dev/null 2>&1", name).c_str()) == 0) return name;
    return {};
}

/// What a browser makes of a page: its document as text, and what it wrote to its console.
struct Browsed {
    std::string document, console;
};

/// Opens the page from a file in the folder. query: of its address. options: more of Chromium's.
inline Browsed browse(const std::filesystem::path& folder, const std::string& page, const std::string& query = {},
                      const std::string& options = {})
{
    write_file(folder / "page.html", page);
    const auto document = folder / "document", log = folder / "log";
    const std::string command = fmt::format(
        "HOME='{0}' timeout 120 {1} --headless --no-sandbox --disable-gpu --disable-dev-shm-usage {2} "
        "--user-data-dir='{0}/profile' --enable-logging=stderr --dump-dom 'file://{0}/page.html{3}' > '{4}' 2> '{5}'",
        folder.string(), find_chromium(), options, query, document.string(), log.string());
    EXPECT_EQ(std::system(command.c_str()), 0) << read_text(log);
    Browsed browsed{read_text(document), {}};
    const std::string text = read_text(log);
    for (std::size_t at = text.find("CONSOLE"); at != std::string::npos; at = text.find("CONSOLE", at + 1))
        browsed.console += text.substr(at, text.find('\n', at) - at) + "\n";
    return browsed;
}

} // namespace tetrace::test
