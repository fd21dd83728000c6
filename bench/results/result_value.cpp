#include "bench/results/result_value.h"

#include "core/base/error.h"
#include "core/base/printable.h"

#include <fmt/format.h>

#include <cmath>

namespace tetrace {

namespace {

constexpr std::size_t line_width = 120;

std::string in_one_line(const nlohmann::json& value)
{
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Lines that grow by one value after the other.
class FilledLines {
public:
    void add(const nlohmann::json& value, std::size_t indent)
    {
        if (!value.is_structured() || value.empty()) {
            text_ += in_one_line(value);
            return;
        }
        text_ += value.is_object() ? '{' : '[';
        bool fills = false; // whether the line goes on with what fits
        for (auto item = value.begin(); item != value.end(); ++item) {
            if (item != value.begin()) text_ += ',';
            const std::string key = value.is_object() ? in_one_line(item.key()) + ":" : "";
            fills = add_item(key, *item, indent + 1, fills);
        }
        begin_line(indent);
        text_ += value.is_object() ? '}' : ']';
    }
    [[nodiscard]] std::string text() && { return std::move(text_).append("\n"); }

private:
    void begin_line(std::size_t indent)
    {
        text_.append(1, '\n').append(indent, ' ');
        line_begin_ = text_.size() - indent;
    }
    /// Returns whether it was filled into a line.
    bool add_item(const std::string& key, const nlohmann::json& value, std::size_t indent, bool fills)
    {
        const std::string plain = key + in_one_line(value);
        const bool fits = plain.size() + indent < line_width;
        if (!fits || !fills || text_.size() - line_begin_ + plain.size() >= line_width) begin_line(indent);
        text_ += fits ? plain : key;
        if (!fits) add(value, indent);
        return fits;
    }

    std::string text_;
    std::size_t line_begin_ = 0;
};

} // namespace

std::string result_text(const nlohmann::json& value)
{
    FilledLines lines;
    lines.add(value, 0);
    return std::move(lines).text();
}

void ResultValue::reject(const std::string& what) const
{
    throw Error(ErrorKind::invalid_input,
                fmt::format("reading the {} '{}': {}{}{}", what_, file_, key_, key_.empty() ? "" : ": ", what));
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

ResultValue ResultValue::at(const RowPath& path) const
{
    return *path.group == '\0' ? at(path.key) : at(path.group).at(path.key);
}

std::optional<ResultValue> ResultValue::find(const RowPath& path) const
{
    const auto object = *path.group == '\0' ? std::optional(*this) : find(path.group);
    return object ? object->find(path.key) : std::nullopt;
}

std::vector<ResultValue> ResultValue::items() const
{
    require(value_->is_array(), "an array");
    std::vector<ResultValue> values;
    for (const nlohmann::json& item : *value_)
        values.push_back(part(item, fmt::format("{}[{}]", key_, values.size())));
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
