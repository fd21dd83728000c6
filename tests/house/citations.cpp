#include "tests/house/citations.h"

#include <fstream>
#include <functional>
#include <iterator>
#include <regex>

namespace tetrace::test {

namespace {

namespace fs = std::filesystem;

const std::string spec = "docs/spec/";
const std::string tests_of_claim = "\n*Tests*:"; // the paragraph of a claim that names its tests

bool is_text(const fs::path& file)
{
    static const std::set<std::string> endings = {".h",     ".cpp",  ".cu", ".cl", ".comp",  ".inc", ".rgen", ".rmiss",
                                                  ".rchit", ".glsl", ".in", ".md", ".cmake", ".py",  ".sh",   ".txt"};
    return endings.contains(file.extension().string()) || file.filename() == "Makefile";
}

void add(const fs::path& root, const fs::path& file, std::vector<Text>& texts)
{
    if (!is_text(file)) return;
    std::ifstream stream(file);
    texts.push_back({fs::relative(file, root).string(), {std::istreambuf_iterator<char>(stream), {}}});
}

bool is_page(const Text& text)
{
    return text.file.ends_with(".md");
}

/// The file name of a page of the specification; empty for other texts.
std::string spec_page(const Text& text)
{
    return text.file.starts_with(spec) && is_page(text) ? text.file.substr(spec.size()) : std::string();
}

using Match = std::smatch;
void for_each_match(const std::string& text, const std::regex& pattern, const std::function<void(const Match&)>& does)
{
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        does(*match);
}

/// Calls with the page and the number of each claim, in their order.
void for_each_claim(const std::vector<Text>& texts, const std::function<void(const std::string&, std::string)>& does)
{
    static const std::regex heading("\n#+ ([A-Z][0-9]+)\\. ");
    for (const Text& text : texts)
        if (const std::string page = spec_page(text); !page.empty())
            for_each_match(text.text, heading, [&](const Match& match) { does(page, match[1]); });
}

bool is_claim(const Claims& claims, const std::string& id)
{
    for (const auto& [page, ids] : claims)
        if (ids.contains(id)) return true;
    return false;
}

bool is_letter_of_a_page(const Claims& claims, char letter)
{
    return is_claim(claims, std::string(1, letter) + "1");
}

/// What is wrong with "page, P1 and P2": `numbers` is the text after the page's name.
std::vector<std::string> wrong_with(const Claims& claims, const std::string& page, const std::string& numbers)
{
    static const std::regex number("[A-Z][0-9]+");
    if (!claims.contains(page)) return {"the page " + spec + page + " is missing"};
    std::vector<std::string> problems;
    for_each_match(numbers, number, [&](const Match& match) {
        if (!claims.at(page).contains(match.str())) problems.push_back(page + " lacks claim " + match.str());
    });
    return problems;
}

} // namespace

std::vector<Text> read_texts(const fs::path& root)
{
    std::vector<Text> texts;
    for (const char* floor :
         {"kernels", "core", "scenes", "backends", "bench", "tests", "results", "docs", "bundle", "cmake", "scripts"}) {
        if (!fs::exists(root / floor)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / floor))
            if (entry.is_regular_file()) add(root, entry.path(), texts);
    }
    for (const auto& entry : fs::directory_iterator(root))
        if (entry.is_regular_file()) add(root, entry.path(), texts);
    return texts;
}

Claims claims_of(const std::vector<Text>& texts)
{
    Claims claims;
    for (const Text& text : texts)
        if (const std::string page = spec_page(text); !page.empty()) claims[page];
    for_each_claim(texts, [&](const std::string& page, const std::string& id) { claims[page].insert(id); });
    return claims;
}

std::vector<std::string> repeated_claims(const std::vector<Text>& texts)
{
    std::vector<std::string> problems;
    std::map<std::string, std::string> page_of;
    for_each_claim(texts, [&](const std::string& page, const std::string& id) {
        const auto [known, is_new] = page_of.insert({id, page});
        if (!is_new) problems.push_back(id + " is a claim of " + known->second + " and of " + page);
    });
    return problems;
}

std::vector<std::string> broken_citations(const std::vector<Text>& texts)
{
    // A citation may be broken by the end of a line of a comment or of a string.
    static const std::string numbers = "((?:(?:,|\\s+and|\\s+to)[\\s/*#\"]+[A-Z][0-9]+)*)";
    static const std::regex from_anywhere(spec + "([\\w-]+\\.md)" + numbers);
    static const std::regex within_pages("([\\w-]+\\.md)" + numbers), alone("\\b([A-Z])[0-9]+\\b");
    const Claims claims = claims_of(texts);
    std::vector<std::string> problems;
    for (const Text& text : texts) {
        const auto report = [&](const std::string& problem) { problems.push_back(text.file + ": " + problem); };
        for_each_match(text.text, from_anywhere, [&](const Match& match) {
            for (const std::string& problem : wrong_with(claims, match[1], match[2]))
                report(problem);
        });
        if (spec_page(text).empty()) continue;
        for_each_match(text.text, within_pages, [&](const Match& match) {
            if (!claims.contains(match[1])) return; // another folder's page: a link
            for (const std::string& problem : wrong_with(claims, match[1], match[2]))
                report(problem);
        });
        for_each_match(text.text, alone, [&](const Match& match) {
            if (is_letter_of_a_page(claims, match.str()[0]) && !is_claim(claims, match.str()))
                report("no page has a claim " + match.str());
        });
    }
    return problems;
}

std::vector<std::string> missing_tests(const std::vector<Text>& texts)
{
    static const std::regex name("`([a-z0-9]+(?:_[a-z0-9]+)+)`");
    std::string sources;
    for (const Text& text : texts)
        if (text.file.starts_with("tests/") && text.file.ends_with(".cpp")) sources += text.text;
    std::vector<std::string> problems;
    for (const Text& text : texts) {
        if (spec_page(text).empty()) continue;
        for (std::size_t at = text.text.find(tests_of_claim); at != std::string::npos;) {
            const std::size_t end = text.text.find("\n\n", at);
            for_each_match(text.text.substr(at, end - at), name, [&](const Match& match) {
                if (sources.find(match[1]) == std::string::npos)
                    problems.push_back(text.file + ": no test is called " + match.str(1));
            });
            at = text.text.find(tests_of_claim, end);
        }
    }
    return problems;
}

std::vector<std::string> broken_links(const fs::path& root, const std::vector<Text>& texts)
{
    static const std::regex link("\\]\\(([^)#\\s]+)[^)]*\\)");
    static const std::regex path("`((?:kernels|core|scenes|backends|bench|tests|results|docs|bundle|cmake|scripts)/"
                                 "[\\w./-]+\\.(?:h|cpp|md|inc|comp|cu|cl|py|sh|txt|cmake|json))`");
    std::vector<std::string> problems;
    for (const Text& text : texts) {
        if (!is_page(text)) continue;
        const auto check = [&](const fs::path& to, const std::string& as_written) {
            if (!fs::exists(to)) problems.push_back(text.file + ": " + as_written + " leads nowhere");
        };
        for_each_match(text.text, link, [&](const Match& match) {
            if (match.str(1).find(':') != std::string::npos) return; // of another site
            check((root / text.file).parent_path() / match.str(1), match[1]);
        });
        for_each_match(text.text, path, [&](const Match& match) { check(root / match.str(1), match[1]); });
    }
    return problems;
}

} // namespace tetrace::test
