#include "bench/results/npy.h"

#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <string_view>
#include <type_traits>

namespace tetrace {

static_assert(std::endian::native == std::endian::little, "numbers are copied to and from files unchanged");

namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr std::size_t npy_alignment = 64; // of the data, as NumPy writes it

/// A .npy file as it is read, for messages.
class NpyFile {
public:
    explicit NpyFile(const std::filesystem::path& path) : name_(path.string())
    {
        auto bytes = file_bytes(path);
        if (!bytes)
            throw Error(ErrorKind::missing,
                        fmt::format("reading {}: there is no such file, or it cannot be read; check "
                                    "its name",
                                    name_));
        bytes_ = std::move(*bytes);
        split();
    }

    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const
    {
        throw Error(ErrorKind::invalid_input, fmt::format("reading {}: {}; {}", name_, problem, remedy));
    }
    [[nodiscard]] std::string_view data() const { return data_; }

    /// The value of a key of the header, a Python literal without lists and dictionaries.
    [[nodiscard]] std::string_view value_of(std::string_view key) const
    {
        for (const char quote : {'\'', '"'}) {
            const std::string quoted = fmt::format("{0}{1}{0}", quote, key);
            const std::size_t found = header_.find(quoted);
            if (found == std::string_view::npos) continue;
            const std::size_t begin = header_.find_first_not_of(" :", found + quoted.size());
            if (begin == std::string_view::npos) break;
            const bool is_tuple = header_[begin] == '(';
            const std::size_t end = header_.find_first_of(is_tuple ? ")" : ",}", begin);
            if (end == std::string_view::npos) break;
            return header_.substr(begin, end - begin + (is_tuple ? 1 : 0));
        }
        fail(fmt::format("its header lacks '{}'", key), again);
    }

    static constexpr const char* again = "write it again with numpy.save";

private:
    void split()
    {
        if (!bytes_.starts_with(npy_magic) || bytes_.size() < 10)
            fail("it is not a .npy file", "write it with numpy.save; .npz files and text are not read");
        const int version = static_cast<unsigned char>(bytes_[6]);
        if (version != 1 && version != 2)
            fail(fmt::format("its format version is {}, and 1 and 2 are read", version),
                 "rename no fields: save a plain array with numpy.save");
        const std::size_t length_bytes = version == 1 ? 2 : 4, begin = 8 + length_bytes;
        std::uint32_t length = 0;
        if (bytes_.size() >= begin) std::memcpy(&length, bytes_.data() + 8, length_bytes);
        if (bytes_.size() < begin || bytes_.size() - begin < length) fail("it ends inside its header", again);
        header_ = std::string_view(bytes_).substr(begin, length);
        data_ = std::string_view(bytes_).substr(begin + length);
    }

    std::string name_, bytes_;
    std::string_view header_, data_;
};

/// The numbers of a tuple "(10, 8)"; nothing if it is none.
std::optional<std::vector<std::size_t>> sizes_of(std::string_view tuple)
{
    if (!tuple.starts_with('(') || !tuple.ends_with(')')) return std::nullopt;
    tuple = tuple.substr(1, tuple.size() - 2);
    std::vector<std::size_t> sizes;
    while (true) {
        tuple.remove_prefix(std::min(tuple.find_first_not_of(" ,"), tuple.size()));
        if (tuple.empty()) return sizes;
        std::size_t size = 0;
        const auto [end, problem] = std::from_chars(tuple.data(), tuple.data() + tuple.size(), size);
        if (problem != std::errc()) return std::nullopt;
        sizes.push_back(size);
        tuple.remove_prefix(static_cast<std::size_t>(end - tuple.data()));
    }
}

bool is_float64(const NpyFile& file)
{
    const std::string type = printable_line(std::string(file.value_of("descr")));
    if (type == "'<f4'" || type == "'<f8'") return type == "'<f8'";
    file.fail(fmt::format("its type is {}, and '<f4' (float32) and '<f8' (float64) are read", type),
              "convert it with array.astype('<f4'), or '<f8'");
}

template <class Number>
void copy_numbers(std::string_view bytes, std::vector<double>& values)
{
    for (std::size_t i = 0; i < values.size(); ++i) {
        Number value;
        std::memcpy(&value, bytes.data() + i * sizeof(Number), sizeof(Number));
        values[i] = static_cast<double>(value);
    }
}

} // namespace

NpyArray read_npy(const std::filesystem::path& path, std::size_t columns, const std::string& what)
{
    const NpyFile file(path);
    NpyArray array;
    array.is_double = is_float64(file);
    if (file.value_of("fortran_order") != "False")
        file.fail("it is in Fortran order", "save numpy.ascontiguousarray(array)");
    const std::string shape = printable_line(std::string(file.value_of("shape")));
    const auto sizes = sizes_of(shape);
    if (!sizes || sizes->size() != 2 || sizes->back() != columns)
        file.fail(fmt::format("its shape is {}, and N x {} is needed: {}", shape, columns, what),
                  "see docs/judge.md for what its columns are");
    array.rows = sizes->front();
    array.columns = columns;
    const std::size_t size = array.is_double ? 8 : 4, held = file.data().size() / size;
    if (held / columns != array.rows || file.data().size() != array.rows * columns * size)
        file.fail(fmt::format("its header says {} rows of {} bytes, and {} bytes follow", array.rows, columns * size,
                              file.data().size()),
                  NpyFile::again);
    array.values.resize(array.rows * columns);
    if (array.is_double)
        copy_numbers<double>(file.data(), array.values);
    else
        copy_numbers<float>(file.data(), array.values);
    return array;
}

namespace {

template <class Number>
constexpr std::string_view npy_type()
{
    if constexpr (std::is_same_v<Number, std::int32_t>) return "<i4";
    if constexpr (std::is_same_v<Number, std::int64_t>) return "<i8";
    if constexpr (std::is_same_v<Number, std::uint32_t>) return "<u4";
    if constexpr (std::is_same_v<Number, std::uint64_t>) return "<u8";
    if constexpr (std::is_same_v<Number, float>) return "<f4";
    if constexpr (std::is_same_v<Number, double>) return "<f8";
}

/// type, shape: as Python literals.
std::string npy_head(const std::string& type, const std::string& shape)
{
    std::string header = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", type, shape);
    const std::size_t before = npy_magic.size() + 4; // version and length
    header.append(npy_alignment - (before + header.size() + 1) % npy_alignment, ' ');
    header += '\n';
    std::string bytes(npy_magic);
    bytes += {'\1', '\0', static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
    return bytes + header;
}

/// Where a column's numbers are, and how they are called.
struct NpyField {
    const char* bytes;
    std::size_t size;
    std::string_view type;
};

NpyField field_of(const NpyColumn& column)
{
    return std::visit(
        [](const auto& values) {
            using Number = typename std::remove_cvref_t<decltype(values)>::value_type;
            return NpyField{reinterpret_cast<const char*>(values.data()), sizeof(Number), npy_type<Number>()};
        },
        column.values);
}

} // namespace

void write_npy(const std::filesystem::path& path, std::size_t columns, std::span<const float> values)
{
    std::string bytes = npy_head("'<f4'", fmt::format("({}, {})", values.size() / columns, columns));
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    write_whole(path, bytes);
}

void write_npy(const std::filesystem::path& path, std::span<const NpyColumn> columns)
{
    const std::size_t rows = std::visit([](const auto& values) { return values.size(); }, columns.front().values);
    std::string type;
    std::vector<NpyField> fields;
    for (const NpyColumn& column : columns) {
        fields.push_back(field_of(column));
        type += fmt::format("('{}', '{}'), ", column.name, fields.back().type);
    }
    std::string bytes = npy_head(fmt::format("[{}]", type), fmt::format("({},)", rows));
    for (std::size_t row = 0; row < rows; ++row)
        for (const NpyField& field : fields)
            bytes.append(field.bytes + row * field.size, field.size);
    write_whole(path, bytes);
}

} // namespace tetrace
