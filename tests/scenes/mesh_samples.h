// Mesh files of every format, as texts, and how a bad one is refused.
#pragma once

#include "scenes/builder/mesh_reader.h"
#include "tests/support/temporary_folder.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace tetrace::test {

inline const std::string tetrahedron_off =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

/// One value as the bytes of either order.
template <class Value>
std::string bytes_of(Value value, bool little)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return little == (std::endian::native == std::endian::little) ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

/// A triangle pair as Stanford writes it: extra vertex properties, lists of int after a byte.
inline std::string stanford_ply(const std::string& format, const std::string& vertices = "4",
                                const std::string& faces = "2", int last_index = 3, float last_x = 0.25f)
{
    std::string text =
        "ply\nformat " + format + " 1.0\ncomment zipper output\nobj_info num_cols 512\nelement vertex " + vertices +
        "\nproperty float x\nproperty float y\nproperty float z\nproperty float confidence\nproperty float "
        "intensity\nelement face " +
        faces + "\nproperty list uchar int vertex_indices\nend_header\n";
    const float x[4][5] = {{0, 0, 0, 1, 0.5f}, {1, 0, 0, 1, 0.5f}, {0, 1, 0, 1, 0.5f}, {last_x, 0.125f, 1, 1, 0.5f}};
    const int index[2][3] = {{0, 1, 2}, {0, 1, last_index}};
    const bool ascii = format == "ascii";
    const bool little = format == "binary_little_endian";
    std::ostringstream body;
    for (const auto& row : x) {
        for (const float value : row)
            ascii ? (body << value << ' ') : (body << bytes_of(value, little));
        if (ascii) body << '\n';
    }
    for (const auto& row : index) {
        ascii ? (body << "3 ") : (body << '\3');
        for (const int value : row)
            ascii ? (body << value << ' ') : (body << bytes_of(value, little));
        if (ascii) body << '\n';
    }
    return text + body.str();
}

inline std::string binary_stl(std::uint32_t announced = 2, float first = 0)
{
    std::string text(80, ' ');
    text.replace(0, 5, "solid"); // some programs begin binary files so
    text += bytes_of(announced, true);
    const float x[2][12] = {{0, 0, 1, first, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (const auto& facet : x) {
        for (const float value : facet)
            text += bytes_of(value, true);
        text += std::string(2, '\0');
    }
    return text;
}

inline const std::string ascii_stl =
    "solid a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
    "  endloop\n endfacet\n FACET NORMAL nan 0 0\n  OUTER LOOP\n   VERTEX 0 0 0\n   VERTEX 0 1 0\n   VERTEX "
    "0 0 1.5e0\n  ENDLOOP\n ENDFACET\nendsolid a name\n";

inline const std::vector<std::string> ply_formats = {"ascii", "binary_little_endian", "binary_big_endian"};

/// The error's text, which is about a bad mesh and names the file.
inline std::string refusal_of(const std::string& name, const std::string& bytes)
{
    std::string error = error_of([&] { (void)parse_mesh(name, bytes); });
    EXPECT_TRUE(error.starts_with("invalid_input: ")) << name << ": " << error;
    EXPECT_TRUE(contains(error, name));
    return error;
}

/// The same, which has these parts.
inline void expect_error(const std::string& name, const std::string& bytes, const std::vector<std::string>& parts)
{
    const std::string error = refusal_of(name, bytes);
    for (const std::string& part : parts)
        EXPECT_TRUE(contains(error, part));
}

} // namespace tetrace::test
