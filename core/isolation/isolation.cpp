#include "core/isolation/isolation.h"

#include "core/isolation/isolated_backend.h"

#include <algorithm>

namespace tetrace {

namespace {

struct Decision {
    Isolation isolation = Isolation::none;
    double call_limit_s = 0;
};

Decision& decision()
{
    static Decision made;
    return made;
}

} // namespace

void set_isolation(Isolation isolation, double call_limit_s)
{
    decision() = {isolation, call_limit_s};
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
    for (Backend*& backend : all)
        if (std::ranges::find(foreign, backend->name()) != foreign.end())
            backend = made.emplace_back(std::make_unique<IsolatedBackend>(*backend, processes)).get();
    return all;
}

} // namespace tetrace
