#include "bench/picture_name.h"

#include "core/error.h"

#include <fmt/format.h>

namespace tetrace {

std::filesystem::path picture_path(const std::optional<std::filesystem::path>& out, const PictureKey& key,
                                   bool only_picture)
{
    const std::string name = fmt::format("{}-{}-{}", key.scene, key.view, name_of(key.picture));
    if (!out) return name + ".png";
    if (std::filesystem::is_directory(*out)) return *out / (name + ".png");
    if (only_picture) return *out;
    return out->parent_path() / fmt::format("{}-{}{}", out->stem().string(), name, out->extension().string());
}

void check_picture_ending(const std::optional<std::filesystem::path>& out)
{
    if (!out || std::filesystem::is_directory(*out)) return;
    const std::string ending = out->extension().string();
    if (ending != ".png" && ending != ".exr")
        throw Error(ErrorKind::usage, fmt::format("--out '{}': accepted are a file that ends in .png or .exr, or a "
                                                  "folder that is there",
                                                  out->string()));
}

} // namespace tetrace
