#pragma once

#include "core/base/error.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace tetrace {

/// The names of an enum's values, in the order of their declaration. An enum that has some specialises it:
///     template <> inline constexpr auto enum_names<Colour> = names_up_to<Colour::blue>("red", "green", "blue");
template <class Enum>
inline constexpr int enum_names = 0;

/// Does not compile where the names are not as many as the values up to the last one.
template <auto last, class... Name>
[[nodiscard]] consteval auto names_up_to(Name... names)
{
    static_assert(sizeof...(names) == static_cast<std::size_t>(last) + 1, "each value has a name");
    return std::array<std::string_view, sizeof...(names)>{names...};
}

template <class Enum>
concept NamedEnum = requires
{
    enum_names<Enum>.size();
};

/// Throws Error{internal} if the enum lacks the value.
[[nodiscard]] constexpr std::string_view name_of(NamedEnum auto value)
{
    const auto& names = enum_names<decltype(value)>;
    const auto index = static_cast<std::size_t>(value);
    if (index >= names.size()) throw Error(ErrorKind::internal, "name_of: no such value");
    return names[index];
}

/// Every value, in the order of declaration.
template <NamedEnum Enum>
[[nodiscard]] std::vector<Enum> values_of()
{
    std::vector<Enum> values;
    for (std::size_t i = 0; i < enum_names<Enum>.size(); ++i)
        values.push_back(static_cast<Enum>(i));
    return values;
}

/// The value of that name; empty if none has it.
template <NamedEnum Enum>
[[nodiscard]] constexpr std::optional<Enum> value_named(std::string_view name)
{
    const auto& names = enum_names<Enum>;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<Enum>(i);
    return std::nullopt;
}

} // namespace tetrace
