#include "bench/options/apply_option.h"

#include "bench/options/browser_api.h"
#include "scenes/catalogue.h"
#include "scenes/pinned.h"

namespace tetrace {

namespace {

std::vector<std::string> backend_names()
{
    std::vector<std::string> names;
    for (const Backend* backend : all_backends())
        names.push_back(backend->name());
    return names;
}

} // namespace

ApplyOption append_backend(const std::string& option, std::vector<std::string> Options::*list)
{
    const auto names = backend_names();
    return {[=](Options& options, const std::string& text) {
                const bool is_page = options.verb == Verb::dump && text == browser_api;
                if (!is_page && std::ranges::find(names, text) == names.end()) reject_name(option, text, names);
                (options.*list).push_back(text);
            },
            names};
}

ApplyOption set(bool Options::*flag)
{
    return [=](Options& options, const std::string&) { options.*flag = true; };
}

ApplyOption set_count(const std::string& option, unsigned Options::*count, unsigned low, unsigned high)
{
    return [=](Options& options, const std::string& text) {
        options.*count = static_cast<unsigned>(parse_count(option, text, low, high));
    };
}

ApplyOption append_count(const std::string& option, std::vector<unsigned> Options::*list, unsigned low, unsigned high)
{
    return [=](Options& options, const std::string& text) {
        (options.*list).push_back(static_cast<unsigned>(parse_count(option, text, low, high)));
    };
}

ApplyOption set_seconds(const std::string& option, double Options::*seconds)
{
    return [=](Options& options, const std::string& text) { options.*seconds = parse_seconds(option, text); };
}

ApplyOption set_bytes(const std::string& option, std::uint64_t Options::*bytes)
{
    return [=](Options& options, const std::string& text) { options.*bytes = parse_bytes(option, text); };
}

ApplyOption append_text(std::vector<std::string> Options::*list)
{
    return [=](Options& options, const std::string& text) { (options.*list).push_back(text); };
}

namespace {

std::filesystem::path named_file(const std::string& option, const std::string& text)
{
    if (text.empty()) throw Error(ErrorKind::usage, option + ": the file name is empty");
    return text;
}

} // namespace

ApplyOption set_path(const std::string& option, std::optional<std::filesystem::path> Options::*path)
{
    return {[=](Options& options, const std::string& text) { options.*path = named_file(option, text); }, {}, true};
}

ApplyOption append_path(const std::string& option, std::vector<std::filesystem::path> Options::*list)
{
    return {[=](Options& options, const std::string& text) { (options.*list).push_back(named_file(option, text)); },
            {},
            true};
}

ApplyOption append_scenes()
{
    std::vector<std::string> names = {"all"};
    for (const CatalogueEntry& scene : catalogue())
        names.push_back(scene.name);
    for (const PinnedScene& scene : pinned_scenes())
        names.emplace_back(scene.name);
    return {[](Options& options, const std::string& text) {
                const std::vector<std::string> named = text == "all" ? all_scenes() : std::vector{text};
                options.scenes.insert(options.scenes.end(), named.begin(), named.end());
            },
            names, true};
}

ApplyOption set_cameras()
{
    return {[](Options& options, const std::string& text) {
                if (text.ends_with(".json")) {
                    options.own_cameras = read_cameras(text);
                    return;
                }
                const auto set = value_named<CameraSet>(text);
                if (!set) reject_name("--camera-set", text, all_names<CameraSet>(), ", or a file that ends in .json");
                options.camera_set = *set;
            },
            all_names<CameraSet>(), true};
}

ApplyOption set_out()
{
    return {[](Options& options, const std::string& text) {
                options.out = named_file("--out", text);
                const bool is_result = options.verb != Verb::render && options.verb != Verb::report &&
                                       options.verb != Verb::page && options.verb != Verb::dump;
                if (is_result && text == "-") options.out.reset();
            },
            {},
            true};
}

} // namespace tetrace
