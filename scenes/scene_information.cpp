#include "scenes/scene_information.h"

#include "core/base/printable.h"
#include "scenes/information.h"

namespace tetrace {
namespace {

void put_optimised(InformationWriter& out, const OptimisedInfo& info)
{
    out.put(static_cast<std::uint32_t>(info.asked));
    out.put(static_cast<std::uint32_t>(info.tets));
    out.put(info.reason);
    out.put(static_cast<std::int32_t>(info.effort));
    for (const double value : {info.cost_before, info.cost_after, info.seconds})
        out.put(value);
    out.put(info.rounds);
    out.put(static_cast<std::uint32_t>(info.operations.size()));
    for (const OptimiserOperation& operation : info.operations) {
        out.put(operation.name);
        out.put(operation.done);
        out.put(operation.gain);
        out.put(operation.seconds);
    }
    out.put(static_cast<std::uint32_t>(info.end));
}

bool get_optimised(InformationReader& in, OptimisedInfo& info)
{
    for (TetsKind* kind : {&info.asked, &info.tets}) {
        std::uint32_t value = 0;
        in.get(value);
        if (value > static_cast<std::uint32_t>(TetsKind::rays)) return false;
        *kind = static_cast<TetsKind>(value);
        if (kind == &info.tets) in.get(info.reason);
    }
    std::int32_t effort = 0;
    in.get(effort);
    info.effort = effort;
    for (double* value : {&info.cost_before, &info.cost_after, &info.seconds})
        in.get(*value);
    in.get(info.rounds);
    std::uint32_t operations = 0, end = 0;
    in.get(operations);
    if (operations > 64) return false; // there are fewer than ten
    info.operations.resize(operations);
    for (OptimiserOperation& operation : info.operations) {
        in.get(operation.name);
        in.get(operation.done);
        in.get(operation.gain);
        in.get(operation.seconds);
    }
    in.get(end);
    info.end = static_cast<OptimiserEnd>(end);
    return end <= static_cast<std::uint32_t>(OptimiserEnd::interrupted);
}

void put_repair(InformationWriter& out, const RepairInfo& info)
{
    out.put(static_cast<std::uint32_t>(info.asked));
    for (const std::uint64_t count : {info.crossing_pairs, info.cut_triangles, info.pieces, info.dropped})
        out.put(count);
    out.put(info.passes);
}

bool get_repair(InformationReader& in, RepairInfo& info)
{
    std::uint32_t asked = 0;
    in.get(asked);
    info.asked = asked == 1;
    for (std::uint64_t* count : {&info.crossing_pairs, &info.cut_triangles, &info.pieces, &info.dropped})
        in.get(*count);
    in.get(info.passes);
    return asked <= 1;
}

} // namespace

std::vector<char> pack_information(const Scene& scene)
{
    InformationWriter out;
    out.put(scene.name);
    out.put(static_cast<std::uint32_t>(scene.domain.kind));
    out.put(scene.domain.divisions);
    const BuildInfo& build = scene.build;
    out.put(build.source);
    out.put(build.source_hash);
    out.put(build.switches);
    out.put(build.tool);
    out.put(build.build_s);
    out.put(static_cast<std::int32_t>(build.scale_exponent));
    for (const std::uint64_t count :
         {build.merged_vertices, build.degenerate_triangles, build.duplicate_triangles, build.snapped_coordinates})
        out.put(count);
    put_repair(out, build.repair);
    put_optimised(out, build.optimised);
    return out.take();
}

bool unpack_information(std::span<const char> bytes, Scene& scene)
{
    InformationReader in(bytes);
    in.get(scene.name);
    scene.name = printable_line(scene.name);
    std::uint32_t kind = 0;
    in.get(kind);
    if (kind > static_cast<std::uint32_t>(DomainKind::wide)) return false;
    scene.domain.kind = static_cast<DomainKind>(kind);
    in.get(scene.domain.divisions);
    BuildInfo& build = scene.build;
    in.get(build.source);
    in.get(build.source_hash);
    in.get(build.switches);
    in.get(build.tool);
    in.get(build.build_s);
    std::int32_t exponent = 0;
    in.get(exponent);
    build.scale_exponent = exponent;
    for (std::uint64_t* count :
         {&build.merged_vertices, &build.degenerate_triangles, &build.duplicate_triangles, &build.snapped_coordinates})
        in.get(*count);
    return get_repair(in, build.repair) && get_optimised(in, build.optimised) && in.finished();
}

} // namespace tetrace
