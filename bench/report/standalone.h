#pragma once

#include <string>
#include <vector>

namespace tetrace {

/// A chart of a page as an SVG file of its own.
struct StandaloneChart {
    std::string name; ///< of the file, from the chart's section and description, each once: "rates-bunny-4-views.svg"
    std::string text; ///< loads nothing; its styles are inside, in the page's light colours, without CSS variables,
                      ///< which drawing programs do not know
};

/// The charts of a page that whole_page() made, in its order.
[[nodiscard]] std::vector<StandaloneChart> standalone_charts(const std::string& page);

} // namespace tetrace
