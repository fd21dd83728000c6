// The C functions: what their callers may do wrong, and exceptions as a status and a text.
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "embed/include/tetrace/tetrace.h"
#include "embed/tracer.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

static_assert(sizeof(tetrace_ray) == 32 && offsetof(tetrace_ray, t_min) == 12 && offsetof(tetrace_ray, t_max) == 28);
static_assert(sizeof(tetrace_hit) == 16 && offsetof(tetrace_hit, t) == 4 && offsetof(tetrace_hit, v) == 12);
static_assert(sizeof(tetrace_device) == 4 * sizeof(void*) + 16 && offsetof(tetrace_device, index) == 4 * sizeof(void*));
static_assert(sizeof(tetrace_scene_info) == 64 && offsetof(tetrace_scene_info, low) == 16);
static_assert(TETRACE_CPU == static_cast<int>(tetrace::DeviceKind::cpu) &&
              TETRACE_GPU == static_cast<int>(tetrace::DeviceKind::gpu) &&
              TETRACE_EMULATED == static_cast<int>(tetrace::DeviceKind::emulated));
static_assert(TETRACE_NO_HIT == NO_HIT);

struct tetrace_scene {
    std::shared_ptr<const tetrace::LoadedScene> loaded;
};
struct tetrace_tracer {
    tetrace::Tracer tracer;
};

namespace {

using tetrace::Error;
using tetrace::ErrorKind;

thread_local std::string last_error;

tetrace_status status_of(ErrorKind kind)
{
    switch (kind) {
    case ErrorKind::usage: return TETRACE_USAGE;
    case ErrorKind::invalid_input: return TETRACE_INVALID_INPUT;
    case ErrorKind::missing: return TETRACE_MISSING;
    case ErrorKind::unsupported: return TETRACE_UNSUPPORTED;
    case ErrorKind::internal: return TETRACE_INTERNAL;
    case ErrorKind::driver: return TETRACE_DRIVER;
    case ErrorKind::wrong_result: return TETRACE_WRONG_RESULT;
    case ErrorKind::interrupted: return TETRACE_INTERRUPTED;
    }
    return TETRACE_INTERNAL;
}

tetrace_status failed(tetrace_status status, const char* what) noexcept
{
    try {
        last_error = what;
    } catch (...) {
        last_error.clear(); // there is no memory for the text
    }
    return status;
}

/// Calls are executed one after the other: two sessions of a device share its queue.
std::mutex& one_at_a_time()
{
    static std::mutex mutex;
    return mutex;
}

template <class Call>
tetrace_status guarded(const Call& call) noexcept
{
    try {
        const std::scoped_lock lock(one_at_a_time());
        call();
        return TETRACE_OK;
    } catch (const Error& error) {
        return failed(status_of(error.kind()), error.what());
    } catch (const std::bad_alloc&) {
        return failed(TETRACE_UNSUPPORTED,
                      "not enough memory on the host: trace fewer rays at once, or a smaller scene");
    } catch (const std::exception& error) {
        return failed(TETRACE_INTERNAL, error.what());
    } catch (...) {
        return failed(TETRACE_INTERNAL, "an unknown exception");
    }
}

template <class... Pointers>
void require_pointers(const char* function, Pointers... pointers)
{
    if (((pointers == nullptr) || ...))
        throw Error(ErrorKind::usage, std::string(function) + ": a pointer is null that must not be");
}

/// Never freed, since callers keep its texts.
const std::vector<tetrace_device>& listed_devices()
{
    static const auto* const listed = [] {
        auto* const devices = new std::vector<tetrace_device>;
        for (tetrace::Backend* const backend : tetrace::all_backends()) {
            const std::string& name = *new std::string(backend->name());
            const auto& found = backend->devices();
            for (std::uint32_t i = 0; i < found.size(); ++i)
                if (!found[i].usable || tetrace::traces_given_rays(*backend))
                    devices->push_back({name.c_str(), found[i].name.c_str(), found[i].driver.c_str(),
                                        found[i].reason.c_str(), i, static_cast<std::uint32_t>(found[i].kind),
                                        found[i].usable ? 1u : 0u, 0});
        }
        return devices;
    }();
    return *listed;
}

tetrace_scene_info info_of(const tetrace::Scene& scene)
{
    tetrace_scene_info info{scene.mesh.triangles.size(), scene.tets.tets.size(), {}, {}};
    const auto [low, high] = tetrace::bounding_box(scene.mesh);
    const double unit = std::ldexp(1.0, -scene.build.scale_exponent);
    const auto put = [&](tetrace::Double3 corner, double(&to)[3]) {
        corner = corner * unit + scene.build.centre;
        to[0] = corner.x, to[1] = corner.y, to[2] = corner.z;
    };
    put(low, info.low);
    put(high, info.high);
    return info;
}

} // namespace

const char* tetrace_version(void)
{
    return TETRACE_VERSION;
}

const char* tetrace_last_error(void)
{
    return last_error.c_str();
}

tetrace_status tetrace_devices(const tetrace_device** devices, size_t* count)
{
    return guarded([&] {
        require_pointers("tetrace_devices", devices, count);
        *devices = listed_devices().data();
        *count = listed_devices().size();
    });
}

tetrace_status tetrace_scene_load(const char* name, tetrace_scene** scene)
{
    return guarded([&] {
        require_pointers("tetrace_scene_load", name, scene);
        tetrace::SceneRequest request{name, tetrace::default_build(tetrace::TetsKind::rays)};
        request.build.mesh_will_do = true;
        *scene = new tetrace_scene{
            std::make_shared<const tetrace::LoadedScene>(tetrace::load_scene(request, tetrace::Progress{}))};
    });
}

tetrace_status tetrace_scene_get_info(const tetrace_scene* scene, tetrace_scene_info* info)
{
    return guarded([&] {
        require_pointers("tetrace_scene_get_info", scene, info);
        *info = info_of(scene->loaded->scene);
    });
}

void tetrace_scene_free(tetrace_scene* scene)
{
    delete scene;
}

tetrace_status tetrace_open(const tetrace_scene* scene, const char* backend, uint32_t device, const char* layout,
                            tetrace_tracer** tracer)
{
    return guarded([&] {
        require_pointers("tetrace_open", scene, backend, tracer);
        *tracer =
            new tetrace_tracer{tetrace::Tracer(scene->loaded, backend, device, layout == nullptr ? "half32" : layout)};
    });
}

tetrace_status tetrace_trace(tetrace_tracer* tracer, const tetrace_ray* rays, size_t count, uint32_t flags,
                             tetrace_hit* hits)
{
    return guarded([&] {
        require_pointers("tetrace_trace", tracer);
        if (count > 0) require_pointers("tetrace_trace", rays, hits);
        if ((flags & ~std::uint32_t{TETRACE_ANY_HIT}) != 0)
            throw Error(ErrorKind::usage, "tetrace_trace: flags are 0 or TETRACE_ANY_HIT");
        tracer->tracer.trace({rays, count}, (flags & TETRACE_ANY_HIT) != 0, {hits, count});
    });
}

void tetrace_close(tetrace_tracer* tracer)
{
    if (tracer == nullptr) return;
    const std::scoped_lock lock(one_at_a_time());
    delete tracer;
}
