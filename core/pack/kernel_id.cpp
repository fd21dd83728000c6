#include "core/pack/kernel_id.h"

namespace tetrace {

namespace {

/// Whether only a walk that carries vertices goes through the layout.
bool needs_project(Layout layout)
{
    return layout == Layout::half32 || is_compact(layout);
}

std::vector<KernelId> make_kernels()
{
    std::vector<KernelId> kernels;
    for (const Schedule schedule : {Schedule::tiles, Schedule::persistent})
        for (const MathMode math : {MathMode::exact, MathMode::fast})
            for (const Method method :
                 {Method::plane, Method::plucker, Method::stp, Method::ms06, Method::maria, Method::project})
                for (const Layout layout : {Layout::tet80, Layout::tet96, Layout::half32, Layout::tet20, Layout::tet16})
                    if (!needs_project(layout) || method == Method::project)
                        kernels.push_back({Structure::cdt, method, layout, math, schedule});
    kernels.push_back({Structure::cdt, Method::project, Layout::half32, MathMode::exact, Schedule::packets});
    for (const Schedule schedule : {Schedule::tiles, Schedule::persistent})
        for (const MathMode math : {MathMode::exact, MathMode::fast})
            for (const Layout layout : {Layout::bvh2, Layout::cwbvh})
                kernels.push_back({Structure::bvh, Method::single, layout, math, schedule});
    for (const Method method : {Method::single, Method::packet16})
        kernels.push_back({Structure::bvh, method, Layout::embree, MathMode::fast});
    kernels.push_back({Structure::bvh, Method::single, Layout::rt, MathMode::fast});
    return kernels;
}

} // namespace

const std::vector<KernelId>& all_kernels()
{
    static const std::vector<KernelId> kernels = make_kernels();
    return kernels;
}

std::vector<KernelId> kernels_of(Task task)
{
    std::vector<KernelId> kernels;
    for (KernelId kernel : all_kernels()) {
        kernel.task = task;
        if (has_task(kernel) && (task == Task::trace || kernel.schedule != Schedule::persistent))
            kernels.push_back(kernel);
    }
    return kernels;
}

bool has_packets(const KernelId& kernel)
{
    return kernel.method == Method::project && kernel.layout == Layout::half32 && kernel.math == MathMode::exact;
}

bool has_task(const KernelId& kernel)
{
    switch (kernel.task) {
    case Task::trace: return true;
    case Task::rays:
        return kernel.structure == Structure::bvh || kernel.method == Method::maria ||
               (kernel.method == Method::project && !is_compact(kernel.layout));
    case Task::search: return kernel.structure == Structure::cdt && !needs_project(kernel.layout);
    }
    return false;
}

Structure structure_of(Layout layout)
{
    const bool holds_corners = layout == Layout::tet80 || layout == Layout::tet96;
    return holds_corners || needs_project(layout) ? Structure::cdt : Structure::bvh;
}

bool is_compact(Layout layout)
{
    return layout == Layout::tet20 || layout == Layout::tet16;
}

bool is_portable(const KernelId& kernel)
{
    return kernel.layout != Layout::embree && kernel.layout != Layout::rt;
}

bool claims_robustness(const KernelId& kernel)
{
    return kernel.method == Method::maria || kernel.method == Method::project ||
           (kernel.structure == Structure::bvh && is_portable(kernel));
}

std::string_view name_of(Structure value)
{
    return value == Structure::cdt ? "cdt" : "bvh";
}

std::string_view name_of(Method value)
{
    switch (value) {
    case Method::plane: return "plane";
    case Method::plucker: return "plucker";
    case Method::stp: return "stp";
    case Method::ms06: return "ms06";
    case Method::maria: return "maria";
    case Method::project: return "project";
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
    case Layout::half32: return "half32";
    case Layout::tet20: return "tet20";
    case Layout::tet16: return "tet16";
    case Layout::bvh2: return "bvh2";
    case Layout::cwbvh: return "cwbvh";
    case Layout::embree: return "embree";
    case Layout::rt: return "rt";
    }
    return "?";
}

std::string_view name_of(MathMode value)
{
    return value == MathMode::exact ? "exact" : "fast";
}

std::string_view name_of(RayKind value)
{
    switch (value) {
    case RayKind::primary: return "primary";
    case RayKind::shadow: return "shadow";
    case RayKind::ao: return "ao";
    case RayKind::diffuse: return "diffuse";
    case RayKind::random: return "random";
    }
    return "?";
}

std::string_view name_of(RayOrder value)
{
    switch (value) {
    case RayOrder::tiles: return "tiles";
    case RayOrder::morton: return "morton";
    case RayOrder::shuffled: return "shuffled";
    }
    return "?";
}

std::string_view name_of(Schedule value)
{
    switch (value) {
    case Schedule::tiles: return "tiles";
    case Schedule::persistent: return "persistent";
    case Schedule::packets: return "packets";
    }
    return "?";
}

std::string_view name_of(Task value)
{
    switch (value) {
    case Task::trace: return "trace";
    case Task::rays: return "rays";
    case Task::search: return "search";
    }
    return "?";
}

std::string_view name_of(TetOrder value)
{
    switch (value) {
    case TetOrder::hilbert: return "hilbert";
    case TetOrder::reached: return "reached";
    case TetOrder::input: return "input";
    }
    return "?";
}

std::string name_of(const KernelId& kernel)
{
    std::string name(kernel.task == Task::search ? name_of(kernel.task) : name_of(kernel.structure));
    name.append("/").append(name_of(kernel.method)).append("/").append(name_of(kernel.layout));
    return name;
}

} // namespace tetrace
