#include "bench/options/camera_file.h"

#include "bench/options/option_values.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/printable.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <optional>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr std::size_t max_file = std::size_t{16} << 20, max_views = 100'000, longest_name = 100;

/// A file, and the entry of it that is being read.
class CameraReader {
public:
    explicit CameraReader(const std::filesystem::path& path) : path_(path) {}

    [[nodiscard]] OwnCameras read() const
    {
        const json whole = parsed();
        check_keys(whole, "the file", {"name", "views"});
        OwnCameras set{name_of_set(whole), {}};
        const auto views = whole.find("views");
        if (views == whole.end() || !views->is_array() || views->empty())
            reject("views: is not a list of at least one view");
        if (views->size() > max_views) reject("views: has more than 100,000 views");
        for (std::size_t i = 0; i < views->size(); ++i)
            set.views.push_back(aim_of(views->at(i), fmt::format("views[{}]", i)));
        return set;
    }

private:
    [[noreturn]] void reject(const std::string& what, ErrorKind kind = ErrorKind::invalid_input) const
    {
        throw Error(kind, fmt::format("--camera-set: reading '{}': {}", path_.string(), what));
    }

    [[nodiscard]] json parsed() const
    {
        std::error_code ignored;
        if (!std::filesystem::exists(path_, ignored)) reject("the file does not exist", ErrorKind::missing);
        if (!std::filesystem::is_regular_file(path_, ignored)) reject("it is not a file");
        const std::optional<std::string> bytes = file_bytes(path_, max_file + 1);
        if (!bytes) reject(fmt::format("{}; check its permissions and its disk", std::strerror(errno)));
        if (bytes->size() > max_file) reject("it is larger than 16 MiB");
        try {
            return json::parse(*bytes);
        } catch (const json::exception& problem) {
            reject(fmt::format("it is not JSON: {}", printable_line(problem.what())));
        }
    }

    void check_keys(const json& object, const std::string& what, const std::vector<std::string>& accepted) const
    {
        if (!object.is_object()) reject(what + ": is not an object");
        for (const auto& [key, value] : object.items())
            if (std::ranges::find(accepted, key) == accepted.end())
                reject(fmt::format("{}: has a key '{}'; accepted: {}", what, printable_line(key),
                                   join_alternatives(accepted)));
    }

    [[nodiscard]] std::string name_of_set(const json& whole) const
    {
        const auto name = whole.find("name");
        const std::string text = name != whole.end() && name->is_string() ? name->get<std::string>() : std::string();
        if (text.empty() || text.size() > longest_name || printable_line(text) != text)
            reject("name: is not a line of 1 to 100 bytes");
        if (value_named<CameraSet>(text))
            reject(fmt::format("name: '{}' is a camera set of tetrace's; choose another", text));
        return text;
    }

    [[nodiscard]] Aim aim_of(const json& view, const std::string& what) const
    {
        check_keys(view, what, {"origin", "target", "up"});
        if (!view.contains("origin")) reject(what + ": 'origin' is missing");
        Aim aim;
        const std::array<std::pair<const char*, Double3*>, 3> members = {
            {{"origin", &aim.origin}, {"target", &aim.target}, {"up", &aim.up}}};
        for (const auto& [key, member] : members)
            if (const auto value = view.find(key); value != view.end())
                *member = vector_of(*value, fmt::format("{}.{}", what, key));
        if (const std::string why = why_no_camera(aim); !why.empty()) reject(what + "." + why);
        return aim;
    }

    [[nodiscard]] Double3 vector_of(const json& value, const std::string& what) const
    {
        const auto is_number = [](const json& one) { return one.is_number() && std::isfinite(one.get<double>()); };
        if (!value.is_array() || value.size() != 3 || !std::ranges::all_of(value, is_number))
            reject(what + ": is not a list of three numbers");
        return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
    }

    std::filesystem::path path_;
};

} // namespace

std::uint64_t OwnCameras::hash() const
{
    std::vector<double> numbers;
    for (const Aim& aim : views)
        for (const Double3& v : {aim.origin, aim.target, aim.up})
            for (const double number : {v.x, v.y, v.z})
                numbers.push_back(number + 0.0); // -0 is 0
    return hash_of(numbers);
}

std::vector<Camera> OwnCameras::cameras(const BoundingSphere& sphere) const
{
    std::vector<Camera> made;
    for (const Aim& aim : views)
        made.push_back(aimed_camera(aim, sphere));
    return made;
}

OwnCameras read_cameras(const std::filesystem::path& path)
{
    OwnCameras cameras = CameraReader(path).read();
    cameras.file = path.string();
    return cameras;
}

} // namespace tetrace
