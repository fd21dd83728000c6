#include "bench/rows/sized_scene.h"

#include "core/base/error.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr const char* size_part = "/size:"; // names of scenes have no slash

std::string text_of(ImageSize size)
{
    return size.width == size.height ? std::to_string(size.width) : fmt::format("{}x{}", size.width, size.height);
}

/// Two files with the same stem would give two rows the same name.
void check_labels(const std::vector<SceneRequest>& requests)
{
    for (std::size_t i = 0; i < requests.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (scene_label(requests[i].name) == scene_label(requests[j].name))
                throw Error(ErrorKind::usage,
                            fmt::format("--scene: '{}' and '{}' would both be called '{}' in the results; name each "
                                        "scene once, and rename one of the files",
                                        requests[j].name, requests[i].name, scene_label(requests[i].name)));
}

} // namespace

std::vector<SizedScene> sized_scenes(const std::string& scene, const Options& options)
{
    if (options.sizes.empty()) return {{scene, {options.width, options.height}}};
    std::vector<SizedScene> scenes;
    for (const ImageSize size : options.sizes)
        scenes.push_back({scene + size_part + text_of(size), size});
    return scenes;
}

std::vector<std::string> scene_labels(const Options& options)
{
    const auto requests = scene_requests(options);
    check_labels(requests);
    std::vector<std::string> labels;
    for (const SceneRequest& request : requests)
        for (SizedScene& scene : sized_scenes(scene_label(request.name), options))
            labels.push_back(std::move(scene.label));
    return labels;
}

Options at_size(Options options, ImageSize size)
{
    options.width = size.width;
    options.height = size.height;
    options.sizes.clear();
    return options;
}

std::string size_in(const std::string& label)
{
    const std::size_t at = label.find(size_part);
    return at == std::string::npos ? std::string() : label.substr(at);
}

} // namespace tetrace
