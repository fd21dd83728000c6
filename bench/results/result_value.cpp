#include "bench/results/result_value.h"

#include "core/base/error.h"
#include "core/base/printable.h"

#include <cmath>
#include <fmt/format.h>

namespace tetrace {

void ResultValue::reject(const std::string& what) const
{
    throw Error(ErrorKind::invalid_input,
                fmt::format("reading the result '{}': {}{}{}", file_, key_, key_.empty() ? "" : ": ", what));
}

void ResultValue::require(bool is, const char* what) const
{
    if (!is) reject(fmt::format("is not {} ({})", what, value_->type_name()));
}

std::optional<ResultValue> ResultValue::find(const std::string& key) const
{
    require(value_->is_object(), "an object");
    const auto found = value_->find(key);
    if (found == value_->end()) return std::nullopt;
    return member(key, *found);
}

ResultValue ResultValue::at(const std::string& key) const
{
    if (auto found = find(key)) return *std::move(found);
    reject(fmt::format("has no '{}'", key));
}

std::vector<ResultValue> ResultValue::items() const
{
    require(value_->is_array(), "an array");
    std::vector<ResultValue> values;
    for (const nlohmann::json& item : *value_)
        values.push_back({item, file_, fmt::format("{}[{}]", key_, values.size())});
    return values;
}

std::vector<std::pair<std::string, ResultValue>> ResultValue::members() const
{
    require(value_->is_object(), "an object");
    std::vector<std::pair<std::string, ResultValue>> values;
    for (const auto& [key, value] : value_->items())
        values.emplace_back(key, member(key, value));
    return values;
}

std::string ResultValue::text() const
{
    require(value_->is_string(), "a text");
    return value_->get<std::string>();
}

std::string ResultValue::line() const
{
    std::string line = text();
    if (printable_line(line) != line) reject("holds a control character");
    return line;
}

std::string ResultValue::hash() const
{
    std::string digits = text();
    if (digits.size() != 16 || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
        reject("is not a hash of 16 hexadecimal digits");
    return digits;
}

double ResultValue::number() const
{
    require(value_->is_number() && std::isfinite(value_->get<double>()), "a finite number");
    return value_->get<double>();
}

std::uint64_t ResultValue::count() const
{
    require(value_->is_number_unsigned(), "a whole number that is not negative");
    return value_->get<std::uint64_t>();
}

bool ResultValue::flag() const
{
    require(value_->is_boolean(), "true or false");
    return value_->get<bool>();
}

} // namespace tetrace
