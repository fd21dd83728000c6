#include "scenes/builder/vtu_array.h"

#include "scenes/builder/word_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace tetrace {
namespace {

constexpr std::size_t max_deflation = 1100; // zlib reaches 1032

/// Of the letter of base64 its six bits; 64 for others.
std::uint32_t six_bits_of(char letter)
{
    if (letter >= 'A' && letter <= 'Z') return static_cast<std::uint32_t>(letter - 'A');
    if (letter >= 'a' && letter <= 'z') return static_cast<std::uint32_t>(letter - 'a') + 26;
    if (letter >= '0' && letter <= '9') return static_cast<std::uint32_t>(letter - '0') + 52;
    return letter == '+' ? 62 : letter == '/' ? 63 : 64;
}

/// Bytes of an array from the front, as they are or out of base64.
class VtuBytes {
public:
    VtuBytes(const MeshSource& source, const VtuArray& array, const VtuEncoding& encoding)
        : source_(source), array_(array), encoding_(encoding), text_(array.text)
    {
        is_raw_ = array.format == "appended" && encoding.is_appended_raw;
        if (array.format == "appended") {
            if (array.offset > encoding.appended.size()) fail("it begins after the end of the appended data");
            text_ = encoding.appended.substr(array.offset);
        }
    }

    [[noreturn]] void fail(const std::string& problem) const { source_.fail(array_.place, problem); }

    std::string take(std::size_t count)
    {
        std::string taken;
        if (is_raw_) {
            if (count > text_.size()) fail("the file ends inside it");
            taken = text_.substr(0, count);
            text_.remove_prefix(count);
            return taken;
        }
        if (lacks(count)) fail("the file ends inside it");
        while (pending_.size() < count)
            decode_group();
        taken = pending_.substr(0, count);
        pending_.erase(0, count);
        return taken;
    }
    std::uint64_t size()
    {
        const std::string bytes = take(encoding_.header_bytes);
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            const std::size_t from_top = encoding_.is_big_endian ? i : bytes.size() - 1 - i;
            value = value << 8 | static_cast<unsigned char>(bytes[from_top]);
        }
        return value;
    }
    /// So many bytes cannot be left.
    [[nodiscard]] bool lacks(std::uint64_t count) const { return count > text_.size() + pending_.size(); }

private:
    /// Padding inside the text ends one part of it, and another follows: headers are parts by themselves.
    void decode_group()
    {
        std::uint32_t bits = 0, letters = 0, padding = 0;
        while (letters < 4) {
            if (text_.empty()) fail("the file ends inside it");
            const char letter = text_.front();
            text_.remove_prefix(1);
            if (letter == ' ' || letter == '\n' || letter == '\r' || letter == '\t') continue;
            const std::uint32_t value = letter == '=' ? 0 : six_bits_of(letter);
            if (value > 63) fail("a letter is not of base64");
            padding += letter == '=' ? 1 : 0;
            bits = bits << 6 | value;
            ++letters;
        }
        if (padding > 2) fail("its base64 is damaged");
        for (std::uint32_t i = 0; i < 3 - padding; ++i)
            pending_ += static_cast<char>(bits >> (16 - 8 * i) & 0xFF);
    }

    const MeshSource& source_;
    const VtuArray& array_;
    const VtuEncoding& encoding_;
    std::string_view text_;
    std::string pending_;
    bool is_raw_ = false;
};

std::string unpacked_blocks(VtuBytes& bytes)
{
    const std::uint64_t blocks = bytes.size(), block_bytes = bytes.size(), last_bytes = bytes.size();
    if (bytes.lacks(blocks)) bytes.fail(fmt::format("it announces {} blocks, more than the file can hold", blocks));
    std::vector<std::uint64_t> packed(static_cast<std::size_t>(blocks));
    for (std::uint64_t& size : packed)
        size = bytes.size();
    std::string whole;
    for (std::size_t i = 0; i < packed.size(); ++i) {
        const std::uint64_t wanted = i + 1 == packed.size() && last_bytes > 0 ? last_bytes : block_bytes;
        if (bytes.lacks(packed[i]) || wanted / max_deflation > packed[i])
            bytes.fail(fmt::format("block {} has impossible sizes, {} and {}", i, packed[i], wanted));
        const std::string block = bytes.take(static_cast<std::size_t>(packed[i]));
        const std::size_t before = whole.size();
        whole.resize(before + static_cast<std::size_t>(wanted));
        uLongf size = static_cast<uLongf>(wanted);
        const int result = ::uncompress(reinterpret_cast<Bytef*>(whole.data() + before), &size,
                                        reinterpret_cast<const Bytef*>(block.data()), static_cast<uLong>(block.size()));
        if (result != Z_OK || size != wanted) bytes.fail(fmt::format("zlib cannot unpack block {}", i));
    }
    return whole;
}

template <class Value>
std::vector<double> numbers_in(const std::string& bytes, bool is_big_endian)
{
    std::vector<double> values(bytes.size() / sizeof(Value));
    std::array<char, sizeof(Value)> one{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::copy_n(bytes.data() + i * sizeof(Value), sizeof(Value), one.begin());
        if (is_big_endian) std::ranges::reverse(one);
        Value value{};
        std::memcpy(&value, one.data(), sizeof value);
        values[i] = static_cast<double>(value);
    }
    return values;
}

struct VtuType {
    std::string_view name;
    std::size_t bytes;
    std::vector<double> (*numbers)(const std::string& bytes, bool is_big_endian);
};
constexpr std::array<VtuType, 10> vtu_types = {{{"Int8", 1, numbers_in<std::int8_t>},
                                                {"UInt8", 1, numbers_in<std::uint8_t>},
                                                {"Int16", 2, numbers_in<std::int16_t>},
                                                {"UInt16", 2, numbers_in<std::uint16_t>},
                                                {"Int32", 4, numbers_in<std::int32_t>},
                                                {"UInt32", 4, numbers_in<std::uint32_t>},
                                                {"Int64", 8, numbers_in<std::int64_t>},
                                                {"UInt64", 8, numbers_in<std::uint64_t>},
                                                {"Float32", 4, numbers_in<float>},
                                                {"Float64", 8, numbers_in<double>}}};

} // namespace

std::vector<double> values_of(const MeshSource& source, const VtuArray& array, const VtuEncoding& encoding)
{
    if (array.format == "ascii") {
        WordReader words(source, array.text, false);
        words.begin(array.place);
        std::vector<double> values;
        while (!words.peek().empty())
            values.push_back(words.number());
        return values;
    }
    const auto type = std::ranges::find(vtu_types, array.type, &VtuType::name);
    if (type == vtu_types.end())
        source.fail(array.place, fmt::format("its type '{}' is not one of numbers", array.type));
    if (array.format != "binary" && array.format != "appended")
        source.fail(array.place, fmt::format("its format '{}' is not ascii, binary or appended", array.format));
    VtuBytes bytes(source, array, encoding);
    std::string unpacked;
    if (encoding.is_compressed)
        unpacked = unpacked_blocks(bytes);
    else {
        const std::uint64_t size = bytes.size();
        if (bytes.lacks(size)) bytes.fail("the file ends inside it");
        unpacked = bytes.take(static_cast<std::size_t>(size));
    }
    if (unpacked.size() % type->bytes != 0) bytes.fail("its bytes are not whole numbers of its type");
    return type->numbers(unpacked, encoding.is_big_endian);
}

} // namespace tetrace
