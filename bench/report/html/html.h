#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tetrace {

/// Attributes of an element, by name. Names are the program's own; values are always escaped.
using Attributes = std::vector<std::pair<std::string_view, std::string>>;

/// HTML markup, including SVG. Only text() and element() create it, so text from a result file is never read as markup.
class Html {
public:
    Html() = default;
    Html& operator+=(const Html& more)
    {
        markup_ += more.markup_;
        return *this;
    }
    [[nodiscard]] const std::string& str() const { return markup_; }
    [[nodiscard]] bool empty() const { return markup_.empty(); }

private:
    explicit Html(std::string markup) : markup_(std::move(markup)) {}
    std::string markup_;

    friend Html text(std::string_view plain);
    friend Html element(std::string_view name, const Attributes& attributes, const Html& content);
    friend Html style_sheet();
    friend Html whole_page(const Html& head, const Html& body);
};

[[nodiscard]] inline Html operator+(Html left, const Html& right)
{
    return left += right;
}

/// A plain text, escaped (see xml_text()).
[[nodiscard]] Html text(std::string_view plain);

/// <name attributes>content</name>; meta and img, which never have content, are not closed.
[[nodiscard]] Html element(std::string_view name, const Attributes& attributes, const Html& content = {});

/// An element of a class that contains only text; no class attribute where the class is empty.
[[nodiscard]] Html text_element(std::string_view name, std::string_view css_class, std::string_view plain);

/// The page's own style sheet, as a style element.
[[nodiscard]] Html style_sheet();

/// <!DOCTYPE html> and the html element.
[[nodiscard]] Html whole_page(const Html& head, const Html& body);

/// Bytes as base64 (RFC 4648, section 4, with padding).
[[nodiscard]] std::string base64(std::string_view bytes);

} // namespace tetrace
