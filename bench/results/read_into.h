#pragma once

#include "bench/results/result_value.h"
#include "core/base/enum_names.h"

#include <concepts>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace tetrace {

// Reads a value of a result into a member of its type. Each throws Error{invalid_input} naming file and key for a value
// that the type does not have.

inline void read_into(double& to, const ResultValue& from)
{
    to = from.number();
}
inline void read_into(bool& to, const ResultValue& from)
{
    to = from.flag();
}
/// Of one line.
inline void read_into(std::string& to, const ResultValue& from)
{
    to = from.line();
}
template <std::unsigned_integral Count>
void read_into(Count& to, const ResultValue& from)
{
    const std::uint64_t count = from.count();
    if (count > std::numeric_limits<Count>::max()) from.reject("is too large");
    to = static_cast<Count>(count);
}
/// By its name.
template <NamedEnum Enum>
void read_into(Enum& to, const ResultValue& from)
{
    const std::string name = from.line();
    for (const Enum one : values_of<Enum>())
        if (name == name_of(one)) {
            to = one;
            return;
        }
    from.reject(fmt::format("is '{}'; this tetrace knows {}", name, fmt::join(enum_names<Enum>, ", ")));
}
template <class Value>
void read_into(std::optional<Value>& to, const ResultValue& from)
{
    read_into(to.emplace(), from);
}
template <class Value>
void read_into(std::vector<Value>& to, const ResultValue& from)
{
    to.clear();
    for (const ResultValue& item : from.items())
        read_into(to.emplace_back(), item);
}

/// If the object has the key.
template <class Value>
void read_member(Value& to, const ResultValue& object, const char* key)
{
    if (const auto value = object.find(key)) read_into(to, *value);
}

} // namespace tetrace
