#include "bench/results/npy.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A .npy file with this header.
std::string npy_bytes(const std::string& header, const std::string& data, int version = 1)
{
    std::string bytes = "\x93NUMPY";
    bytes += {static_cast<char>(version), '\0', static_cast<char>(header.size()), '\0'};
    if (version == 2) bytes += {'\0', '\0'};
    return bytes + header + data;
}

std::string header_of(const std::string& type, const std::string& shape, const std::string& order = "False")
{
    return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

template <class Number>
std::string data_of(const std::vector<Number>& numbers)
{
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

} // namespace

TEST(Npy, returns_what_was_written)
{
    const TemporaryFolder folder;
    const std::vector<float> numbers = {1, -2.5f, 0x1p-149f, HUGE_VALF, 0, 7, 8, 9};
    write_npy(folder / "a.npy", 4, numbers);
    const NpyArray array = read_npy(folder / "a.npy", 4, "numbers");
    EXPECT_EQ(array.rows, 2u);
    EXPECT_FALSE(array.is_double);
    EXPECT_EQ(array.values, std::vector<double>(numbers.begin(), numbers.end()));
    EXPECT_EQ(array.row(1)[1], 7);
    const std::string bytes = read_text(folder / "a.npy");
    EXPECT_EQ((bytes.size() - sizeof(float) * numbers.size()) % 64, 0u) << "NumPy aligns the data";
}

TEST(Npy, writes_records_of_every_type_as_numpy_has_them)
{
    const TemporaryFolder folder;
    const std::vector<NpyColumn> columns = {
        {"a", std::vector<std::uint32_t>{1, 0xFFFFFFFFu}}, {"b", std::vector<std::int64_t>{-2, 3}},
        {"c", std::vector<double>{0.5, -1e300}},           {"d", std::vector<float>{4, 5}},
        {"e", std::vector<std::uint64_t>{6, ~0ull}},       {"f", std::vector<std::int32_t>{-7, 8}}};
    write_npy(folder / "a.npy", columns);
    const std::string bytes = read_text(folder / "a.npy");
    EXPECT_NE(bytes.find("'descr': [('a', '<u4'), ('b', '<i8'), ('c', '<f8'), ('d', '<f4'), ('e', '<u8'), ('f', "
                         "'<i4'), ], 'fortran_order': False, 'shape': (2,), }"),
              std::string::npos)
        << bytes;
    const std::string records = data_of<std::uint32_t>({1}) + data_of<std::int64_t>({-2}) + data_of<double>({0.5}) +
                                data_of<float>({4}) + data_of<std::uint64_t>({6}) + data_of<std::int32_t>({-7}) +
                                data_of<std::uint32_t>({0xFFFFFFFFu}) + data_of<std::int64_t>({3}) +
                                data_of<double>({-1e300}) + data_of<float>({5}) + data_of<std::uint64_t>({~0ull}) +
                                data_of<std::int32_t>({8});
    EXPECT_TRUE(bytes.ends_with(records));
    EXPECT_EQ((bytes.size() - records.size()) % 64, 0u);
}

TEST(Npy, reads_float64_and_version_2)
{
    const TemporaryFolder folder;
    write_file(folder / "a.npy", npy_bytes(header_of("<f8", "(1, 2)"), data_of<double>({1.0 / 3, -1e300}), 2));
    const NpyArray array = read_npy(folder / "a.npy", 2, "numbers");
    EXPECT_TRUE(array.is_double);
    EXPECT_EQ(array.values, (std::vector<double>{1.0 / 3, -1e300}));
}

TEST(Npy, refuses_other_files_with_a_remedy)
{
    const TemporaryFolder folder;
    const std::string eight(8, '\0');
    const struct {
        std::string bytes, says;
    } cases[] = {
        {"", "not a .npy file"},
        {"face,t,u,v\n1,2,3,4\n", "not a .npy file"},
        {npy_bytes(header_of("<f4", "(1, 2)"), eight, 3), "format version is 3"},
        {npy_bytes(header_of("<f4", "(1, 2)"), "").substr(0, 20), "inside its header"},
        {npy_bytes(header_of(">f4", "(1, 2)"), eight), "astype('<f4')"},
        {npy_bytes(header_of("<i8", "(1, 2)"), eight), "'<i8'"},
        {npy_bytes("{'descr': [('t', '<f4')], 'fortran_order': False, 'shape': (1, 2), }\n", eight), "[('t'"},
        {npy_bytes(header_of("<f4", "(1, 2)", "True"), eight), "numpy.ascontiguousarray"},
        {npy_bytes("{'descr': '<f4', 'fortran_order': False}\n", eight), "lacks 'shape'"},
        {npy_bytes(header_of("<f4", "(2,)"), eight), "N x 2"},
        {npy_bytes(header_of("<f4", "(1, 2, 1)"), eight), "N x 2"},
        {npy_bytes(header_of("<f4", "(2, 1)"), eight), "N x 2"},
        {npy_bytes(header_of("<f4", "(-1, 2)"), eight), "N x 2"},
        {npy_bytes(header_of("<f4", "(2, 2)"), eight), "2 rows of 8 bytes, and 8 bytes"},
        {npy_bytes(header_of("<f4", "(1, 2)"), eight + "x"), "9 bytes follow"},
        {npy_bytes(header_of("<f4", "(2305843009213693953, 2)"), eight), "8 bytes follow"},
    };
    for (const auto& [bytes, says] : cases) {
        write_file(folder / "bad.npy", bytes);
        try {
            static_cast<void>(read_npy(folder / "bad.npy", 2, "numbers"));
            ADD_FAILURE() << "accepted: " << says;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << says;
            EXPECT_NE(std::string(error.what()).find("bad.npy"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what() << "\nlacks " << says;
        }
    }
    EXPECT_THROW(static_cast<void>(read_npy(folder / "none.npy", 2, "numbers")), Error);
}
