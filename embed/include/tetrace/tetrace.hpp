// tetrace as a library for C++17, over the C functions of tetrace.h. docs/embed.md shows how to use it.
#ifndef TETRACE_HPP
#define TETRACE_HPP

#include "tetrace/tetrace.h"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace tetrace {
inline namespace embedded {

/// The one exception: its text says what was being done, to what, and what to do.
class Error : public std::runtime_error {
public:
    Error(tetrace_status status, const std::string& what) : std::runtime_error(what), status_(status) {}
    [[nodiscard]] tetrace_status status() const noexcept { return status_; }

private:
    tetrace_status status_;
};

inline void require(tetrace_status status)
{
    if (status != TETRACE_OK) throw Error(status, tetrace_last_error());
}

using Ray = tetrace_ray;
using Hit = tetrace_hit;
using Device = tetrace_device;

/// All devices of this machine, usable or not. Throws Error.
[[nodiscard]] inline std::vector<Device> devices()
{
    const tetrace_device* first = nullptr;
    std::size_t count = 0;
    require(tetrace_devices(&first, &count));
    return {first, first + count};
}

/// A scene, as tetrace_scene_load() finds it. Throws Error.
class Scene {
public:
    explicit Scene(const std::string& name)
    {
        tetrace_scene* loaded = nullptr;
        require(tetrace_scene_load(name.c_str(), &loaded));
        scene_.reset(loaded);
    }
    [[nodiscard]] tetrace_scene_info info() const
    {
        tetrace_scene_info info{};
        require(tetrace_scene_get_info(scene_.get(), &info));
        return info;
    }
    [[nodiscard]] const tetrace_scene* get() const noexcept { return scene_.get(); }

private:
    struct Free {
        void operator()(tetrace_scene* scene) const noexcept { tetrace_scene_free(scene); }
    };
    std::unique_ptr<tetrace_scene, Free> scene_;
};

/// A scene, packed, on a device. It may outlive the Scene. Throws Error.
class Tracer {
public:
    explicit Tracer(const Scene& scene, const std::string& backend = "openmp", std::uint32_t device = 0,
                    const std::string& layout = "half32")
    {
        tetrace_tracer* opened = nullptr;
        require(tetrace_open(scene.get(), backend.c_str(), device, layout.c_str(), &opened));
        tracer_.reset(opened);
    }
    /// The hit of each ray, in their order.
    [[nodiscard]] std::vector<Hit> trace(const std::vector<Ray>& rays, std::uint32_t flags = 0) const
    {
        std::vector<Hit> hits(rays.size());
        require(tetrace_trace(tracer_.get(), rays.data(), rays.size(), flags, hits.data()));
        return hits;
    }

private:
    struct Close {
        void operator()(tetrace_tracer* tracer) const noexcept { tetrace_close(tracer); }
    };
    std::unique_ptr<tetrace_tracer, Close> tracer_;
};

} // namespace embedded
} // namespace tetrace

#endif
