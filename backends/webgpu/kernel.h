// A kernel as WGSL: the entry around the shared text. main.wgsl calls run_item() for each item of each work group.
// RAYS, SEGMENTS, TALLY and ABSORB: for those tasks, whose rays are given.
#include "kernels/language/dialect_wgsl.h"

#include "kernels/language/vector.h"

#include "kernels/language/scene_view_wgsl.h"

#ifdef TALLY
// One array of sums (sums.wgsl), which functions reach by its name.
#define LENGTH_SUMS uint
#define NO_SUMS 0u
#define HAS_SUMS(sums) true
#define ADD_TO_SUM(sums, word, added) add_to_sum(word, added)
uint add_to_sum(uint word, uint added);
#endif

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

#if defined(RAYS) || defined(SEGMENTS) || defined(TALLY) || defined(ABSORB)
// clang-format off
storage(RAYS_BINDING) uint4 rays[];
// clang-format on
#endif

STRUCT(AnswerWords)
{
    uint first;
    uint second;
    uint third;
    uint fourth;
    uint fifth;
    uint sixth;
};

#if defined(SEGMENTS) || defined(TALLY) || defined(ABSORB)
#ifdef ABSORB
#define ABSORBS true
#else
#define ABSORBS false
#endif
KERNEL_FN AnswerWords answer_of_pixel(SceneView scene, LaunchParams launch, Pixel pixel)
{
    uint ray = ray_index(pixel);
    Segments all = cross_tets(scene, launch.trace, NO_SUMS, ABSORBS, rays[ray], rays[ray_count(launch) + ray]);
    return AnswerWords(all.first, all.last, all.total, all.hash, all.reversed, all.crossings);
}
#else
KERNEL_FN AnswerWords answer_of_pixel(SceneView scene, LaunchParams launch, Pixel pixel)
{
#ifdef RAYS
    uint ray = ray_index(pixel);
    Hit hit = trace_given(scene, launch.trace, rays[ray], rays[ray_count(launch) + ray]);
#else
    Hit hit = trace(scene, launch.trace, primary_ray(launch.trace, pixel.x, pixel.y));
#endif
    return AnswerWords(hit.face_id, hit.tet, as_bits(hit.t), as_bits(hit.u), as_bits(hit.v), hit.steps);
}
#endif

void run_item(uint group, uint item)
{
    LaunchParams launch = launch_words.launch;
    Pixel pixel = pixel_of(launch, launch.first_tile + group, item);
    if (!is_in_image(launch, pixel)) return;
    SceneView scene;
    scene.divisions = launch.divisions;
    scene.domain = launch.domain;
    AnswerWords answer = answer_of_pixel(scene, launch, pixel);
    uint word = output_word(launch, pixel);
    output_words[word] = answer.first;
    output_words[word + 1u] = answer.second;
    output_words[word + 2u] = answer.third;
    output_words[word + 3u] = answer.fourth;
    output_words[word + 4u] = answer.fifth;
    output_words[word + 5u] = answer.sixth;
}
