#include "bench/results/result_text.h"

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

} // namespace tetrace
