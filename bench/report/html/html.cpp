#include "bench/report/html/html.h"

#include "bench/terminal/text.h"

namespace tetrace {

Html text(std::string_view plain)
{
    return Html(xml_text(std::string(plain)));
}

Html element(std::string_view name, const Attributes& attributes, const Html& content)
{
    std::string markup("<");
    markup += name;
    for (const auto& [key, value] : attributes)
        markup.append(" ").append(key).append("=\"").append(xml_text(value)).append("\"");
    markup += ">";
    if (name == "meta" || name == "img") return Html(std::move(markup));
    return Html(markup.append(content.str()).append("</").append(name).append(">"));
}

Html text_element(std::string_view name, std::string_view css_class, std::string_view plain)
{
    if (css_class.empty()) return element(name, {}, text(plain));
    return element(name, {{"class", std::string(css_class)}}, text(plain));
}

Html whole_page(const Html& head, const Html& body)
{
    return Html("<!DOCTYPE html>\n" +
                element("html", {{"lang", "en"}}, element("head", {}, head) + element("body", {}, body)).str() + "\n");
}

std::string base64(std::string_view bytes)
{
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string encoded;
    encoded.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto octet = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
        const unsigned group = octet(i) << 16 | octet(i + 1) << 8 | octet(i + 2);
        for (unsigned k = 0; k < 4; ++k)
            encoded += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return encoded;
}

} // namespace tetrace
