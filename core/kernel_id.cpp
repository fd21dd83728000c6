#include "core/kernel_id.h"

namespace tetrace {

const std::vector<KernelId>& all_kernels()
{
    using enum Method;
    using enum Layout;
    static const std::vector<KernelId> kernels = {
        {Structure::cdt, maria, tet80, MathMode::exact},  {Structure::cdt, maria, tet96, MathMode::exact},
        {Structure::cdt, maria, tet80, MathMode::fast},   {Structure::cdt, maria, tet96, MathMode::fast},
        {Structure::bvh, single, embree, MathMode::fast}, {Structure::bvh, packet16, embree, MathMode::fast},
    };
    return kernels;
}

std::string_view name_of(Structure value)
{
    return value == Structure::cdt ? "cdt" : "bvh";
}

std::string_view name_of(Method value)
{
    switch (value) {
    case Method::maria: return "maria";
    case Method::single: return "single";
    case Method::packet16: return "packet16";
    }
    return "?";
}

std::string_view name_of(Layout value)
{
    switch (value) {
    case Layout::tet80: return "tet80";
    case Layout::tet96: return "tet96";
    case Layout::embree: return "embree";
    }
    return "?";
}

std::string_view name_of(MathMode value)
{
    return value == MathMode::exact ? "exact" : "fast";
}

std::string_view name_of(RayKind)
{
    return "primary";
}

std::string_view name_of(TetOrder value)
{
    return value == TetOrder::hilbert ? "hilbert" : "input";
}

std::string name_of(const KernelId& kernel)
{
    std::string name(name_of(kernel.structure));
    name.append("/").append(name_of(kernel.method)).append("/").append(name_of(kernel.layout));
    return name;
}

} // namespace tetrace
