#pragma once

#include "scenes/builder/xml_tags.h"

#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// What a .vtu file says of all its arrays.
struct VtuEncoding {
    bool is_big_endian = false, is_compressed = false; ///< by zlib
    std::size_t header_bytes = 4;                      ///< of each number in front of an array's bytes
    bool is_appended_raw = false;                      ///< else base64
    std::string_view appended;                         ///< after the underscore
};

/// A DataArray of a .vtu file.
struct VtuArray {
    std::string name, type, format; ///< the last: ascii, binary or appended
    std::size_t components = 1, offset = 0;
    std::string_view text;
    std::string place; ///< for messages
};

/// The numbers of an array. Throws what MeshSource::fail() does, naming the array, for types, sizes and bytes that are
/// wrong.
[[nodiscard]] std::vector<double> values_of(const MeshSource& source, const VtuArray& array,
                                            const VtuEncoding& encoding);

} // namespace tetrace
