// WGSL's types and functions for text that wgsl_as_cpp rewrote.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

using u32 = std::uint32_t;
using f32 = float;
template <class T>
struct vec4 {
    T x, y, z, w;
};
template <class T, u32 count>
using array = std::array<T, count>;
using Bytes = std::span<const std::byte>;

/// A storage buffer; an index outside of it is moved inside, as a browser does.
template <class T>
struct Storage {
    T* first = nullptr;
    std::size_t count = 0;
    T& operator[](u32 index) const { return first[std::min<std::size_t>(index, count - 1)]; }
};

template <class T>
void set_storage(Storage<T>& storage, Bytes bytes)
{
    storage = {reinterpret_cast<T*>(const_cast<std::byte*>(bytes.data())), bytes.size() / sizeof(T)};
}
template <class T>
void set_storage(T& value, Bytes bytes)
{
    std::memcpy(&value, bytes.data(), sizeof value);
}

template <class To, class From>
To bitcast(From from)
{
    return std::bit_cast<To>(from);
}
/// Up to three units in the last place away; WGSL allows two and a half.
inline f32 rough(f32 quotient)
{
    const u32 bits = bitcast<u32>(quotient);
    return (bits & 0x7FFFFFFFu) < 8u ? quotient : bitcast<f32>(bits - 3u + (bits * 2654435761u >> 8u) % 7u);
}
template <class T>
T select(T no, T yes, bool is_yes)
{
    return is_yes ? yes : no;
}
inline u32 firstLeadingBit(u32 value)
{
    return 31u - static_cast<u32>(std::countl_zero(value));
}
inline u32 countOneBits(u32 value)
{
    return static_cast<u32>(std::popcount(value));
}
using std::abs, std::sqrt, std::min, std::max;
