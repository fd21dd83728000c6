#include "bench/reproduce/tables/pictures.h"

#include "bench/pictures/false_colour.h"
#include "bench/pictures/images.h"
#include "bench/pictures/shading.h"
#include "bench/reproduce/tables/tables.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// A single pixel of a large picture cannot be seen.
constexpr std::uint32_t pixels_per_mark = 256;

void mark(Pixmap& picture, std::uint32_t x, std::uint32_t y, Colour colour)
{
    const std::uint32_t reach = std::max(picture.width, picture.height) / pixels_per_mark;
    for (std::uint32_t j = y - std::min(y, reach); j <= std::min(y + reach, picture.height - 1); ++j)
        for (std::uint32_t i = x - std::min(x, reach); i <= std::min(x + reach, picture.width - 1); ++i)
            picture.at(i, j) = colour;
}

} // namespace

Pixmap draw_flawed(std::span<const Hit> hits, std::span<const std::uint32_t> flawed, const SceneWork& scene,
                   std::size_t view)
{
    constexpr float darkened = 0.3f;
    Pixmap picture = shade_hits(hits, scene.views()[view], scene.width(), scene.height(), scene.loaded().scene.mesh);
    for (Colour& pixel : picture.pixels)
        pixel = pixel * darkened;
    for (const std::uint32_t pixel : flawed)
        mark(picture, pixel % scene.width(), pixel / scene.width(), from_srgb(0xFF5A1F));
    return picture;
}

ResultPictures::ResultPictures(std::filesystem::path result)
    : result_(std::move(result)), ending_(picture_ending({}, has_images_module())), writer_(ending_)
{
}

void ResultPictures::draw(SceneRun& run, bool flawed, bool extremes) const
{
    const auto attempt = [&](const auto& work) {
        try {
            work();
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) throw;
            run.picture_problems.push_back(
                fmt::format("A picture of {} is missing: {}.", run.build.label, error.what()));
        }
    };
    bool first = true;
    for (const MethodRow& method : method_rows({&run})) {
        if (run.rows[method.row].session == nullptr) continue;
        if (flawed) attempt([&] { draw_worst(run, method.row); });
        const auto [fewest, most] = extreme_views(run, method.row);
        for (const std::size_t view : {fewest, most})
            if (extremes && first) attempt([&] { draw_view(run, method.row, view); });
        first = false;
    }
}

void ResultPictures::draw_worst(SceneRun& run, std::size_t row) const
{
    const auto& images = run.images[row];
    const auto worst =
        std::ranges::max_element(images, [](const auto& a, const auto& b) { return flawed_rays(a) < flawed_rays(b); });
    if (worst == images.end() || flawed_rays(*worst) == 0) return;
    const auto view = static_cast<std::size_t>(worst - images.begin());
    const ImageVerdict verdict = run.verifier->verify(run.rows[row], view);
    run.flawed_pictures.push_back(write(run, view, fmt::format("{}-flawed", name_of(run.rows[row].key.kernel.method)),
                                        draw_flawed(run.verifier->hits(), verdict.verdicts.flawed, *run.scene, view)));
}

void ResultPictures::draw_view(SceneRun& run, std::size_t row, std::size_t view) const
{
    static_cast<void>(run.verifier->trace(run.rows[row], view));
    const auto hits = run.verifier->hits();
    const SceneWork& scene = *run.scene;
    const std::string title = fmt::format("{}, view {}", run.build.scene, scene.view_numbers()[view]);
    run.extreme_pictures.push_back(
        write(run, view, "normals",
              shade_hits(hits, scene.views()[view], scene.width(), scene.height(), scene.loaded().scene.mesh)));
    run.extreme_pictures.push_back(write(run, view, "steps", draw_steps(hits, scene.width(), scene.height(), title)));
}

std::string ResultPictures::write(const SceneRun& run, std::size_t view, const std::string& kind,
                                  const Pixmap& pixmap) const
{
    const std::string name = fmt::format("{}-{}-{}-{}{}", result_.stem().string(), run.scene->label(),
                                         run.scene->view_numbers()[view], kind, ending_);
    writer_.write(result_.parent_path() / name, pixmap);
    return name;
}

} // namespace tetrace
