#include "scenes/builder/gltf_file.h"

#include "core/base/files.h"
#include "scenes/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

// Source of the format: Khronos Group, "glTF 2.0 Specification".

namespace tetrace {
namespace {

constexpr int max_depth = 256;
constexpr const char* export_plainly = "export it again as .glb, without compression";

// Required extensions that leave the triangles where they are, or are read; with '_' at the end, all that begin so. A
// node that uses EXT_mesh_gpu_instancing is refused when it is met.
constexpr std::array<std::string_view, 26> harmless = {"KHR_materials_",
                                                       "KHR_texture_",
                                                       "KHR_lights_",
                                                       "KHR_animation_",
                                                       "KHR_audio_",
                                                       "KHR_xmp",
                                                       "KHR_xmp_json_ld",
                                                       "KHR_techniques_webgl",
                                                       "KHR_mesh_quantization",
                                                       "KHR_draco_mesh_compression",
                                                       "KHR_node_visibility",
                                                       "KHR_node_selectability",
                                                       "KHR_node_hoverability",
                                                       "EXT_texture_",
                                                       "EXT_lights_",
                                                       "EXT_mesh_features",
                                                       "EXT_instance_features",
                                                       "EXT_structural_metadata",
                                                       "EXT_mesh_gpu_instancing",
                                                       "ADOBE_materials_",
                                                       "CESIUM_primitive_outline",
                                                       "MSFT_texture_",
                                                       "MSFT_packing_",
                                                       "MSFT_lod",
                                                       "VRM",
                                                       "VRMC_"};

bool is_harmless(std::string_view name)
{
    return std::any_of(harmless.begin(), harmless.end(), [&](std::string_view known) {
        return known.ends_with('_') ? name.starts_with(known) : name == known;
    });
}

// Nothing if it is not base64; blanks are no part of it.
std::optional<std::string> decode_base64(std::string_view text)
{
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::int8_t, 256> value{};
    value.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i)
        value[static_cast<unsigned char>(digits[i])] = static_cast<std::int8_t>(i);
    while (text.ends_with('='))
        text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = value[static_cast<unsigned char>(c)];
        if (digit < 0) return std::nullopt;
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    return bytes;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at)
{
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;)
        word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
    return word;
}

const nlohmann::json nothing;

} // namespace

const nlohmann::json& member(const nlohmann::json& object, const char* key)
{
    const auto found = object.find(key);
    return found == object.end() ? nothing : *found;
}

const nlohmann::json& extension(const nlohmann::json& object, const char* name)
{
    return member(member(object, "extensions"), name);
}

GltfFile::GltfFile(const MeshSource& source) : source_(source), bytes_(source.bytes().size())
{
    const std::string_view text = source.bytes().starts_with("glTF") ? split_binary() : source.bytes();
    bool is_deep = false;
    root_ = Json::parse(
        text,
        [&](int depth, Json::parse_event_t, Json&) {
            is_deep = is_deep || depth > max_depth;
            return depth <= max_depth;
        },
        false);
    if (is_deep) source.fail("header", fmt::format("its JSON is more than {} levels deep", max_depth));
    if (!root_.is_object()) source.fail("header", "it is not JSON");
    require_readable();
    buffers_.resize(list("buffers").size());
}

// The JSON of a .glb; its binary chunk is kept, and others are skipped.
std::string_view GltfFile::split_binary()
{
    constexpr std::uint32_t json = 0x4E4F534A, binary = 0x004E4942;
    const std::string_view bytes = source_.bytes();
    if (bytes.size() < 20) source_.fail("header", "the file ends inside it");
    if (const std::uint32_t version = little_endian(bytes, 4); version != 2)
        source_.fail("header", fmt::format("it is glTF {}.0, which is not read", version),
                     "convert it to glTF 2.0, for example with Blender");
    const std::size_t length = little_endian(bytes, 8);
    if (length > bytes.size())
        source_.fail("header", fmt::format("it announces {} bytes, but the file has {}", length, bytes.size()));
    std::string_view text;
    for (std::size_t at = 12; at + 8 <= length;) {
        const std::size_t size = little_endian(bytes, at);
        const std::uint32_t type = little_endian(bytes, at + 4);
        if (size > length - at - 8) source_.fail("header", "a chunk is longer than the file");
        const std::string_view content = bytes.substr(at + 8, size);
        if (at == 12 && type == json) text = content;
        if (at > 12 && type == binary && chunk_.empty()) chunk_ = content;
        at += 8 + size;
    }
    if (text.empty()) source_.fail("header", "its first chunk is not JSON");
    return text;
}

void GltfFile::require_readable() const
{
    const Json& version = member(member(root_, "asset"), "version");
    if (!version.is_string()) source_.fail("header", "it lacks asset.version, which every glTF file has");
    const std::string& text = version.get_ref<const std::string&>();
    if (!text.starts_with("2."))
        source_.fail("header", fmt::format("it is glTF {:.20}, which is not read", text),
                     "convert it to glTF 2.0, for example with Blender");
    if (const Json& least = member(member(root_, "asset"), "minVersion"); !least.is_null()) {
        const std::string number = least.is_string() ? least.get_ref<const std::string&>() : least.dump();
        if (!(parse_number(number).value_or(3) <= 2)) // not a number: of a later version
            source_.fail("header", fmt::format("it requires glTF {:.20} (asset.minVersion), which is not read", number),
                         "export it as glTF 2.0, for example with Blender");
    }
    for (const Json& name : list("extensionsRequired"))
        if (!name.is_string() || !is_harmless(name.get_ref<const std::string&>()))
            source_.fail("header",
                         fmt::format("it requires the extension {:.60}, which is not read",
                                     name.is_string() ? name.get_ref<const std::string&>() : name.dump()),
                         export_plainly);
}

const GltfFile::Json& GltfFile::list(const char* key) const
{
    static const Json none = Json::array();
    const Json& found = member(root_, key);
    if (found.is_null()) return none;
    if (!found.is_array()) source_.fail("header", fmt::format("'{}' is not a list", key));
    return found;
}

const GltfFile::Json& GltfFile::element(const char* key, std::uint64_t index, const std::string& place,
                                        const char* what) const
{
    const Json& all = list(key);
    if (index >= all.size()) source_.fail(place, fmt::format("it names {} {} of {}", what, index, all.size()));
    return all[static_cast<std::size_t>(index)];
}

std::uint64_t GltfFile::integer(const Json& object, const char* key, std::optional<std::uint64_t> otherwise,
                                const std::string& place) const
{
    const Json& found = member(object, key);
    if (found.is_null() && otherwise) return *otherwise;
    if (found.is_number_unsigned()) return found.get<std::uint64_t>();
    const double value = found.is_number() ? found.get<double>() : -1;
    if (!(value >= 0 && value < 0x1p53 && value == std::floor(value)))
        source_.fail(place, fmt::format("'{}' is missing, or not a whole number", key));
    return static_cast<std::uint64_t>(value);
}

std::vector<double> GltfFile::numbers(const Json& object, const char* key, std::size_t size,
                                      const std::string& place) const
{
    const Json& found = member(object, key);
    if (found.is_null()) return {};
    std::vector<double> values;
    for (const Json& value : found)
        if (value.is_number()) values.push_back(value.get<double>());
    if (!found.is_array() || values.size() != size || found.size() != size)
        source_.fail(place, fmt::format("its {} is not a list of {} numbers", key, size));
    return values;
}

std::string_view GltfFile::view(std::uint64_t index, std::uint64_t offset, const std::string& place)
{
    const Json& view = element("bufferViews", index, place, "buffer view");
    const std::string_view bytes = buffer(integer(view, "buffer", {}, place), place);
    const std::uint64_t begin = integer(view, "byteOffset", 0, place), size = integer(view, "byteLength", {}, place);
    if (begin > bytes.size() || size > bytes.size() - begin || offset > size)
        source_.fail(place, "its buffer view is longer than its buffer");
    return bytes.substr(static_cast<std::size_t>(begin + offset), static_cast<std::size_t>(size - offset));
}

std::string_view GltfFile::buffer(std::uint64_t index, const std::string& place)
{
    const Json& object = element("buffers", index, place, "buffer");
    const Json& uri = member(object, "uri");
    const std::uint64_t size = integer(object, "byteLength", {}, place);
    std::optional<std::string>& read = buffers_[static_cast<std::size_t>(index)];
    if (!read && uri.is_string()) {
        const std::string& text = uri.get_ref<const std::string&>();
        const auto data = text.find(";base64,");
        if (text.starts_with("data:") && data != std::string::npos)
            read = decode_base64(std::string_view(text).substr(data + 8));
        else if (!text.starts_with("data:"))
            read = read_file(text, place);
        if (!read) source_.fail(place, fmt::format("the data of buffer {} are not base64", index));
        bytes_ += read->size();
    }
    if (!read && (index > 0 || chunk_.empty()))
        source_.fail(place,
                     fmt::format("buffer {} has no data{}", index,
                                 member(object, "extensions").is_null() ? "" : " without its extensions"),
                     export_plainly);
    const std::string_view bytes = read ? std::string_view(*read) : chunk_;
    if (bytes.size() < size)
        source_.fail(place, fmt::format("buffer {} has {} bytes, not {}", index, bytes.size(), size));
    return bytes.substr(0, static_cast<std::size_t>(size));
}

std::string GltfFile::read_file(const std::string& uri, const std::string& place) const
{
    const std::filesystem::path file = gltf_buffer_file(source_.folder(), uri);
    if (source_.folder().empty() || file.empty())
        source_.fail(place, fmt::format("its buffer '{:.80}' is not a file of the same folder", uri),
                     "export it as .glb, which holds all in one file");
    std::error_code ignored; // what cannot be looked at is not there for us
    std::optional<std::string> bytes;
    if (std::filesystem::is_regular_file(file, ignored)) bytes = file_bytes(file);
    if (!bytes)
        source_.fail(place, fmt::format("its buffer '{:.80}' cannot be read", file.string()),
                     "copy it into the folder of the .gltf file, or export the mesh as .glb, which holds all in one");
    return std::move(*bytes);
}

} // namespace tetrace
