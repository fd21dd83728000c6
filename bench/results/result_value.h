#pragma once

#include "core/base/enum_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// The text of a result file: what an array or an object holds is filled into lines of up to 120 characters, as far as
/// it fits; what is longer begins a line of its own, and its contents are indented by one more blank. It ends in a line
/// break. Reading it gives the same value, but for texts that are not UTF-8, in which U+FFFD takes the place of each
/// bad byte, so that no result is lost because of a path. A number a line, as other writers have it, takes twice the
/// bytes for results with many samples or points.
[[nodiscard]] std::string result_text(const nlohmann::json& value);

/// Where a row of a result has a field: its key, in the object that `group` names or, if that is empty, in the row
/// itself.
struct RowPath {
    const char* group; ///< such as "times"
    const char* key;
};

/// A value of a result file that knows its place in it. A request that the value does not meet throws
/// Error{invalid_input} naming the file and the key, for example "a.json: tetrace.rows[3].times.samples_s: ...".
/// Refers to the JSON that it was made of, which has to outlive it.
class ResultValue {
public:
    /// The whole of a file. what: what it is read as, for messages; a literal.
    ResultValue(const nlohmann::json& value, std::string file, const char* what = "result")
        : value_(&value), what_(what), file_(std::move(file))
    {
    }

    [[nodiscard]] ResultValue at(const std::string& key) const;                     ///< of an object that has the key
    [[nodiscard]] std::optional<ResultValue> find(const std::string& key) const;    ///< of an object that may have it
    [[nodiscard]] ResultValue at(const RowPath& path) const;                        ///< of a row that has the field
    [[nodiscard]] std::optional<ResultValue> find(const RowPath& path) const;       ///< of a row that may have it
    [[nodiscard]] std::vector<ResultValue> items() const;                           ///< of an array
    [[nodiscard]] std::vector<std::pair<std::string, ResultValue>> members() const; ///< of an object

    [[nodiscard]] std::string text() const; ///< any string, several lines perhaps
    /// The text of an object's member; empty if it lacks the key.
    [[nodiscard]] std::string text_at(const std::string& key) const
    {
        const auto value = find(key);
        return value ? value->text() : std::string();
    }
    [[nodiscard]] std::string line() const;    ///< a string without control characters, safe to print anywhere
    [[nodiscard]] std::string hash() const;    ///< 16 hexadecimal digits
    [[nodiscard]] double number() const;       ///< finite
    [[nodiscard]] std::uint64_t count() const; ///< whole, not negative
    [[nodiscard]] bool flag() const;

    [[nodiscard]] const nlohmann::json& json() const { return *value_; }
    /// Throws Error{invalid_input}: file, key, and what is wrong with the value.
    [[noreturn]] void reject(const std::string& what) const;

private:
    [[nodiscard]] ResultValue part(const nlohmann::json& value, std::string key) const
    {
        ResultValue part(value, file_, what_);
        part.key_ = std::move(key);
        return part;
    }
    [[nodiscard]] ResultValue member(const std::string& key, const nlohmann::json& value) const
    {
        return part(value, key_.empty() ? key : key_ + "." + key);
    }
    void require(bool is, const char* what) const;

    const nlohmann::json* value_;
    const char* what_;
    std::string file_;
    std::string key_; ///< empty: the whole
};

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
    const auto found = value_named<Enum>(name);
    if (!found) from.reject(fmt::format("is '{}'; this tetrace knows {}", name, fmt::join(enum_names<Enum>, ", ")));
    to = *found;
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
