#include "bench/pictures/picture_name.h"

#include "core/base/error.h"

#include <fmt/format.h>

namespace tetrace {

std::filesystem::path picture_path(const std::optional<std::filesystem::path>& out, const PictureKey& key,
                                   const std::string& ending, bool only_picture)
{
    const std::string name = fmt::format("{}-{}-{}", key.scene, key.view, name_of(key.picture));
    if (!out) return name + ending;
    if (std::filesystem::is_directory(*out)) return *out / (name + ending);
    if (only_picture) return *out;
    return out->parent_path() / fmt::format("{}-{}{}", out->stem().string(), name, ending);
}

std::string picture_ending(const std::optional<std::filesystem::path>& out, bool can_write_png)
{
    if (out && !std::filesystem::is_directory(*out)) return out->extension().string();
    return can_write_png ? ".png" : ".ppm";
}

void check_picture_ending(const std::optional<std::filesystem::path>& out)
{
    if (!out || std::filesystem::is_directory(*out)) return;
    const std::string ending = out->extension().string();
    if (ending != ".png" && ending != ".exr" && ending != ".ppm")
        throw Error(ErrorKind::usage, fmt::format("--out '{}': accepted are a file that ends in .png, .exr or .ppm, or "
                                                  "a folder that is there",
                                                  out->string()));
}

} // namespace tetrace
