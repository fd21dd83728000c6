// The backends of libFuzzer's programs: names for options, and no driver.
#include "tests/support/fake_backend.h"

namespace tetrace {

const std::vector<Backend*>& all_backends()
{
    static test::FakeBackend openmp("openmp", {}), vulkan("vulkan", {});
    static const std::vector<Backend*> all = {&openmp, &vulkan};
    return all;
}

} // namespace tetrace
