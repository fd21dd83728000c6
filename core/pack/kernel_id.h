#pragma once

#include "core/base/enum_names.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace tetrace {

enum class Structure { cdt, bvh };
template <>
inline constexpr auto enum_names<Structure> = names_up_to<Structure::bvh>("cdt", "bvh");
/// How a structure is traversed: an exit-face search of the CDT (kernels/methods/<name>.h), or how many rays are traced
/// together through a BVH.
enum class Method {
#define METHOD(name, ...) name,
#include "kernels/kernel_list.inc"
};
/// A packed form of the mesh: tets (half32: a record for each tet and entry face; tet64: a cache line a tet; tet20 and
/// tet16: tets that share their vertices), a BVH of our own, or a BVH that Embree or a GPU's driver (rt) builds itself.
enum class Layout {
#define LAYOUT(name, ...) name,
#define FOREIGN_LAYOUT(name) name,
#include "kernels/kernel_list.inc"
};
enum class MathMode { exact, fast };
template <>
inline constexpr auto enum_names<MathMode> = names_up_to<MathMode::fast>("exact", "fast");
/// What rays are for (core/rays/ray_set.h). All but primary rays are given to a session. The values select streams of
/// random numbers.
enum class RayKind { primary = 0, shadow = 1, ao = 2, diffuse = 3, random = 4 };
template <>
inline constexpr auto enum_names<RayKind> = names_up_to<RayKind::random>("primary", "shadow", "ao", "diffuse",
                                                                         "random");
/// The order of given rays: by their pixels' tiles, along a space-filling curve, at random.
enum class RayOrder { tiles, morton, shuffled };
template <>
inline constexpr auto enum_names<RayOrder> = names_up_to<RayOrder::shuffled>("tiles", "morton", "shuffled");
/// How rays are assigned to work items: one ray per item and one tile per group; or items that stay and fetch rays
/// until none is left (Aila, Laine, Karras 2012); or packets with as many rays as a processor's vectors have lanes. Or,
/// as tiles, by code for instructions that not every processor has, as that of packets is: packets over `native`
/// compares the two ways to trace, and `native` over `tiles` the instruction sets. Or, for a BVH of a GPU's driver
/// (rt), as the driver's ray-tracing pipeline assigns them.
enum class Schedule { tiles, persistent, packets, native, pipeline };
template <>
inline constexpr auto enum_names<Schedule> = names_up_to<Schedule::pipeline>("tiles", "persistent", "packets", "native",
                                                                             "pipeline");
/// Whether more than one backend has the schedule.
[[nodiscard]] constexpr bool is_common(Schedule schedule)
{
    return schedule == Schedule::tiles || schedule == Schedule::persistent;
}
/// What a kernel does: it traces the primary rays of an image, traces given rays, searches the exit face of a single
/// tet for each given ray, or crosses every tet on given rays (core/rays/segments.h), for task tally with the sum of
/// the lengths in each tet, for task absorb with the light of a medium there (core/rays/absorbed.h).
enum class Task {
#define TASK(name, ...) name,
#define GIVEN_TASK(name, ...) name,
#define CROSSING_TASK(name, ...) name,
#include "kernels/kernel_list.inc"
};
template <>
inline constexpr auto enum_names<Task> = std::to_array<std::string_view>({
#define TASK(name, ...) #name,
#define GIVEN_TASK(name, ...) #name,
#define CROSSING_TASK(name, ...) #name,
#include "kernels/kernel_list.inc"
});
/// What rays an entry point of a kernel is for: primary ones from outside the domain, primary ones from inside, and
/// those of each task that is given rays, by its name.
enum class Entry {
    outside,
    inside,
#define GIVEN_TASK(name, ...) name,
#define CROSSING_TASK(name, ...) name,
#include "kernels/kernel_list.inc"
};
template <>
inline constexpr auto enum_names<Entry> = std::to_array<std::string_view>({
    "outside",
    "inside",
#define GIVEN_TASK(name, ...) #name,
#define CROSSING_TASK(name, ...) #name,
#include "kernels/kernel_list.inc"
});

/// What those who know nothing else of a task ask of it, from its row in kernels/kernel_list.inc.
struct TaskTraits {
    std::string_view what = {}; ///< "given rays": the rays or their answers
    std::string_view help = {}; ///< that of --task, for tasks that cross tets
    std::size_t words = 0;      ///< of a ray's answer
    bool takes_rays = false;    ///< given to a session; else they are an image's
    bool finds_hits = false; ///< its answers are hits (core/rays/hit.h), in any schedule and math mode that the kernel
                             ///< has; other tasks have schedule tiles alone, but for has_packets
    bool crosses = false; ///< it goes through occlusive faces, to where a ray leaves the domain: no ray has an end, and
                          ///< math mode is exact
    bool absorbs = false; ///< it crosses a medium, and ends where too little light passes
    bool tallies = false; ///< it has a sum of lengths per tet, too, after the answers of the rays
    bool has_packets = false; ///< of a task that crosses: a walk of it is written for packets, too
};
[[nodiscard]] const TaskTraits& traits_of(Task task);

/// The task by which options and results call it: given rays are of task trace, too.
[[nodiscard]] constexpr Task asked_task(Task task)
{
    return task == Task::rays ? Task::trace : task;
}

/// The order of the tets in memory: along a space-filling curve; the same, with the tets that no ray from outside
/// reaches (inside closed surfaces) after all others; the same in chains, each tet followed by its neighbour across its
/// largest free face; as the tetrahedralization wrote them.
enum class TetOrder { chains, hilbert, reached, input };
template <>
inline constexpr auto enum_names<TetOrder> = names_up_to<TetOrder::input>("chains", "hilbert", "reached", "input");

/// A kernel's name as data: backends map it to code, or say that they have none.
struct KernelId {
    Structure structure = Structure::cdt;
    Method method = Method::maria;
    Layout layout = Layout::tet80;
    MathMode math = MathMode::exact;
    Schedule schedule = Schedule::tiles;
    Task task = Task::trace;

    friend bool operator==(const KernelId&, const KernelId&) = default;
};

/// Every kernel of task trace that some backend can run, from kernels/kernel_list.inc and in its order: first those of
/// the CDT, then of our BVHs, then foreign ones; each by schedule, tiles first, and math mode, exact first.
[[nodiscard]] const std::vector<KernelId>& all_kernels();

/// Whether the list has the kernel with that task (kernels/kernel_list.inc, TaskTraits).
[[nodiscard]] bool has_task(const KernelId& kernel);

/// Whether the kernel has packets; its schedule is ignored. Only one walk is written for packets, in exact mode.
[[nodiscard]] bool has_packets(const KernelId& kernel);

/// The kernels for a task, in the same order.
[[nodiscard]] std::vector<KernelId> kernels_of(Task task);

/// The structure that a layout packs.
[[nodiscard]] Structure structure_of(Layout layout);
/// Whether a layout is a BVH that Embree builds.
[[nodiscard]] bool is_embree(Layout layout);
/// The rays of a packet of a method of BVHs; 0 of the others, a stream too.
[[nodiscard]] unsigned packet_width(Method method);
/// How a row of Embree's is called: its method, and its tree unless that is of quality high: "packet16 robust".
[[nodiscard]] std::string embree_title(std::string_view method, std::string_view layout);
/// Whether a layout's tets share their vertices and do not name their corners: only method project walks them.
[[nodiscard]] bool is_compact(Layout layout);
/// Whether the kernel is one of kernels/, the same source on every backend; those of Embree and of drivers are not.
[[nodiscard]] bool is_portable(const KernelId& kernel);

/// Whether the kernel should lose no ray and get none wrong (kernels/kernel_list.inc); none does in math mode fast
/// (docs/spec/numbers.md, N5). Wrong and lost rays then fail a
/// run. Those of other kernels are counted and shown with the rate, but fail nothing.
[[nodiscard]] bool claims_robustness(const KernelId& kernel);

/// Whether the kernel has rows when no method is named.
[[nodiscard]] bool is_default(const KernelId& kernel);

[[nodiscard]] std::string_view name_of(Method value);
[[nodiscard]] std::string_view name_of(Layout value);

/// structure/method/layout, for example "cdt/maria/tet80"; of a task that finds no hits its name in place of the
/// structure, "segments/maria/tet80".
[[nodiscard]] std::string name_of(const KernelId& kernel);

struct Bvh;
struct PackedScene;
struct TetMesh;
struct TriangleMesh;

/// The properties of a method, from its row in kernels/kernel_list.inc.
struct MethodTraits {
    std::string_view name;
    int year;                 ///< of its first source; 0 for BVHs
    double vertices;          ///< that a step loads, on average
    bool has_doubles = false; ///< computes in double precision, which openmp alone has
};
[[nodiscard]] const MethodTraits& traits_of(Method method);

/// Layouts of a family share their arrays and their walk. foreign: not ours, see FOREIGN_LAYOUT of the list.
enum class Family { cdt, compact, bvh, foreign };

/// Fills `tets` of a packed scene, and the arrays of its family, from tets in packed order.
/// packed: its layout, triangles, lines and entry half-faces are set. mesh: the scene's tets in packed order, with
/// half-faces in that numbering.
using PackTets = void(PackedScene& packed, const TetMesh& mesh);
/// Packs a BVH of the mesh: nodes and leaf triangles.
using PackBvh = PackedScene(const TriangleMesh& mesh, const Bvh& bvh);

// pack_<layout>() of each layout of ours, in core/pack.
#define LAYOUT(name, family, ...) std::conditional_t<Family::family == Family::bvh, PackBvh, PackTets> pack_##name;
#include "kernels/kernel_list.inc"

/// The properties of a layout, from its row in kernels/kernel_list.inc.
struct LayoutTraits {
    std::string_view name;
    Family family;
    std::uint32_t most;  ///< tets, or references of a BVH's leaves to triangles
    double vertex_bytes; ///< that a step loads for each vertex that its method asks for
    double step_bytes;   ///< of its tet that a step loads in addition
    std::variant<std::monostate, PackTets*, PackBvh*> pack;
};
[[nodiscard]] const LayoutTraits& traits_of(Layout layout);

} // namespace tetrace
