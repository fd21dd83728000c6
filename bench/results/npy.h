#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tetrace {

/// The numbers of a .npy file of NumPy (format versions 1 and 2): rows of equal length, row after row.
struct NpyArray {
    std::size_t rows = 0, columns = 0;
    bool is_double = false;     ///< float64; else float32
    std::vector<double> values; ///< each exactly as in the file

    [[nodiscard]] std::span<const double> row(std::size_t number) const
    {
        return std::span(values).subspan(number * columns, columns);
    }
};

/// Reads a two-dimensional array of little-endian float32 or float64 in C order. columns: how many it must have. what:
/// they are, for messages, as in "origin, t_min, direction, t_max".
/// Throws Error{missing} if the file cannot be read, and Error{invalid_input} that names the file, what is wrong, and
/// the call of NumPy that puts it right, for everything else.
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& path, std::size_t columns, const std::string& what);

/// Writes rows of float32. Throws as write_whole() does.
void write_npy(const std::filesystem::path& path, std::size_t columns, std::span<const float> values);

/// A column of a .npy file of records, by whose name NumPy finds it: a word of ASCII letters.
struct NpyColumn {
    std::string name;
    std::variant<std::vector<std::int32_t>, std::vector<std::int64_t>, std::vector<std::uint32_t>,
                 std::vector<std::uint64_t>, std::vector<float>, std::vector<double>>
        values;
};

/// Writes a one-dimensional array of records: numpy.load(path)["name"] is a column. All columns are equally long.
/// Throws as write_whole() does.
void write_npy(const std::filesystem::path& path, std::span<const NpyColumn> columns);

} // namespace tetrace
