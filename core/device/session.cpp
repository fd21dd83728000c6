#include "core/device/session.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/device/launch.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

namespace tetrace {

namespace {

void check_guard(std::span<const std::uint32_t> guard, const char* where)
{
    const auto intact = [](std::uint32_t word) { return word == POISON; };
    if (std::ranges::all_of(guard, intact)) return;
    throw Error(ErrorKind::wrong_result,
                std::string("the kernel wrote ") + where + " its output: the guard words there are overwritten");
}

/// All words around the results of each job are guards.
void check_guards(std::span<const std::uint32_t> output, const OutputParts& parts)
{
    std::size_t begin = 0;
    for (std::size_t job = 0; job <= parts.count(); ++job) {
        const bool is_last = job == parts.count();
        const std::size_t end = is_last ? output.size() : parts.begin(job) + GUARD_WORDS;
        check_guard(output.subspan(begin, end - begin), job == 0  ? "before"
                                                        : is_last ? "after"
                                                                  : "between the jobs of");
        if (!is_last) begin = parts.begin(job) + parts.size(job) - GUARD_WORDS;
    }
}

TraceJob column_of(std::size_t rays)
{
    if (rays % TILE_WIDTH != 0)
        throw Error(ErrorKind::internal,
                    "a job of " + std::to_string(rays) + " rays, no multiple of " + std::to_string(TILE_WIDTH));
    TraceJob job;
    job.width = TILE_WIDTH;
    job.height = static_cast<std::uint32_t>(rays / TILE_WIDTH);
    return job;
}

} // namespace

CompiledCode Backend::compiled(std::size_t, const std::optional<KernelId>&, bool, const std::filesystem::path&) const
{
    throw Error(ErrorKind::unsupported, name() + " reports nothing of its code");
}

std::vector<std::uint32_t> Backend::run_defect(std::size_t, std::string_view, const DefectLaunch&)
{
    throw Error(ErrorKind::unsupported, name() + " runs no reduced kernels");
}

Backend* find_backend(std::string_view name, const std::vector<Backend*>& backends)
{
    const auto found = std::ranges::find_if(backends, [&](const Backend* one) { return one->name() == name; });
    return found == backends.end() ? nullptr : *found;
}

Backend& backend_named(std::string_view name, const std::vector<Backend*>& backends)
{
    Backend* const found = find_backend(name, backends);
    if (found == nullptr) throw Error(ErrorKind::internal, "unknown backend " + std::string(name));
    return *found;
}

std::uint32_t step_cap(std::uint64_t tets, const Device& device)
{
    const auto proved = static_cast<std::uint32_t>(tets + 1);
    return device.max_steps == 0 ? proved : std::min(proved, device.max_steps);
}

void start_in(TraceJob& job, const PackedScene& packed, const Scene& scene, std::uint32_t tet)
{
    job.start_tet = tet == NO_TET ? NO_TET : packed.packed_of_mesh.at(tet);
    job.start = {};
    if (tet == NO_TET || !is_compact(packed.layout)) return;
    for (std::size_t i = 0; i < 4; ++i)
        job.start.vertices[i] = packed.number_of_vertex.at(scene.tets.tets.at(tet).vertices[i]);
    job.start.neighbour = packed.last_neighbours.at(job.start_tet);
}

TraceJob given_job(std::size_t rays, std::uint32_t max_steps, bool any_hit)
{
    TraceJob job = column_of(rays);
    job.max_steps = max_steps;
    job.any_hit = any_hit;
    return job;
}

TraceJob search_job(std::size_t rays)
{
    return column_of(rays);
}

void Session::set_rays(std::span<const Quad>)
{
    throw Error(ErrorKind::internal, "rays are given to a session that makes its own");
}

void Session::launch(std::span<const TraceJob> jobs)
{
    const auto passes = [](const TraceJob& job) { return std::pair(job.passes, job.in_flight); };
    if (jobs.empty() || std::ranges::adjacent_find(jobs, std::ranges::not_equal_to(), passes) != jobs.end())
        throw Error(ErrorKind::internal, "a launch of no job, or of jobs with different passes or passes in flight");
    const std::uint32_t in_flight = jobs.front().in_flight;
    if (in_flight == 0 || in_flight > max_in_flight)
        throw Error(ErrorKind::internal, "a launch with " + std::to_string(in_flight) + " passes in flight");
    if (!tally_words_.empty() && jobs.size() != 1)
        throw Error(ErrorKind::internal, "a launch of several jobs, which would have a tally each");
    if (!tally_words_.empty() && in_flight != 1)
        throw Error(ErrorKind::unsupported, "several launches in flight: the sums of the tets are those of one");
    passes_ = jobs.front().passes;
    in_flight_ = in_flight;
    job_rays_.clear();
    for (std::uint32_t output = 0; output < in_flight; ++output)
        for (const TraceJob& job : jobs)
            job_rays_.push_back(job.rays());
    start(jobs);
}

std::size_t Session::written_rays() const
{
    const auto end = job_rays_.begin() + static_cast<std::ptrdiff_t>(written_parts());
    return std::accumulate(job_rays_.begin(), end, std::size_t{0});
}

/// The whole output is not kept in the session, because many sessions are open at a time.
template <class Result>
void Session::read_results(std::span<Result> results)
{
    static_assert(sizeof(Hit) == HIT_WORDS * sizeof(std::uint32_t));
    const OutputParts parts = output_parts(sizeof(Result) / sizeof(std::uint32_t));
    require_output_of_last_launch(results.size(), written_rays());
    std::vector<std::uint32_t> output(parts.words());
    const Stopwatch watch;
    read_output(output);
    download_s_ = watch.seconds();
    check_guards(output, parts);
    for (std::size_t job = 0; job < written_parts(); ++job) {
        const auto from = parts.results(std::span<const std::uint32_t>(output), job);
        std::memcpy(results.data(), from.data(), from.size_bytes());
        results = results.subspan(from.size_bytes() / sizeof(Result));
        std::ranges::copy(parts.tally(std::span<const std::uint32_t>(output), job), tally_words_.begin());
    }
}

void Session::make_tally(Task task, std::size_t tets)
{
    tally_words_.assign(traits_of(task).tallies ? 2 * tets : 0, POISON);
}

std::vector<std::uint64_t> Session::tally() const
{
    constexpr std::uint64_t zero = std::uint64_t{POISON} << 32 | POISON; // the output is filled with it
    std::vector<std::uint64_t> sums(tally_words_.size() / 2);
    for (std::size_t tet = 0; tet < sums.size(); ++tet) {
        const std::uint64_t sum = (std::uint64_t{tally_words_[2 * tet + 1]} << 32 | tally_words_[2 * tet]) - zero;
        if (sum % passes_ != 0)
            throw Error(ErrorKind::wrong_result, "the sum of tet " + std::to_string(tet) + ", " + std::to_string(sum) +
                                                     ", is not that of " + std::to_string(passes_) + " equal passes");
        sums[tet] = sum / passes_;
    }
    return sums;
}

void Session::read_back(std::span<Hit> hits)
{
    read_results(hits);
}

double Session::trace(std::span<const TraceJob> jobs, std::span<Hit> hits)
{
    launch(jobs);
    const double seconds = wait();
    read_back(hits);
    return seconds;
}

double Session::search(const TraceJob& job, std::span<std::uint32_t> faces)
{
    launch(job);
    const double seconds = wait();
    read_back(faces);
    return seconds;
}

void Session::read_back(std::span<std::uint32_t> faces)
{
    read_results(faces);
    const auto found = std::ranges::find_if(faces, [](std::uint32_t face) { return face > NO_EXIT; });
    if (found == faces.end()) return;
    throw Error(ErrorKind::wrong_result,
                "ray " + std::to_string(found - faces.begin()) +
                    (*found == POISON ? ": no face was written" : ": face " + std::to_string(*found) + " was written"));
}

void require_kernel(const Backend& backend, std::size_t device, const KernelId& kernel)
{
    if (const Device& wanted = backend.devices().at(device); !wanted.usable)
        throw Error(ErrorKind::missing, wanted.reason);
    if (const std::string reason = backend.why_not(device, kernel); !reason.empty())
        throw Error(ErrorKind::unsupported, reason);
}

const PackedScene& packed_scene(const Backend& backend, std::size_t device, const KernelId& kernel,
                                const SceneData& scene)
{
    require_kernel(backend, device, kernel);
    if (scene.packed == nullptr || scene.packed->layout != kernel.layout)
        throw Error(ErrorKind::internal, "opening " + backend.name() + ": the scene is not packed as " +
                                             std::string(name_of(kernel.layout)));
    return *scene.packed;
}

std::uint64_t max_buffer(const Device& device, const SessionOptions& options)
{
    if (device.max_buffer_bytes == 0 || options.max_buffer_bytes == 0)
        return device.max_buffer_bytes + options.max_buffer_bytes;
    return std::min(device.max_buffer_bytes, options.max_buffer_bytes);
}

unsigned tile_height_of(const SessionOptions& options)
{
    return options.tile_height != 0 ? options.tile_height : 8;
}

} // namespace tetrace
