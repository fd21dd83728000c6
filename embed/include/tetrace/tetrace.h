// tetrace/: tetrace as a library, for C and for what calls C. docs/embed.md shows how to use it.
//
// Every function may be called from any thread; calls are executed one after the other, since each uses the whole
// device. Functions that can fail return TETRACE_OK or the kind of the failure, and tetrace_last_error() then has its
// text. Drivers run in the calling process: one that crashes ends it.
#ifndef TETRACE_H
#define TETRACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TETRACE_API __attribute__((visibility("default")))

typedef int32_t tetrace_status;
enum {
    TETRACE_OK = 0,
    TETRACE_USAGE = 1,         // an argument or a name that is not accepted
    TETRACE_INVALID_INPUT = 2, // a file or a mesh that cannot be used
    TETRACE_MISSING = 3,       // a file, program or device is missing
    TETRACE_UNSUPPORTED = 4,   // a limit of the device or of memory
    TETRACE_INTERNAL = 5,      // a fault of tetrace
    TETRACE_DRIVER = 6,        // a device's driver failed
    TETRACE_WRONG_RESULT = 7,  // a device returned what its kernel cannot have written
    TETRACE_INTERRUPTED = 8    // SIGINT or SIGTERM while a scene was built
};

// A scene that was loaded, and a scene on a device.
typedef struct tetrace_scene tetrace_scene;
typedef struct tetrace_tracer tetrace_tracer;

// origin + t * direction with t_min <= t <= t_max, in the mesh file's coordinates. The direction has any length but 0,
// t counts in its length, and t_max may be infinite.
typedef struct tetrace_ray {
    float origin[3];
    float t_min;
    float direction[3];
    float t_max;
} tetrace_ray;

#define TETRACE_NO_HIT 0xFFFFFFFFu

// The nearest triangle that a ray meets, from 0 in the order of the mesh file; TETRACE_NO_HIT, with t = u = v = 0, if
// it meets none. The point is (1 - u - v) * a + u * b + v * c of the triangle's corners a, b, c.
typedef struct tetrace_hit {
    uint32_t triangle;
    float t, u, v;
} tetrace_hit;

// Emulated: a GPU's API on the processor.
enum { TETRACE_CPU = 0, TETRACE_GPU = 1, TETRACE_EMULATED = 2 };

// A device of an API. Texts are UTF-8, never null, and last as long as the process.
typedef struct tetrace_device {
    const char* backend; // the API: "openmp", "opencl", "vulkan", "cuda" ...
    const char* name;
    const char* driver;
    const char* reason; // why it is not usable, and what to install; empty if it is
    uint32_t index;     // among the devices of its API
    uint32_t kind;      // TETRACE_CPU ...
    uint32_t usable;    // 1 or 0
    uint32_t reserved;
} tetrace_device;

// What a scene has. Its bounds are those of its triangles, in the mesh file's coordinates.
typedef struct tetrace_scene_info {
    uint64_t triangles;
    uint64_t tets; // 0: only BVHs can be made of the scene
    double low[3], high[3];
} tetrace_scene_info;

// "0.1.0": the library's version.
TETRACE_API const char* tetrace_version(void);

// What went wrong in the last call of this thread that failed, and what to do; empty if none did. It lasts until the
// thread's next call that fails.
TETRACE_API const char* tetrace_last_error(void);

// All devices of this machine, usable or not; the list lasts as long as the process. The first call loads drivers.
TETRACE_API tetrace_status tetrace_devices(const tetrace_device** devices, size_t* count);

// Loads a mesh file (PLY, OBJ, OFF, STL, glTF), a .tet file, or a scene of the catalogue such as "cubes", as the
// program does by default, from the same cache. A mesh that is not cached needs the program tetrace-builder: the one
// that the environment variable TETRACE_BUILDER names, else in PATH.
TETRACE_API tetrace_status tetrace_scene_load(const char* name, tetrace_scene** scene);
TETRACE_API tetrace_status tetrace_scene_get_info(const tetrace_scene* scene, tetrace_scene_info* info);
// Tracers of the scene stay valid. Null is accepted.
TETRACE_API void tetrace_scene_free(tetrace_scene* scene);

// Packs a scene and copies it to a device. layout: "half32" or "tet64", "tet80", "tet96" (tets), "bvh2", "bvh4" or
// "cwbvh" (BVHs), or "rt", the BVH of a Vulkan driver with ray queries. Null is "half32".
TETRACE_API tetrace_status tetrace_open(const tetrace_scene* scene, const char* backend, uint32_t device,
                                        const char* layout, tetrace_tracer** tracer);

// Any triangle in the range will do, not only the nearest: for shadows.
enum { TETRACE_ANY_HIT = 1 };

// Traces rays; hits[i] is that of rays[i]. flags: 0 or TETRACE_ANY_HIT. A ray that is not finite, or without a
// direction, is TETRACE_USAGE, and no hit is written.
TETRACE_API tetrace_status tetrace_trace(tetrace_tracer* tracer, const tetrace_ray* rays, size_t count, uint32_t flags,
                                         tetrace_hit* hits);
// Null is accepted.
TETRACE_API void tetrace_close(tetrace_tracer* tracer);

#ifdef __cplusplus
}
#endif

#endif
