#include "scenes/optimise/optimise.h"

#include "core/base/stopwatch.h"
#include "scenes/optimise/collapse.h"
#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/face_removal.h"
#include "scenes/optimise/forecast.h"
#include "scenes/optimise/insertion.h"
#include "scenes/optimise/vertex_move.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {
namespace {

// Rounds end when one lowers the cost by less than this part of it.
struct Effort {
    std::uint32_t most_rounds;
    double share;
    bool inserts;
};
constexpr std::array<Effort, most_effort + 1> efforts = {
    {{0, 1, false}, {2, 0.05, false}, {16, 0.004, false}, {40, 0.001, true}}};
constexpr double negligible = 1e-12;                // a gain, as a part of the boundary's area
constexpr std::uint32_t tries_between_looks = 1024; // at clock and limits

class Optimiser {
public:
    Optimiser(const TetMesh& mesh, const OptimiserLimits& limits, const Progress& progress)
        : limits_(limits), effort_(efforts[static_cast<std::size_t>(std::clamp(limits.effort, 0, most_effort))]),
          progress_(progress), mesh_(mesh), per_area_(2 / mesh_.boundary_area()), least_(negligible / per_area_),
          edges_(mesh_), collapse_(mesh_), insertion_(mesh_)
    {
        report_.operations = {{{"edges removed"}, {"faces removed"}, {"moves"}, {"collapses"}, {"insertions"}}};
        report_.cost_before = cost_ = mesh_.cost() * per_area_;
    }

    [[nodiscard]] OptimisedTets run()
    {
        for (std::uint32_t i = 0; i < effort_.most_rounds && !ends_early(); ++i) {
            const double gain = round();
            if (gain < effort_.share * cost_) break;
            forecast_.end_round(watch_.seconds(), gain);
        }
        report_.cost_after = mesh_.cost() * per_area_;
        report_.seconds = watch_.seconds();
        return {mesh_.take(), report_};
    }

private:
    enum Operation : std::size_t { edge, face, move, collapse, insertion };

    double round();
    template <class Try>
    void sweep(Operation operation, std::uint32_t count, const Try& try_one);
    void flip();
    void insert_vertices();
    [[nodiscard]] bool ends_early() const { return report_.end != OptimiserEnd::finished; }
    void look_at_limits(double share_of_sweep);
    void tell(double share_of_sweep) const;

    OptimiserLimits limits_;
    Effort effort_;
    const Progress& progress_;
    Stopwatch watch_;
    EditableMesh mesh_;
    double per_area_; ///< of a sum of areas, to the number of faces that a uniform line crosses
    double least_;
    EdgeRemoval edges_;
    Collapse collapse_;
    Insertion insertion_;
    VertexStar star_;
    OptimiserReport report_;
    double cost_ = 0;
    std::uint32_t since_ = 1;
    std::uint32_t sweeps_ = 0; ///< of this round
    Forecast forecast_;
};

void Optimiser::look_at_limits(double share_of_sweep)
{
    if (limits_.time_limit_s > 0 && watch_.seconds() > limits_.time_limit_s) report_.end = OptimiserEnd::out_of_time;
    if (limits_.stop != nullptr && limits_.stop->load()) report_.end = OptimiserEnd::interrupted;
    tell(share_of_sweep);
}

void Optimiser::tell(double share_of_sweep) const
{
    if (!progress_) return;
    const double share_of_round = (sweeps_ + share_of_sweep) / (effort_.inserts ? 7 : 6);
    double left_s =
        forecast_.left_s(watch_.seconds(), share_of_round, effort_.share * cost_, effort_.most_rounds - report_.rounds);
    if (limits_.time_limit_s > 0) left_s = std::min(left_s, std::max(0.0, limits_.time_limit_s - watch_.seconds()));
    progress_("optimising", watch_.seconds() / (watch_.seconds() + left_s),
              fmt::format("round {}: a line crosses {:.2f} faces, {:.2f} before", report_.rounds, cost_,
                          report_.cost_before));
}

// try_one(index) returns the gain as an area. Only what changed since the last round is looked at.
template <class Try>
void Optimiser::sweep(Operation operation, std::uint32_t count, const Try& try_one)
{
    const double begin_s = watch_.seconds();
    OperationCount& total = report_.operations[operation];
    for (std::uint32_t i = 0; i < count && !ends_early(); ++i) {
        if (i % tries_between_looks == 0) look_at_limits(static_cast<double>(i) / count);
        const double gain = ends_early() ? 0 : try_one(i) * per_area_;
        if (gain <= 0) continue;
        ++total.done;
        total.gain += gain;
        cost_ -= gain;
    }
    total.seconds += watch_.seconds() - begin_s;
    ++sweeps_;
}

void Optimiser::flip()
{
    edges_.since = since_;
    const auto is_new = [&](std::uint32_t tet) { return mesh_.is_reached(tet) && mesh_.tet_changed(tet) >= since_; };
    sweep(edge, mesh_.tet_slots() * 6,
          [&](std::uint32_t i) { return is_new(i / 6) ? edges_.try_edge(i / 6, i % 6, least_) : 0.0; });
    sweep(face, mesh_.tet_slots() * 4,
          [&](std::uint32_t i) { return is_new(i / 4) ? try_face(mesh_, i / 4, i % 4, least_) : 0.0; });
}

double Optimiser::round()
{
    const double before = cost_;
    ++report_.rounds;
    sweeps_ = 0;
    since_ = mesh_.round++;
    const auto is_new = [&](std::uint32_t v) { return mesh_.is_free(v) && mesh_.vertex_changed(v) >= since_; };
    flip();
    flip();
    sweep(collapse, mesh_.vertex_slots(),
          [&](std::uint32_t v) { return is_new(v) ? collapse_.try_vertex(v, least_) : 0.0; });
    sweep(move, mesh_.vertex_slots(),
          [&](std::uint32_t v) { return is_new(v) ? try_move(mesh_, v, least_, star_) : 0.0; });
    if (effort_.inserts) insert_vertices();
    return before - cost_;
}

void Optimiser::insert_vertices()
{
    insertion_.since = since_;
    const auto is_new = [&](std::uint32_t tet) { return mesh_.is_reached(tet) && mesh_.tet_changed(tet) >= since_; };
    sweep(insertion, mesh_.tet_slots() * 6,
          [&](std::uint32_t i) { return is_new(i / 6) ? insertion_.try_edge(i / 6, i % 6, least_) : 0.0; });
}

} // namespace

OptimisedTets optimise(const TetMesh& mesh, const OptimiserLimits& limits, const Progress& progress)
{
    return Optimiser(mesh, limits, progress).run();
}

} // namespace tetrace
