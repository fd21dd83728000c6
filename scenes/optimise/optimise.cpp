#include "scenes/optimise/optimise.h"

#include "core/base/stopwatch.h"
#include "scenes/optimise/region_pass.h"
#include "scenes/optimise/regions.h"
#include "scenes/optimise/shape.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>

namespace tetrace {

namespace {

constexpr double highest_ratio = 0.95; // rounds come to an end
constexpr double min_share = 0.05;     // of a round, from which its time is predicted
constexpr double first_rounds = 6;     // as many as bunny has, before the first has ended

} // namespace

void Forecast::end_round(double elapsed_s, double gain)
{
    const double round_s = elapsed_s - begin_s_;
    if (last_s_ > 0) time_ratio_ = std::min(round_s / last_s_, highest_ratio);
    if (last_gain_ > 0) gain_ratio_ = std::min(gain / last_gain_, highest_ratio);
    begin_s_ = elapsed_s;
    last_s_ = round_s;
    last_gain_ = gain;
}

double Forecast::left_s(double elapsed_s, double share_of_round, double enough, std::uint32_t max_rounds) const
{
    const double in_round_s = elapsed_s - begin_s_;
    double round_s = last_s_ * time_ratio_; // of the current round
    if (last_s_ == 0 || in_round_s > round_s) round_s = in_round_s / std::max(share_of_round, min_share);
    double rounds = first_rounds; // after the current one
    if (last_gain_ > 0 && enough > 0)
        rounds = std::ceil(std::max(0.0, std::log(enough / last_gain_) / std::log(gain_ratio_) - 1));
    rounds = std::min(rounds, static_cast<double>(max_rounds));
    const double later_s = round_s * time_ratio_ * (1 - std::pow(time_ratio_, rounds)) / (1 - time_ratio_);
    return std::max(0.0, round_s - in_round_s) + later_s;
}

namespace {

// Rounds end when one lowers the cost by less than `share` of it. Vertices are inserted at edges whose faces have at
// least `min_ring` times the mean area of a free face.
struct Effort {
    std::uint32_t max_rounds;
    double share, min_ring;
};
constexpr std::array<Effort, max_effort + 1> efforts = {
    {{0, 1, impossible}, {2, 0.05, impossible}, {16, 0.003, impossible}, {40, 0.001, 0}}};
constexpr Effort effort_for_pieces = {16, 0.003, 8};

Effort effort_of(const OptimiserLimits& limits)
{
    const int effort = std::clamp(limits.effort, 0, max_effort);
    return limits.several_pieces && effort == 2 ? effort_for_pieces : efforts[static_cast<std::size_t>(effort)];
}

constexpr double negligible = 1e-12; // a gain, as a part of the boundary's area
constexpr std::size_t no_regions = std::numeric_limits<std::size_t>::max();
constexpr double share_of_regions = 0.7; // of a round's time; the rest is for what walls kept from being done

class Optimiser {
public:
    Optimiser(const TetMesh& mesh, const OptimiserLimits& limits, const Progress& progress)
        : limits_(limits), effort_(effort_of(limits)), progress_(progress), given_(mesh),
          mesh_(arrays_of(mesh, limits.closed_too)), per_area_(2 / boundary_area(mesh_)), least_(negligible / per_area_)
    {
        report_.operations = {{{"edges removed"}, {"faces removed"}, {"moves"}, {"collapses"}, {"insertions"}}};
        report_.cost_before = cost_ = free_area(mesh_) * per_area_;
    }

    [[nodiscard]] OptimisedTets run()
    {
        for (std::uint32_t i = 0; i < effort_.max_rounds && !ends_early(); ++i) {
            const double gain = round();
            if (gain < effort_.share * cost_) break;
            forecast_.end_round(watch_.seconds(), gain);
        }
        const bool changed = std::any_of(report_.operations.begin(), report_.operations.end(),
                                         [](const OperationCount& operation) { return operation.done > 0; });
        report_.cost_after = changed ? free_area(mesh_) * per_area_ : report_.cost_before;
        report_.seconds = watch_.seconds();
        return {changed ? mesh_of(mesh_) : given_, report_};
    }

private:
    double round();
    std::size_t pass(std::uint32_t since, std::size_t max_tets);
    void work_on(const Regions& regions, std::size_t index, Region& region, Regions::Scratch& scratch);
    void count(const std::array<OperationTally, operation_count>& tallies);
    [[nodiscard]] bool ends_early() const { return report_.end != OptimiserEnd::finished; }
    [[nodiscard]] bool go_on(double share_of_region);
    void tell(double share_of_round) const;
    [[nodiscard]] double mean_free_area() const;

    OptimiserLimits limits_;
    Effort effort_;
    const Progress& progress_;
    Stopwatch watch_;
    ProcessorStopwatch processor_;
    const TetMesh& given_;
    MeshArrays mesh_;
    double per_area_; ///< of a sum of areas, to the number of faces that a uniform line crosses
    double least_;
    OptimiserReport report_;
    double cost_ = 0;
    double min_ring_area_ = 0;           ///< of this round
    std::uint32_t mark_ = 1, since_ = 1; ///< of this pass: EditableMesh::round, and the first one that is new
    std::uint32_t round_began_ = 1;      ///< the first mark of the last round
    std::vector<std::array<OperationTally, operation_count>> tallies_; ///< of this pass, per region
    std::mutex looking_;                                               ///< for limits, progress, regions_done_
    std::size_t regions_done_ = 0;
    Forecast forecast_;
};

// Asked by all threads.
bool Optimiser::go_on(double share_of_region)
{
    const std::lock_guard lock(looking_);
    if (ends_early()) return false;
    if (limits_.time_limit_s > 0 && processor_.seconds() > limits_.time_limit_s)
        report_.end = OptimiserEnd::out_of_time;
    if (limits_.stop != nullptr && limits_.stop->load()) report_.end = OptimiserEnd::interrupted;
    const double share = (static_cast<double>(regions_done_) + share_of_region) / static_cast<double>(tallies_.size());
    const bool is_first = mark_ == round_began_;
    tell(is_first ? share_of_regions * share : share_of_regions + (1 - share_of_regions) * share);
    return !ends_early();
}

void Optimiser::tell(double share_of_round) const
{
    if (!progress_) return;
    double left_s =
        forecast_.left_s(watch_.seconds(), share_of_round, effort_.share * cost_, effort_.max_rounds - report_.rounds);
    if (limits_.time_limit_s > 0) left_s = std::min(left_s, std::max(0.0, limits_.time_limit_s - processor_.seconds()));
    progress_("optimising", watch_.seconds() / (watch_.seconds() + left_s),
              fmt::format("round {}: a line crosses {:.2f} faces, {:.2f} before", report_.rounds, cost_,
                          report_.cost_before));
}

void Optimiser::work_on(const Regions& regions, std::size_t index, Region& region, Regions::Scratch& scratch)
{
    region = regions.cut(index, since_, mark_ + 1, scratch);
    RegionPass pass(std::move(region.mesh),
                    {since_, mark_, least_, min_ring_area_, [this](double share) { return go_on(share); }});
    region.mesh = pass.run();
    tallies_[index] = pass.tallies();
    const std::lock_guard lock(looking_);
    ++regions_done_;
}

// In the order of the regions: floating-point sums depend on it.
void Optimiser::count(const std::array<OperationTally, operation_count>& tallies)
{
    for (std::size_t i = 0; i < operation_count; ++i) {
        report_.operations[i].done += tallies[i].done;
        report_.operations[i].gain += tallies[i].gain * per_area_;
        report_.operations[i].seconds += tallies[i].seconds;
        cost_ -= tallies[i].gain * per_area_;
    }
}

// Looks at what was marked with `since` or later. Returns the number of regions.
std::size_t Optimiser::pass(std::uint32_t since, std::size_t max_tets)
{
    since_ = since;
    ++mark_;
    const Regions regions(mesh_, report_.rounds, max_tets);
    std::vector<Region> parts(regions.size());
    tallies_.assign(parts.size(), {});
    regions_done_ = 0;
    std::exception_ptr failure;
    const int threads = limits_.threads > 0 ? limits_.threads : omp_get_max_threads();
#pragma omp parallel num_threads(std::clamp(static_cast <int>(parts.size()), 1, threads))
    {
        Regions::Scratch scratch;
#pragma omp for schedule(dynamic, 1)
        for (std::size_t i = 0; i < parts.size(); ++i) {
            try {
                work_on(regions, i, parts[i], scratch);
            } catch (...) { // none may leave a parallel region
                const std::lock_guard lock(looking_);
                failure = std::current_exception();
            }
        }
    }
    if (failure) std::rethrow_exception(failure);
    for (const auto& tallies : tallies_)
        count(tallies);
    Regions::join(mesh_, std::move(parts));
    return regions.size();
}

// A tet has about two free faces of its own.
double Optimiser::mean_free_area() const
{
    const auto reached = std::count(mesh_.states.begin(), mesh_.states.end(), TetState::reached);
    return cost_ / per_area_ / (2 * static_cast<double>(std::max<std::ptrdiff_t>(reached, 1)));
}

// All regions at once, then, in the whole mesh, what their walls kept from being looked at.
double Optimiser::round()
{
    const double before = cost_;
    min_ring_area_ = effort_.min_ring < impossible ? effort_.min_ring * mean_free_area() : impossible;
    ++report_.rounds;
    const std::uint32_t since = std::exchange(round_began_, mark_ + 1);
    const std::size_t regions = pass(since, limits_.tets_per_region);
    if (regions > 1 && !ends_early()) pass(++mark_, no_regions);
    return before - cost_;
}

} // namespace

OptimisedTets optimise(const TetMesh& mesh, const OptimiserLimits& limits, const Progress& progress)
{
    return Optimiser(mesh, limits, progress).run();
}

} // namespace tetrace
