#include "bench/results/self_test_json.h"

namespace tetrace {

namespace {

/// Calls visit(key, member) for each thing that a self-test found.
template <class AnyTest, class Visit>
void each_finding(AnyTest& test, const Visit& visit)
{
    visit("contracts", test.contracts);
    visit("reassociates", test.reassociates);
    visit("denormals_kept", test.denormals_kept);
    visit("division_ulps", test.division_ulps);
    visit("square_root_ulps", test.square_root_ulps);
    visit("sums_right", test.sums_right);
    visit("comparisons_right", test.comparisons_right);
    visit("integers_right", test.integers_right);
    visit("conversions_right", test.conversions_right);
    visit("bits_kept", test.bits_kept);
}

} // namespace

nlohmann::json self_test_json(const SelfTest& test)
{
    nlohmann::json object = {{"exact", test.is_exact()}, {"text", test.text()}};
    each_finding(test, [&](const char* key, const auto& value) { object[key] = value; });
    return object;
}

SelfTest self_test_from(const ResultValue& value)
{
    SelfTest test;
    each_finding(test, [&](const char* key, auto& member) { read_member(member, value, key); });
    return test;
}

} // namespace tetrace
