#include "bench/variants/changes.h"
#include "bench/variants/kernel_text.h"
#include "bench/variants/reduction.h"
#include "bench/variants/variant_program.h"
#include "core/base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <regex>
#include <set>

using namespace tetrace;

namespace {

constexpr const char* text = R"(STRUCT(Pair)
{
    uint first;
    uint second;
};

KERNEL_FN uint picked(uint a, bool is_high)
{
    uint low = a & 255u; // of four bytes
    uint high = a >> 8u;
    Pair pair;
    pair.first = is_high ? high : low;
    if (is_high) pair.second = low;
    for (;;) {
        a += 1u;
        if (a > 4u) break;
    }
    return pair.first;
}
)";

/// The lines of the text with one change that the text itself does not have.
std::string added(const std::string& name)
{
    const VariantText kernel(text);
    const std::string changed = kernel.with(kernel.named({name}));
    const auto before = read_kernel_text(text).lines, after = read_kernel_text(changed).lines;
    std::string lines;
    for (const std::string& line : after)
        if (std::ranges::find(before, line) == before.end()) lines += line + "\n";
    return lines;
}

std::vector<std::string> names_of(const VariantText& kernel)
{
    std::vector<std::string> names;
    for (const Change& change : kernel.changes())
        names.push_back(change.name);
    return names;
}

} // namespace

TEST(Changes, do_what_their_kind_says)
{
    const std::string zero = "((a | 1u) * (a | 1u) & 4u)";
    EXPECT_EQ(added("picked.0/zero"), "    uint low = (a & 255u) + " + zero + ";\n");
    EXPECT_EQ(added("picked.2/branch"), "    if (is_high) {\n        pair.first = high;\n    } else {\n"
                                        "        pair.first = low;\n");
    EXPECT_EQ(added("picked.2/once"), "    do {\n        pair.first = is_high ? high : low;\n    } while (false);\n");
    EXPECT_EQ(added("picked.2/round"), "    for (uint variant_round = 0u; variant_round <= " + zero +
                                           "; variant_round++) {\n        pair.first = is_high ? high : low;\n");
    EXPECT_EQ(added("picked.2/guard"), "    if (" + zero + " == 0u) {\n        pair.first = is_high ? high : low;\n");
    EXPECT_EQ(added("picked.4/dead"), "    if (" + zero + " != 0u) return 0u;\n");
    EXPECT_EQ(added("picked.0/once_loop"), "    do {\n    } while (false);\n");
    EXPECT_EQ(added("picked.0/dead_break"), "        if (" + zero + " != 0u) break;\n");
    const std::string in_struct = added("picked/struct");
    EXPECT_NE(in_struct.find("    bool is_high = variant_all.of_is_high;\n"), std::string::npos) << in_struct;
    EXPECT_NE(in_struct.find("    return variant_of_picked(variant_all);\n"), std::string::npos) << in_struct;
}

TEST(Changes, swap_only_statements_that_do_not_need_each_other)
{
    const VariantText kernel(text);
    const auto names = names_of(kernel);
    EXPECT_EQ(std::ranges::count(names, "picked.0/swap"), 1);
    EXPECT_EQ(std::ranges::count(names, "picked.1/swap"), 0) << "a declaration is between them";
    EXPECT_EQ(std::ranges::count_if(names, [](const std::string& name) { return name.ends_with("/swap"); }), 1);
}

TEST(Changes, select_only_what_has_a_value_already)
{
    const auto names = names_of(VariantText(text));
    EXPECT_EQ(std::ranges::count(names, "picked.3/select"), 0) << "pair.second was not set before";
    std::string set = text;
    set.replace(set.find("    if (is_high)"), 0, "    pair.second = 0u;\n");
    const VariantText kernel(set);
    const std::string changed = kernel.with(kernel.named({"picked.4/select"}));
    EXPECT_NE(changed.find("    pair.second = (is_high) ? (low) : pair.second;\n"), std::string::npos) << changed;
}

TEST(Changes, are_chosen_by_seed_and_number_and_never_touch_each_other)
{
    const VariantProgram program("opencl", {.method = Method::project, .layout = Layout::half32});
    const VariantText& kernel = program.text();
    EXPECT_GT(kernel.changes().size(), 1000u);
    std::set<std::string> texts;
    for (std::uint32_t number = 1; number <= 16; ++number) {
        const auto chosen = kernel.choose(7, number);
        EXPECT_EQ(chosen, kernel.choose(7, number));
        EXPECT_NE(chosen, kernel.choose(8, number));
        std::vector<std::string> names;
        for (const std::size_t change : chosen)
            names.push_back(kernel.changes()[change].name);
        EXPECT_EQ(kernel.named(names), chosen); // which throws if two touch
        texts.insert(kernel.with(chosen));
    }
    EXPECT_EQ(texts.size(), 16u);
}

TEST(Changes, neither_add_nor_drop_an_operation_on_floats)
{
    // Products, quotients and differences, without those of the opaque zeros.
    const auto operations = [](const std::string& changed) {
        static const std::regex opaque("\\(\\((\\S+) \\| 1u\\) \\* \\(\\1 \\| 1u\\) & 4u\\)"), one(" [*/-] ");
        const std::string own = std::regex_replace(changed, opaque, "0u");
        return std::distance(std::sregex_iterator(own.begin(), own.end(), one), {});
    };
    for (const Layout layout : {Layout::half32, Layout::tet80}) {
        const VariantProgram program("opencl", {.method = Method::project, .layout = layout});
        const auto before = operations(program.text().with({}));
        EXPECT_GT(before, 100);
        for (std::uint32_t number = 1; number <= 8; ++number)
            EXPECT_EQ(operations(program.text().with(program.text().choose(3, number))), before) << number;
    }
}

TEST(Changes, of_a_name_that_there_is_not_or_of_one_place_are_refused)
{
    const VariantText kernel(text);
    EXPECT_THROW(static_cast<void>(kernel.named({"picked.99/zero"})), Error);
    EXPECT_THROW(static_cast<void>(kernel.named({"picked.2/once", "picked.2/guard"})), Error);
    EXPECT_EQ(kernel.with({}), text);
}

TEST(Reduction, finds_the_changes_that_are_needed_together)
{
    std::vector<std::size_t> all(300);
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (const std::vector<std::size_t>& needed : {std::vector<std::size_t>{0}, {299}, {17, 250}, {3, 4, 140, 298}}) {
        unsigned tries = 0;
        const auto found = smallest_failing(all, [&](const std::vector<std::size_t>& tried) {
            ++tries;
            EXPECT_FALSE(tried.empty());
            return std::ranges::includes(tried, needed);
        });
        EXPECT_EQ(found, needed);
        EXPECT_LT(tries, 300u);
    }
}
