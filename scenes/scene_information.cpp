#include "scenes/scene_information.h"

#include "core/base/printable.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

namespace {

/// Appends plain values and strings (length first) to the information section.
class InformationWriter {
public:
    template <class Value>
    void put(Value value)
    {
        const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
        bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    }
    void put(const std::string& text)
    {
        put(static_cast<std::uint64_t>(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }
    [[nodiscard]] std::vector<char> take() { return std::move(bytes_); }

private:
    std::vector<char> bytes_;
};

/// Reads them back from bytes that outlive it. `good` becomes false at the first missing value, and stays so.
class InformationReader {
public:
    explicit InformationReader(std::span<const char> bytes) : rest_(bytes) {}

    template <class Value>
    void get(Value& value)
    {
        std::array<char, sizeof(Value)> raw{};
        if (take(raw)) value = std::bit_cast<Value>(raw);
    }
    void get(std::string& text)
    {
        std::uint64_t size = 0;
        get(size);
        if (!good_ || size > rest_.size()) {
            good_ = false;
            return;
        }
        text = printable_text({rest_.data(), static_cast<std::size_t>(size)});
        rest_ = rest_.subspan(static_cast<std::size_t>(size));
    }
    [[nodiscard]] bool finished() const { return !good_ || rest_.empty(); }
    [[nodiscard]] bool is_good() const { return good_; }

private:
    bool take(std::span<char> raw)
    {
        if (raw.size() > rest_.size()) good_ = false;
        if (!good_) return false;
        std::memcpy(raw.data(), rest_.data(), raw.size());
        rest_ = rest_.subspan(raw.size());
        return true;
    }

    std::span<const char> rest_;
    bool good_ = true;
};

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
    out.put(info.tolerance);
    out.put(info.moved);
}

bool get_repair(InformationReader& in, RepairInfo& info)
{
    std::uint32_t asked = 0;
    in.get(asked);
    info.asked = asked == 1;
    for (std::uint64_t* count : {&info.crossing_pairs, &info.cut_triangles, &info.pieces, &info.dropped})
        in.get(*count);
    in.get(info.passes);
    in.get(info.tolerance);
    in.get(info.moved);
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
    out.put(build.order);
    out.put(build.tool);
    out.put(build.build_s);
    for (const double value : {build.centre.x, build.centre.y, build.centre.z, build.rounding})
        out.put(value);
    out.put(static_cast<std::int32_t>(build.scale_exponent));
    for (const std::uint64_t count :
         {build.merged_vertices, build.degenerate_triangles, build.duplicate_triangles, build.snapped_coordinates})
        out.put(count);
    put_repair(out, build.repair);
    put_optimised(out, build.optimised);
    for (const SourceTet& own : scene.source_tets) // to the end
        out.put(own);
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
    in.get(build.order);
    in.get(build.tool);
    in.get(build.build_s);
    for (double* value : {&build.centre.x, &build.centre.y, &build.centre.z, &build.rounding})
        in.get(*value);
    std::int32_t exponent = 0;
    in.get(exponent);
    build.scale_exponent = exponent;
    for (std::uint64_t* count :
         {&build.merged_vertices, &build.degenerate_triangles, &build.duplicate_triangles, &build.snapped_coordinates})
        in.get(*count);
    if (!get_repair(in, build.repair) || !get_optimised(in, build.optimised)) return false;
    while (!in.finished())
        in.get(scene.source_tets.emplace_back());
    return in.is_good();
}

} // namespace tetrace
