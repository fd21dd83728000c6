#include "bench/rows/scene_arguments.h"

#include "bench/terminal/text.h"

#include <fmt/format.h>

namespace tetrace {

std::string scene_arguments(const SceneRequest& request, const Options& options)
{
    std::string text = "--scene " + shell_word(request.name);
    const auto add = [&](const char* option, const std::string& value, bool is_default) {
        if (!is_default) text += fmt::format(" {} {}", option, shell_word(value));
    };
    if (options.repair) text += " --repair";
    const Options usual;
    add("--domain", std::string(name_of(options.domains.front())), options.domains == usual.domains);
    add("--tets", std::string(name_of(options.tets.front())), options.tets == usual.tets);
    add("--effort", fmt::format("{}", options.effort), options.effort == usual.effort);
    for (const std::uint32_t divisions : options.divisions)
        add("--divisions", fmt::format("{}", divisions), false);
    for (const std::string& switches : options.switches)
        add("--switches", switches, false);
    add("--resolution", fmt::format("{}", options.resolution), options.resolution == usual.resolution);
    add("--optimise-time", fmt::format("{}", options.optimise_s), options.optimise_s == usual.optimise_s);
    add("--camera-set", options.own_cameras ? options.own_cameras->file : camera_set_name(options),
        !options.own_cameras && options.camera_set == usual.camera_set);
    add("--size", fmt::format("{}x{}", options.width, options.height), false);
    add("--tile", fmt::format("8x{}", options.tile_height), options.tile_height == 0);
    add("--packet-lanes", fmt::format("{}", options.packet_lanes), options.packet_lanes == 0);
    add("--buffer-limit", fmt::format("{}", options.buffer_limit), options.buffer_limit == 0);
    return text;
}

} // namespace tetrace
