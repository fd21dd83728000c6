#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tetrace {

/// Values as the bytes of a message. Both ends are the same program on the same machine: values are copied as they lie.
class ByteWriter {
public:
    template <class T>
    void put(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        append(&value, sizeof value);
    }
    void put_text(std::string_view text)
    {
        put(std::uint64_t{text.size()});
        append(text.data(), text.size());
    }
    template <class T>
    void put_all(std::span<const T> values)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        put(std::uint64_t{values.size()});
        append(values.data(), values.size_bytes());
    }
    void append(const ByteWriter& other) { bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end()); }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

private:
    void append(const void* from, std::size_t count)
    {
        const auto* const first = static_cast<const std::byte*>(from);
        bytes_.insert(bytes_.end(), first, first + count);
    }

    std::vector<std::byte> bytes_;
};

/// Reads what a ByteWriter wrote, in the same order. Throws Error{internal} if fewer bytes are left than are asked
/// for.
class ByteReader {
public:
    explicit ByteReader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    template <class T>
    [[nodiscard]] T get()
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        if constexpr (std::is_same_v<T, bool>) return get<unsigned char>() != 0; // no other bits are a bool's
        T value{};
        take(&value, sizeof value);
        return value;
    }
    [[nodiscard]] std::string get_text()
    {
        std::string text(count_of(1), '\0');
        take(text.data(), text.size());
        return text;
    }
    template <class T>
    [[nodiscard]] std::vector<T> get_all()
    {
        std::vector<T> values(count_of(sizeof(T)));
        take(values.data(), values.size() * sizeof(T));
        return values;
    }

private:
    /// A number of elements that the rest of the message can hold.
    [[nodiscard]] std::size_t count_of(std::size_t element_bytes)
    {
        const auto count = get<std::uint64_t>();
        if (count > (bytes_.size() - next_) / element_bytes) reject();
        return static_cast<std::size_t>(count);
    }
    void take(void* to, std::size_t count)
    {
        if (count > bytes_.size() - next_) reject();
        if (count > 0) std::memcpy(to, bytes_.data() + next_, count);
        next_ += count;
    }
    [[noreturn]] static void reject()
    {
        throw Error(ErrorKind::internal, "a message from or to a driver's process is damaged: it is too short");
    }

    std::vector<std::byte> bytes_;
    std::size_t next_ = 0;
};

} // namespace tetrace
