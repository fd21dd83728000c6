#pragma once

#include "core/base/printable.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// Appends plain values and strings (length first) to the information section.
class InformationWriter {
public:
    template <class Value>
    void put(Value value)
    {
        const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
        bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    }
    void put(const std::string& text)
    {
        put(static_cast<std::uint64_t>(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }
    [[nodiscard]] std::vector<char> take() { return std::move(bytes_); }

private:
    std::vector<char> bytes_;
};

/// Reads them back from bytes that outlive it. `good` becomes false at the first missing value, and stays so.
class InformationReader {
public:
    explicit InformationReader(std::span<const char> bytes) : rest_(bytes) {}

    template <class Value>
    void get(Value& value)
    {
        std::array<char, sizeof(Value)> raw{};
        if (take(raw)) value = std::bit_cast<Value>(raw);
    }
    void get(std::string& text)
    {
        std::uint64_t size = 0;
        get(size);
        if (!good_ || size > rest_.size()) {
            good_ = false;
            return;
        }
        text = printable_text({rest_.data(), static_cast<std::size_t>(size)});
        rest_ = rest_.subspan(static_cast<std::size_t>(size));
    }
    [[nodiscard]] bool finished() const { return good_ && rest_.empty(); }

private:
    bool take(std::span<char> raw)
    {
        if (raw.size() > rest_.size()) good_ = false;
        if (!good_) return false;
        std::memcpy(raw.data(), rest_.data(), raw.size());
        rest_ = rest_.subspan(raw.size());
        return true;
    }

    std::span<const char> rest_;
    bool good_ = true;
};

} // namespace tetrace
