#include "scenes/builder/xml_tags.h"

#include <fmt/format.h>

#include <algorithm>

namespace tetrace {
namespace {

constexpr std::string_view xml_blanks = " \t\r\n";

} // namespace

std::string_view XmlTag::attribute(std::string_view wanted) const
{
    const auto found = std::ranges::find(attributes, wanted, &std::pair<std::string_view, std::string_view>::first);
    return found == attributes.end() ? std::string_view() : found->second;
}

std::string XmlTags::place(const std::string& element, std::size_t at) const
{
    const std::string_view before = bytes_.substr(0, at);
    return fmt::format("{} (line {})", element, std::ranges::count(before, '\n') + 1);
}

// The end of what begins here.
std::size_t XmlTags::after(std::string_view mark)
{
    const auto end = bytes_.find(mark, at_);
    if (end == std::string_view::npos)
        source_.fail(place("a tag", at_), fmt::format("it does not end with '{}'", mark));
    return end + mark.size();
}

bool XmlTags::next(XmlTag& tag)
{
    for (;;) {
        at_ = std::min(bytes_.find('<', at_), bytes_.size());
        if (at_ == bytes_.size()) return false;
        const std::string_view rest = bytes_.substr(at_);
        if (rest.starts_with("<!--"))
            at_ = after("-->");
        else if (rest.starts_with("<?") || rest.starts_with("<!"))
            at_ = after(">");
        else
            break;
    }
    tag = {};
    tag.begin = at_;
    const std::size_t end = after(">");
    std::string_view inside = bytes_.substr(at_ + 1, end - at_ - 2);
    tag.closes = inside.starts_with('/') || inside.ends_with('/');
    tag.opens = !inside.starts_with('/');
    if (inside.starts_with('/')) inside.remove_prefix(1);
    if (inside.ends_with('/')) inside.remove_suffix(1);
    tag.name = inside.substr(0, inside.find_first_of(xml_blanks));
    if (inside.find('<') != std::string_view::npos) fail_damaged(tag);
    read_attributes(inside.substr(tag.name.size()), tag);
    tag.text = bytes_.substr(end, bytes_.find('<', end) - end);
    at_ = end;
    return true;
}

void XmlTags::fail_damaged(const XmlTag& tag) const
{
    source_.fail(place(fmt::format("tag {:.40}", tag.name), tag.begin), "it is damaged");
}

void XmlTags::read_attributes(std::string_view rest, XmlTag& tag) const
{
    for (;;) {
        rest.remove_prefix(std::min(rest.find_first_not_of(xml_blanks), rest.size()));
        if (rest.empty()) return;
        const auto equals = rest.find('=');
        if (equals == std::string_view::npos) fail_damaged(tag);
        const std::string_view name = rest.substr(0, rest.find_first_of(" \t\r\n="));
        rest.remove_prefix(equals + 1);
        rest.remove_prefix(std::min(rest.find_first_not_of(xml_blanks), rest.size()));
        if (rest.empty() || (rest.front() != '"' && rest.front() != '\'')) fail_damaged(tag);
        const auto end = rest.find(rest.front(), 1);
        if (end == std::string_view::npos) fail_damaged(tag);
        tag.attributes.emplace_back(name, rest.substr(1, end - 1));
        rest.remove_prefix(end + 1);
    }
}

} // namespace tetrace
