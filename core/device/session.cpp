#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/device/backend.h"

#include <algorithm>
#include <cstring>

namespace tetrace {

namespace {

void check_guard(std::span<const std::uint32_t> guard, const char* where)
{
    const auto intact = [](std::uint32_t word) { return word == POISON; };
    if (std::ranges::all_of(guard, intact)) return;
    throw Error(ErrorKind::wrong_result,
                std::string("the kernel wrote ") + where + " its output: the guard words there are overwritten");
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

std::uint32_t step_cap(std::uint64_t tets, const Device& device)
{
    const auto proved = static_cast<std::uint32_t>(tets + 1);
    return device.most_steps == 0 ? proved : std::min(proved, device.most_steps);
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

/// Not kept in the session, because many sessions are open at a time.
std::vector<std::uint32_t> Session::checked_output(std::size_t words)
{
    std::vector<std::uint32_t> output(2 * std::size_t{GUARD_WORDS} + words);
    const Stopwatch watch;
    read_output(output);
    download_s_ = watch.seconds();
    const std::span<const std::uint32_t> all = output;
    check_guard(all.first(GUARD_WORDS), "before");
    check_guard(all.last(GUARD_WORDS), "behind");
    return output;
}

void Session::read_back(std::span<Hit> hits)
{
    static_assert(sizeof(Hit) == HIT_WORDS * sizeof(std::uint32_t));
    const auto output = checked_output(HIT_WORDS * hits.size());
    std::memcpy(hits.data(), output.data() + GUARD_WORDS, hits.size_bytes());
}

double Session::trace(const TraceJob& job, std::span<Hit> hits)
{
    launch(job);
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
    const auto output = checked_output(faces.size());
    std::copy_n(output.begin() + GUARD_WORDS, faces.size(), faces.begin());
    const auto found = std::ranges::find_if(faces, [](std::uint32_t face) { return face > NO_EXIT; });
    if (found == faces.end()) return;
    throw Error(ErrorKind::wrong_result,
                "ray " + std::to_string(found - faces.begin()) +
                    (*found == POISON ? ": no face was written" : ": face " + std::to_string(*found) + " was written"));
}

} // namespace tetrace
