#include "bench/output/difference_pictures.h"

#include "bench/pictures/images.h"
#include "bench/pictures/shading.h"
#include "bench/rows/row_tracing.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

/// "cubes-0-cdt-maria-tet80-vulkan-1", without an ending.
std::string file_name(const SeenImage& image)
{
    std::string name = fmt::format("{}-{}-{}-{}", image.row.key.scene, image.row.scene->view_numbers()[image.view],
                                   kernel_title(image.row.key), device_label(image.row.key));
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == ':' || c == '/'; }, '-');
    return name;
}

/// Hits of given rays, each at the pixel that its ray was made for; misses elsewhere.
std::vector<Hit> at_pixels(const SeenImage& image, std::span<const Hit> hits)
{
    std::vector<Hit> pixels(image.row.scene->rays_per_view(), Hit{NO_HIT, NO_TET, 0, 0, 0, 0});
    for (std::size_t ray = 0; ray < hits.size(); ++ray)
        pixels[pixel_of_ray(image.row, image.view, ray)] = hits[ray];
    return pixels;
}

} // namespace

Pixmap draw_differences(std::span<const Hit> hits, std::span<const Hit> reference, Allowance allowed,
                        const SceneWork& scene, std::size_t view)
{
    constexpr float darkened = 0.3f;
    const Colour mark = from_srgb(0xFF5A1F);
    Pixmap picture =
        shade_hits(reference, scene.views()[view], scene.width(), scene.height(), scene.loaded().scene.mesh);
    for (std::size_t i = 0; i < hits.size(); ++i)
        picture.pixels[i] = is_same_hit(hits[i], reference[i], allowed) ? picture.pixels[i] * darkened : mark;
    return picture;
}

DifferencePictures::DifferencePictures(std::filesystem::path folder)
    : folder_(std::move(folder)), ending_(picture_ending({}, has_images_module())), writer_(ending_)
{
    std::error_code problem;
    std::filesystem::create_directories(folder_, problem);
    if (!std::filesystem::is_directory(folder_))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--differences: the folder '{}' cannot be made: {}; name another one", folder_.string(),
                                problem ? problem.message() : "a file has that name"));
}

void DifferencePictures::see(const SeenImage& image)
{
    if (image.reference.empty() || !traits_of(image.row.key.kernel.task).finds_hits) return;
    const Allowance allowed = allowance_of(image.row);
    if (compare_hits(image.hits, image.reference, allowed).count == 0) return;
    const auto path = folder_ / (file_name(image) + ending_);
    const auto hits = at_pixels(image, image.hits), reference = at_pixels(image, image.reference);
    writer_.write(path, draw_differences(hits, reference, allowed, *image.row.scene, image.view));
    files_.push_back(path);
}

} // namespace tetrace
