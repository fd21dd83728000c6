#include "bench/reproduce/operations/operations.h"

#include "bench/reproduce/tables/tables.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

MethodCost cost_of(Method method)
{
    static const std::vector<MethodCost> costs = count_operations();
    for (const MethodCost& cost : costs)
        if (cost.method == method) return cost;
    throw std::runtime_error("no such method");
}

} // namespace

// The numbers are those of docs/spec/methods.md, M2 and M8.
TEST(Operations, searches_cost_what_the_specification_says)
{
    EXPECT_EQ(cost_of(Method::maria).least, 28);
    EXPECT_EQ(cost_of(Method::maria).most, 28);
    EXPECT_EQ(cost_of(Method::maria).products, 2);
    EXPECT_EQ(cost_of(Method::maria).max_products, 2);
    EXPECT_EQ(cost_of(Method::ms06).least, 46);
    EXPECT_EQ(cost_of(Method::ms06).most, 69);
    EXPECT_EQ(cost_of(Method::ms06).max_products, 3);
    EXPECT_NEAR(*cost_of(Method::ms06).products, 8.0 / 3, 5 * cost_of(Method::ms06).products_error);
    EXPECT_LT(cost_of(Method::ms06).products_error, 0.005);
    EXPECT_NEAR(*cost_of(Method::stp).products, 11.0 / 3, 5 * cost_of(Method::stp).products_error);
    EXPECT_NEAR(*cost_of(Method::plucker).products, 11.0 / 3, 5 * cost_of(Method::plucker).products_error);
    EXPECT_FALSE(cost_of(Method::plane).products);
    EXPECT_EQ(cost_of(Method::project).most, 46);
}

TEST(Operations, a_start_takes_three_side_products)
{
    for (const Method method : {Method::maria, Method::ms06, Method::stp, Method::plucker}) {
        EXPECT_EQ(cost_of(method).start_products, 3) << name_of(method);
        EXPECT_EQ(cost_of(method).start, 60) << name_of(method);
    }
}

TEST(Operations, the_table_has_the_papers_next_to_them_and_its_claims_decided)
{
    const PaperTable table = operations_table();
    ASSERT_EQ(table.rows.size(), 6u);
    const auto cell = [&](Method method, const std::string& key) {
        for (const auto& row : table.rows)
            for (std::size_t c = 0; c < row.size(); ++c)
                if (std::get<std::string>(row[0]) == name_of(method) && table.columns[c].key == key)
                    return std::get<Quantity>(row[c]);
        throw std::runtime_error("no such cell");
    };
    EXPECT_EQ(cell(Method::maria, "operations").ratio(), 1);
    EXPECT_EQ(cell(Method::maria, "products").ratio(), 1);
    EXPECT_EQ(cell(Method::maria, "start_products").ratio(), 1);
    EXPECT_EQ(cell(Method::ms06, "products").paper, 2.67);
    EXPECT_TRUE(cell(Method::ms06, "products").ours.low);
    EXPECT_FALSE(cell(Method::stp, "products").paper);
    ASSERT_EQ(table.claims.size(), 6u);
    for (const Claim& claim : table.claims)
        EXPECT_EQ(claim.verdict, ClaimVerdict::holds) << claim.id << ": " << claim.evidence;
}
