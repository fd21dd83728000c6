#include "bench/output/self_test_json.h"

namespace tetrace {

nlohmann::json self_test_json(const SelfTest& test)
{
    return {{"exact", test.is_exact()},
            {"contracts", test.contracts},
            {"denormals_kept", test.denormals_kept},
            {"division_ulps", test.division_ulps},
            {"square_root_ulps", test.square_root_ulps},
            {"sums_right", test.sums_right},
            {"comparisons_right", test.comparisons_right},
            {"integers_right", test.integers_right},
            {"conversions_right", test.conversions_right},
            {"bits_kept", test.bits_kept},
            {"text", test.text()}};
}

} // namespace tetrace
