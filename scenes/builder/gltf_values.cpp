#include "scenes/builder/gltf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tetrace {
namespace {

enum Component : std::uint64_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

std::size_t size_of(std::uint64_t type)
{
    switch (type) {
    case int8:
    case uint8: return 1;
    case int16:
    case uint16: return 2;
    case uint32:
    case float32: return 4;
    default: return 0;
    }
}

template <class Value>
Value read(const char* from)
{
    Value value; // little endian, as all that this program runs on
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class Value>
double scaled(const char* from, bool is_normalized)
{
    const double value = read<Value>(from);
    return is_normalized ? std::max(value / std::numeric_limits<Value>::max(), -1.0) : value;
}

} // namespace

double GltfValues::Elements::at(std::size_t element, std::size_t component) const
{
    if (data == nullptr) return 0;
    const char* const from = data + element * stride + component * size;
    switch (type) {
    case int8: return scaled<std::int8_t>(from, is_normalized);
    case uint8: return scaled<std::uint8_t>(from, is_normalized);
    case int16: return scaled<std::int16_t>(from, is_normalized);
    case uint16: return scaled<std::uint16_t>(from, is_normalized);
    case uint32: return read<std::uint32_t>(from);
    default: return static_cast<double>(read<float>(from));
    }
}

GltfValues::GltfValues(GltfFile& file, std::uint64_t accessor, std::size_t components, std::string place)
{
    const nlohmann::json& object = file.element("accessors", accessor, place, "accessor");
    if (member(object, "type") != (components == 1 ? "SCALAR" : "VEC3"))
        file.source().fail(place, fmt::format("accessor {} is of another type", accessor));
    const std::uint64_t count = file.integer(object, "count", {}, place);
    const std::uint64_t type = file.integer(object, "componentType", {}, place);
    const nlohmann::json& sparse = member(object, "sparse");
    count_ = static_cast<std::size_t>(count);
    if (!member(object, "bufferView").is_null())
        all_ = elements(file, object, type, count_, components, place);
    else if (sparse.is_null())
        file.source().fail(place,
                           fmt::format("accessor {} has no data; the file uses these extensions: {}", accessor,
                                       file.list("extensionsUsed").dump()),
                           "export it again as .glb, without compression");
    else if (count > file.bytes()) // nothing else bounds zeros
        file.source().fail(place, fmt::format("{} elements are more than the file holds", count));
    all_.type = type;
    if (!sparse.is_null()) read_sparse(file, sparse, components, place);
}

GltfValues::Elements GltfValues::elements(GltfFile& file, const nlohmann::json& object, std::uint64_t type,
                                          std::size_t count, std::size_t components, const std::string& place) const
{
    Elements result{nullptr, type, size_of(type), 0, member(object, "normalized") == true};
    if (result.size == 0) file.source().fail(place, fmt::format("component type {} is none of glTF", type));
    const std::uint64_t view = file.integer(object, "bufferView", {}, place);
    const std::string_view bytes = file.view(view, file.integer(object, "byteOffset", 0, place), place);
    const std::size_t element = result.size * components;
    const std::uint64_t stride =
        file.integer(file.element("bufferViews", view, place, "buffer view"), "byteStride", element, place);
    result.stride = static_cast<std::size_t>(stride);
    if (count > 0 && (element > bytes.size() || stride == 0 || count - 1 > (bytes.size() - element) / result.stride))
        file.source().fail(place, fmt::format("{} elements are more than its buffer holds", count));
    result.data = bytes.data();
    return result;
}

void GltfValues::read_sparse(GltfFile& file, const nlohmann::json& sparse, std::size_t components,
                             const std::string& place)
{
    const auto count = static_cast<std::size_t>(file.integer(sparse, "count", {}, place));
    const nlohmann::json& numbers = member(sparse, "indices");
    const Elements indices =
        elements(file, numbers, file.integer(numbers, "componentType", {}, place), count, 1, place);
    replacements_ = elements(file, member(sparse, "values"), all_.type, count, components, place);
    replacements_.is_normalized = all_.is_normalized;
    for (std::size_t i = 0; i < count; ++i) {
        const double index = indices.at(i, 0);
        const bool rises = replaced_.empty() || index > static_cast<double>(replaced_.back());
        if (!(index >= 0 && index < static_cast<double>(count_)) || index != std::floor(index) || !rises)
            file.source().fail(
                place,
                fmt::format("entry {} of its sparse indices, {}, does not rise, or is not below {}", i, index, count_));
        replaced_.push_back(static_cast<std::size_t>(index));
    }
}

bool GltfValues::has_whole_numbers() const
{
    return all_.type != float32 && !all_.is_normalized;
}

double GltfValues::at(std::size_t element, std::size_t component) const
{
    const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), element);
    if (found != replaced_.end() && *found == element)
        return replacements_.at(static_cast<std::size_t>(found - replaced_.begin()), component);
    return all_.at(element, component);
}

} // namespace tetrace
