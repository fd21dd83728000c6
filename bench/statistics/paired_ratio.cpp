#include "bench/statistics/paired_ratio.h"

#include "core/base/error.h"

#include <algorithm>

namespace tetrace {

PairedRatio paired_ratio(const std::vector<double>& one_s, const std::vector<double>& other_s, Sampling sampling)
{
    if (one_s.size() != other_s.size() || one_s.empty())
        throw Error(ErrorKind::internal, "a paired ratio of times of other views, or of none");
    PairedRatio pair;
    for (std::size_t view = 0; view < one_s.size(); ++view) {
        if (!(one_s[view] > 0) || !(other_s[view] > 0))
            throw Error(ErrorKind::internal, "a paired ratio of times that are not positive");
        pair.views.push_back(other_s[view] / one_s[view]);
    }
    pair.median = median_of_views(pair.views, sampling);
    const auto [lowest, highest] = std::ranges::minmax_element(pair.views);
    pair.lowest = *lowest, pair.highest = *highest;
    const auto won = std::ranges::count_if(pair.views, [](double ratio) { return ratio > 1; });
    pair.won = static_cast<double>(won) / static_cast<double>(pair.views.size());
    return pair;
}

} // namespace tetrace
