#include "scenes/gltf_buffers.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

// Source of the format: Khronos Group, "glTF 2.0 Specification", 2.8; RFC 3986, 2.1.

namespace tetrace {

namespace fs = std::filesystem;

namespace {

std::string without_percents(std::string_view uri)
{
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned char byte = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            name += static_cast<char>(byte);
            i += 2;
        } else {
            name += uri[i];
        }
    }
    return name;
}

} // namespace

fs::path gltf_buffer_file(const fs::path& folder, std::string_view uri)
{
    const std::string name = without_percents(uri);
    const bool is_plain =
        !name.empty() && name != "." && name != ".." && name.find_first_of(std::string_view("/\0", 2)) == name.npos;
    return is_plain ? folder / name : fs::path();
}

void add_gltf_buffers(Hasher& hasher, const fs::path& gltf, std::string_view json)
{
    // Only the buffers' names are kept of it: the rest may be large.
    const auto is_wanted = [](int depth, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
        if (event == nlohmann::json::parse_event_t::key && depth == 1) return parsed == "buffers";
        return depth < 8;
    };
    const nlohmann::json root = nlohmann::json::parse(json, is_wanted, false);
    const auto buffers = root.find("buffers");
    if (buffers == root.end()) return;
    for (const nlohmann::json& buffer : *buffers) {
        const auto uri = buffer.find("uri");
        if (uri == buffer.end() || !uri->is_string() || uri->get_ref<const std::string&>().starts_with("data:"))
            continue;
        const fs::path file =
            gltf_buffer_file(gltf.has_parent_path() ? gltf.parent_path() : ".", uri->get_ref<const std::string&>());
        if (!file.empty()) add_file(hasher, file);
    }
}

std::uint64_t add_file(Hasher& hasher, const fs::path& path)
{
    std::error_code not_there; // opening a folder works, and a pipe would wait for its writer
    std::ifstream file;
    if (fs::is_regular_file(path, not_there)) file.open(path, std::ios::binary);
    std::uint64_t read = 0;
    std::vector<char> piece(std::size_t{1} << 20);
    while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
        const auto size = static_cast<std::size_t>(file.gcount());
        hasher.add(std::as_bytes(std::span(piece).first(size)));
        read += size;
    }
    return file.bad() ? 0 : read;
}

} // namespace tetrace
