// The manual page and the shells' completions have every verb and option, and the shells and troff take them.
#include "bench/options/completion.h"
#include "bench/options/help.h"
#include "bench/options/manual.h"
#include "bench/options/option_table.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// What a shell's command line prints, with its messages.
std::string output_of(const std::string& command)
{
    std::FILE* const pipe = popen(("(" + command + ") 2>&1").c_str(), "r");
    std::string text;
    std::array<char, 4096> piece{};
    while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), pipe))
        text.append(piece.data(), size);
    pclose(pipe);
    return text;
}

bool is_installed(const std::string& program)
{
    return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

class Manual : public testing::Test {
protected:
    /// What bash offers after these words, the last of which is begun.
    [[nodiscard]] std::string completed(const std::string& words, int last, const std::string& before = {}) const
    {
        write_file(folder_ / "bash", bash_completion());
        return output_of("bash -c '" + before + "source " + (folder_ / "bash").string() + "; COMP_WORDS=(" + words +
                         "); COMP_CWORD=" + std::to_string(last) + "; _tetrace; echo \"${COMPREPLY[@]}\"'");
    }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(Manual, page_has_every_verb_and_option_and_no_line_that_troff_takes_for_a_macro)
{
    const std::string page = man_page();
    for (const VerbHelp& verb : verb_helps())
        EXPECT_TRUE(contains(page, ".SS tetrace " + std::string(name_of(verb.verb)))) << name_of(verb.verb);
    for (const OptionRow& row : option_table()) {
        std::string name;
        for (const char c : row.name)
            name += c == '-' ? std::string("\\-") : std::string(1, c);
        EXPECT_TRUE(contains(page, ".TP\n.BR " + name)) << row.name;
    }
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with('.') || line.starts_with('\'')) {
            EXPECT_TRUE(std::isupper(static_cast<unsigned char>(line[1])) || line == ".nf" || line == ".fi" ||
                        line == ".br")
                << line;
        }
}

TEST_F(Manual, page_is_read_by_groff_without_a_warning)
{
    if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed";
    write_file(folder_ / "tetrace.1", man_page());
    EXPECT_EQ(output_of("groff -man -ww -Tutf8 -z " + (folder_ / "tetrace.1").string()), "");
}

TEST_F(Manual, bash_completes_verbs_each_verbs_options_and_topics_of_help)
{
    EXPECT_EQ(completed("tetrace reno", 1), "\n");
    EXPECT_EQ(completed("tetrace rend", 1), "render\n");
    for (const VerbHelp& verb : verb_helps()) {
        const std::string name(name_of(verb.verb)), offered = " " + completed("tetrace " + name + " --", 2);
        for (const OptionRow& row : option_table()) {
            if (!row.name.starts_with("--")) continue;
            const bool is_taken = std::ranges::any_of(option_table(), [&](const OptionRow& other) {
                return other.name == row.name && takes(verb.verb, other);
            });
            EXPECT_EQ(contains(offered, " " + row.name + " "), is_taken) << name << ' ' << row.name;
        }
    }
    EXPECT_EQ(completed("tetrace help zs", 2), "zsh\n");
}

TEST_F(Manual, bash_completes_the_values_of_options_also_in_lists_and_after_an_equals_sign)
{
    EXPECT_EQ(completed("tetrace bench --backend open", 3), "openmp opencl\n");
    EXPECT_EQ(completed("tetrace bench --backend openmp,vul", 3), "openmp,vulkan\n");
    EXPECT_EQ(completed("tetrace bench --scene = arm", 4), "armadillo armadillo-1\n");
    EXPECT_EQ(completed("tetrace bench --math =", 3), "exact fast\n");
    EXPECT_EQ(completed("tetrace reproduce figu", 2), "figure6\n");
    EXPECT_EQ(completed("tetrace bench --samples \"\"", 3), "\n") << "a number";
    EXPECT_EQ(completed("tetrace bench --filter --", 3), "\n") << "its value";
    for (const OptionRow& row : option_table()) {
        if (!is_option(row) || row.apply.names().empty()) continue;
        const auto verb =
            std::ranges::find_if(verb_helps(), [&](const VerbHelp& help) { return takes(help.verb, row); });
        const std::string begun = fmt::format("tetrace {} {} ", name_of(verb->verb), row.name);
        for (const std::string& name : {row.apply.names().front(), row.apply.names().back()})
            EXPECT_TRUE(contains(completed(begun + name.substr(0, name.size() - 1), 3), name)) << begun << name;
    }
}

TEST_F(Manual, bash_completes_files_of_the_verbs_and_options_that_read_or_write_some)
{
    write_file(folder_ / "first.json", "");
    write_file(folder_ / "first.ply", "");
    const auto in_folder = [&](const std::string& words, int last) {
        return completed(words, last, "cd " + folder_.path().string() + "; ");
    };
    EXPECT_EQ(in_folder("tetrace compare fi", 2), "first.json\n");
    EXPECT_EQ(in_folder("tetrace compare first.json fi", 3), "first.json\n");
    for (const char* const name : {"first.json", "first.ply"})
        EXPECT_TRUE(contains(in_folder("tetrace build --scene firs", 3), name)) << name;
    EXPECT_EQ(in_folder("tetrace bench -o first.j", 3), "first.json\n");
    EXPECT_EQ(in_folder("tetrace bench --budget firs", 3), "\n");
}

TEST_F(Manual, every_value_that_help_lists_is_accepted)
{
    for (const OptionRow& row : option_table())
        for (const std::string& name : row.apply.names()) {
            Options options;
            EXPECT_NO_THROW(row.apply(options, name)) << row.name << ' ' << name;
        }
}

TEST_F(Manual, zsh_reads_its_completion)
{
    const std::string text = zsh_completion();
    for (const VerbHelp& verb : verb_helps())
        EXPECT_TRUE(contains(text, "\n    " + std::string(name_of(verb.verb)) + ")\n")) << name_of(verb.verb);
    EXPECT_TRUE(contains(text, "'*--size=[Image size in pixels, one ray each; N means NxN]:WxH:'"));
    EXPECT_TRUE(contains(text, ":NAME:{_sequence compadd - openmp opencl"));
    if (!is_installed("zsh")) GTEST_SKIP() << "zsh is not installed";
    write_file(folder_ / "_tetrace", text);
    EXPECT_EQ(output_of("zsh -n " + (folder_ / "_tetrace").string()), "");
}

TEST_F(Manual, fish_reads_its_completion)
{
    const std::string text = fish_completion();
    EXPECT_TRUE(contains(text, "__fish_seen_subcommand_from render' -l picture "));
    EXPECT_TRUE(contains(text, "\"printf %s\\n normals steps hits crossings depth light tally\")'\n"));
    if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed";
    write_file(folder_ / "tetrace.fish", text);
    EXPECT_EQ(output_of("fish -n " + (folder_ / "tetrace.fish").string()), "");
    const std::string complete = "HOME=" + folder_.path().string() + " fish -c 'source " +
                                 (folder_ / "tetrace.fish").string() + "; complete -C \"tetrace bench --";
    EXPECT_TRUE(contains(output_of(complete + "math exact,f\"'"), "exact,fast"));
    EXPECT_TRUE(contains(output_of(complete + "camera-set orb\"'"), "orbit"));
}

TEST_F(Manual, topics_are_those_of_help)
{
    EXPECT_EQ(help_text("man"), man_page());
    EXPECT_EQ(help_text("bash"), bash_completion());
    EXPECT_EQ(help_text("zsh"), zsh_completion());
    EXPECT_EQ(help_text("fish"), fish_completion());
    EXPECT_EQ(parse_options({"help", "man"}).help_topic, "man");
    EXPECT_THROW((void)parse_options({"help", "tcsh"}), Error);
}
