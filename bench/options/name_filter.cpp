#include "bench/options/name_filter.h"

#include "core/base/error.h"

#include <fmt/format.h>
#include <re2/re2.h>

namespace tetrace {

NameFilter::NameFilter(const std::string& option, const std::string& expression)
{
    if (expression.empty()) return;
    re2::RE2::Options quiet;
    quiet.set_log_errors(false);
    expression_ = std::make_shared<const re2::RE2>(expression, quiet);
    if (!expression_->ok())
        throw Error(ErrorKind::usage, fmt::format("{}: '{:.200}' is not a regular expression (RE2 syntax): {:.200}",
                                                  option, expression, expression_->error()));
}

bool NameFilter::keeps(const std::string& name) const
{
    return expression_ == nullptr || expression_->Match(name, 0, name.size(), re2::RE2::UNANCHORED, nullptr, 0);
}

} // namespace tetrace
