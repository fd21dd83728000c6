// A kernel as WGSL: the entry around the shared text, of task trace. main.wgsl calls run_item() for each item of each
// work group.
#include "kernels/language/dialect_wgsl.h"

#include "kernels/language/vector.h"

#include "kernels/language/scene_view_wgsl.h"

#include "kernels/kernel.h"

STRUCT(LaunchWords)
{
    LaunchParams launch;
    uint zero; // 0, which no compiler knows: see keep()
};

// clang-format off
storage(LAUNCH_BINDING) LaunchWords launch_words;
storage_written(OUTPUT_BINDING) uint output_words[];
// clang-format on

KERNEL_FN Hit hit_of_pixel(LaunchParams launch, Pixel pixel)
{
    SceneView scene;
    scene.divisions = launch.divisions;
    scene.domain = launch.domain;
    return trace(scene, launch.trace, primary_ray(launch.trace, pixel.x, pixel.y));
}

void run_item(uint group, uint item)
{
    LaunchParams launch = launch_words.launch;
    Pixel pixel = pixel_of(launch, launch.first_tile + group, item);
    if (!is_in_image(launch, pixel)) return;
    Hit hit = hit_of_pixel(launch, pixel);
    uint word = output_word(launch, pixel);
    output_words[word] = hit.face_id;
    output_words[word + 1u] = hit.tet;
    output_words[word + 2u] = as_bits(hit.t);
    output_words[word + 3u] = as_bits(hit.u);
    output_words[word + 4u] = as_bits(hit.v);
    output_words[word + 5u] = hit.steps;
}
