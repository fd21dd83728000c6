#include "core/isolation/isolation.h"

#include "core/isolation/isolated_backend.h"

#include <algorithm>

namespace tetrace {

namespace {

struct Decision {
    Isolation isolation = Isolation::none;
    double call_limit_s = 0;
    std::vector<std::string> also = {};
};

Decision& decision()
{
    static Decision made;
    return made;
}

} // namespace

void set_isolation(Isolation isolation, double call_limit_s, const std::vector<std::string>& also)
{
    decision() = {isolation, call_limit_s, also};
}

bool is_isolated()
{
    return decision().isolation != Isolation::none;
}

std::vector<Backend*> isolated(const std::vector<Backend*>& backends, const std::vector<std::string>& foreign)
{
    static std::vector<std::unique_ptr<Backend>> made;
    std::vector<Backend*> all = backends;
    DriverProcesses processes;
    processes.arguments = {std::string(driver_verb)};
    processes.call_limit_s = decision().call_limit_s;
    const auto is_of = [](const std::vector<std::string>& names, const Backend* backend) {
        return std::ranges::find(names, backend->name()) != names.end();
    };
    for (Backend*& backend : all)
        if (is_of(foreign, backend) || is_of(decision().also, backend))
            backend = made.emplace_back(std::make_unique<IsolatedBackend>(*backend, processes)).get();
    return all;
}

} // namespace tetrace
