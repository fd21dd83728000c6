#include "tests/house/checkout.h"
#include "tests/house/citations.h"
#include "tests/support/temporary_folder.h"

#include <fstream>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

namespace fs = std::filesystem;

const std::vector<Text>& texts()
{
    static const std::vector<Text> texts = read_texts(checkout);
    return texts;
}

// Written so that this file cites nothing.
const std::string cited = std::string("docs/") + "spec/";

/// A specification of one page with the claims P1 and P2, and a text that cites it.
std::vector<Text> with_text(const std::string& file, const std::string& text)
{
    return {{cited + "page.md", "# Page\n\n### P1. One.\n\n### P2. Two.\n"}, {file, text}};
}

} // namespace

TEST(Citations, name_pages_and_claims_that_exist)
{
    EXPECT_EQ(joined(broken_citations(texts())), "");
}

TEST(Citations, have_one_claim_for_each_number)
{
    EXPECT_EQ(joined(repeated_claims(texts())), "");
    EXPECT_GE(claims_of(texts()).size(), 9u) << "the pages were read";
    EXPECT_GE(claims_of(texts()).at("project.md").size(), 10u) << "the claims were read";
}

TEST(Citations, name_tests_that_exist)
{
    EXPECT_EQ(joined(missing_tests(texts())), "");
}

TEST(Citations, lead_from_pages_to_files_that_exist)
{
    EXPECT_EQ(joined(broken_links(checkout, texts())), "");
}

TEST(Citations, of_missing_pages_and_claims_are_found)
{
    const auto problems = [](const std::string& text) { return joined(broken_citations(with_text("core/a.h", text))); };
    EXPECT_EQ(problems("// " + cited + "page.md, P1 and P2; " + cited + "page.md"), "");
    EXPECT_EQ(problems("// " + cited + "other.md"), "core/a.h: the page " + cited + "other.md is missing\n");
    EXPECT_EQ(problems("// " + cited + "page.md, P3"), "core/a.h: page.md lacks claim P3\n");
    EXPECT_EQ(problems("// (" + cited + "page.md,\n    // P1 and P4)"), "core/a.h: page.md lacks claim P4\n");
    EXPECT_EQ(problems("\"" + cited + "page.md, \"\n  \"P5\""), "core/a.h: page.md lacks claim P5\n");
}

TEST(Citations, within_the_specification_are_held_to_its_claims_too)
{
    const auto problems = [](const std::string& text) {
        return joined(broken_citations(with_text(cited + "more.md", text)));
    };
    EXPECT_EQ(problems("By P2, and by page.md, P1, on an H200: [texels.md](../texels.md)."), "");
    EXPECT_EQ(problems("By P7."), cited + "more.md: no page has a claim P7\n");
    EXPECT_NE(problems("By page.md, Q1."), "");
}

TEST(Citations, of_repeated_numbers_and_missing_tests_are_found)
{
    EXPECT_EQ(joined(repeated_claims(with_text(cited + "more.md", "# More\n\n### P2. Again.\n"))),
              "P2 is a claim of page.md and of more.md\n");
    auto spec =
        with_text(cited + "more.md", "As `is_left` says.\n\n*Tests*: `tests/a_test.cpp` (`nobody_tests_this`).");
    EXPECT_EQ(joined(missing_tests(spec)), cited + "more.md: no test is called nobody_tests_this\n");
    spec.push_back({"tests/core/a_test.cpp", "TEST(A, nobody_tests_this)"});
    EXPECT_EQ(joined(missing_tests(spec)), "");
}

TEST(Citations, that_lead_nowhere_are_found)
{
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "docs");
    std::ofstream(folder.path() / "docs/here.md") << "\n";
    const auto problems = [&](const std::string& text) {
        return joined(broken_links(folder.path(), {{"docs/a.md", text}}));
    };
    EXPECT_EQ(problems("[a](here.md), [b](here.md#part), [c](../docs/here.md), [d](https://x.org/y), `docs/here.md`"),
              "");
    EXPECT_EQ(problems("[a](there.md)"), "docs/a.md: there.md leads nowhere\n");
    EXPECT_EQ(problems("![a](here.jpg)"), "docs/a.md: here.jpg leads nowhere\n");
    EXPECT_EQ(problems("see `docs/gone.md`"), "docs/a.md: docs/gone.md leads nowhere\n");
}
