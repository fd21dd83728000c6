#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// A value of a result file that knows its place in it. A request that the value does not meet throws
/// Error{invalid_input} naming the file and the key, for example "a.json: tetrace.rows[3].times.samples_s: ...".
/// Refers to the JSON that it was made of, which has to outlive it.
class ResultValue {
public:
    /// The whole of a file.
    ResultValue(const nlohmann::json& value, std::string file) : value_(&value), file_(std::move(file)) {}

    [[nodiscard]] ResultValue at(const std::string& key) const;                     ///< of an object that has the key
    [[nodiscard]] std::optional<ResultValue> find(const std::string& key) const;    ///< of an object that may have it
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
    ResultValue(const nlohmann::json& value, std::string file, std::string key)
        : value_(&value), file_(std::move(file)), key_(std::move(key))
    {
    }
    [[nodiscard]] ResultValue member(const std::string& key, const nlohmann::json& value) const
    {
        return {value, file_, key_.empty() ? key : key_ + "." + key};
    }
    void require(bool is, const char* what) const;

    const nlohmann::json* value_;
    std::string file_;
    std::string key_; ///< empty: the whole
};

} // namespace tetrace
