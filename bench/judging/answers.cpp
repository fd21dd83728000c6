#include "bench/judging/answers.h"

#include "bench/truth/hit_point.h"
#include "core/base/error.h"

#include <omp.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <fmt/format.h>

namespace tetrace {

namespace {

// By how much t, u and v of a triangle may be wrong; infinite where rounding may lose its determinant.
HitPoint allowed_point(const AnswerCase& against, const MeshRay& ray, std::uint32_t triangle)
{
    HitPoint point = point_of(against.mesh, ray.origin, ray.direction, triangle, against.tolerance.unit_roundoff);
    for (double* const error : {&point.t_error, &point.u_error, &point.v_error})
        *error *= against.tolerance.slack;
    return point;
}

bool is_close(double value, double exact, double error)
{
    return std::abs(value - exact) <= error; // false for NaN
}

double lost_share(const AnswerCase& against)
{
    return 8 * against.tolerance.slack * against.tolerance.unit_roundoff;
}

// Of a triangle whose determinant rounding may lose: how far apart a point of it and the ray's at t may be.
double allowed_distance(const AnswerCase& against, const MeshRay& ray, std::uint32_t triangle, double t)
{
    double size = length(ray.origin) + std::abs(t) * length(ray.direction);
    for (const std::uint32_t vertex : against.mesh.triangles[triangle])
        size += length(to_double(against.mesh.vertices[vertex]));
    return lost_share(against) * size;
}

// Of a triangle whose determinant rounding may lose: t names the point of the triangle that u and v name.
bool names_its_point(const AnswerCase& against, const MeshRay& ray, std::uint32_t triangle, const MeshAnswer& answer)
{
    const auto& [i, j, k] = against.mesh.triangles[triangle];
    const Double3 a = to_double(against.mesh.vertices[i]), b = to_double(against.mesh.vertices[j]),
                  c = to_double(against.mesh.vertices[k]);
    const double share = lost_share(against);
    const Double3 on_ray = ray.origin + ray.direction * answer.t;
    const Double3 on_triangle = a + (b - a) * answer.u + (c - a) * answer.v;
    return std::isfinite(answer.t) && answer.u >= -share && answer.v >= -share && answer.u + answer.v <= 1 + share &&
           length(on_ray - on_triangle) <= allowed_distance(against, ray, triangle, answer.t);
}

std::string flaw_of_number(const char* name, double value, double exact, double error)
{
    return is_close(value, exact, error) ? ""
                                         : fmt::format("its {} is {:.9g}; the exact one is {:.17g}, and may be off by "
                                                       "{:.2g}",
                                                       name, value, exact, error);
}

// Of an answer whose plane the ray runs in: only t is judged, where the ray meets another triangle. Empty: it is right.
std::string flaw_of_t(const AnswerCase& against, const MeshRay& ray, const MeshAnswer& answer, std::uint32_t met)
{
    const double exact = against.search.point_of(ray, met).t;
    const HitPoint allowed = allowed_point(against, ray, met);
    const double error =
        std::isfinite(allowed.t) ? allowed.t_error : allowed_distance(against, ray, met, exact) / length(ray.direction);
    return flaw_of_number("t", answer.t, exact, error);
}

// Empty: t, u and v are right.
std::string flaw_of_point(const AnswerCase& against, const MeshRay& ray, const MeshAnswer& answer)
{
    const auto triangle = static_cast<std::uint32_t>(answer.face);
    const HitPoint allowed = allowed_point(against, ray, triangle);
    if (!std::isfinite(allowed.t))
        return names_its_point(against, ray, triangle, answer)
                   ? ""
                   : "the ray sees its triangle nearly edge-on, and its t, u and v do not name one point of it";
    const PlanePoint exact = against.search.point_of(ray, triangle);
    if (std::string flaw = flaw_of_number("t", answer.t, exact.t, allowed.t_error); !flaw.empty()) return flaw;
    if (std::string flaw = flaw_of_number("u", answer.u, exact.u, allowed.u_error); !flaw.empty()) return flaw;
    return flaw_of_number("v", answer.v, exact.v, allowed.v_error);
}

// From the origin to the points from a to b.
double distance_to_segment(Double3 a, Double3 b)
{
    const Double3 along = b - a;
    const double square = dot(along, along);
    const double share = square > 0 ? std::clamp(-dot(a, along) / square, 0.0, 1.0) : 0;
    return length(a + along * share);
}

// passes_edge() of a triangle whose determinant rounding may lose.
bool passes_edge_of_lost(const AnswerCase& against, const MeshRay& ray, std::uint32_t triangle)
{
    const double speed = length(ray.direction);
    const Double3 along = ray.direction * (1 / speed);
    std::array<Double3, 3> beside; // the corners, as the ray sees them
    std::array<double, 3> t;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 corner = to_double(against.mesh.vertices[against.mesh.triangles[triangle].at(i)]) - ray.origin;
        beside.at(i) = cross(corner, along);
        t.at(i) = dot(corner, along) / speed;
    }
    const auto [first, last] = std::ranges::minmax(t);
    const double allowed = allowed_distance(against, ray, triangle, std::max(std::abs(first), std::abs(last)));
    if (last < ray.t_min - allowed / speed || first > ray.t_max + allowed / speed) return false;
    return distance_to_segment(beside[0], beside[1]) <= allowed ||
           distance_to_segment(beside[1], beside[2]) <= allowed || distance_to_segment(beside[2], beside[0]) <= allowed;
}

// Whether the ray passes an edge of the triangle as near as u and v may be wrong.
bool passes_edge(const AnswerCase& against, const MeshRay& ray, std::uint32_t triangle)
{
    const HitPoint point = allowed_point(against, ray, triangle);
    if (!std::isfinite(point.t)) return passes_edge_of_lost(against, ray, triangle);
    if (point.t < ray.t_min - point.t_error || point.t > ray.t_max + point.t_error) return false;
    const double w = 1 - point.u - point.v, w_error = point.u_error + point.v_error;
    const bool is_beside = point.u < -point.u_error || point.v < -point.v_error || w < -w_error;
    return !is_beside && (point.u <= point.u_error || point.v <= point.v_error || w <= w_error);
}

void set_fault(JudgedAnswer& judged, AnswerVerdict verdict, std::string reason)
{
    judged.verdict = verdict;
    judged.reason = std::move(reason);
}

bool names_triangle(const AnswerCase& against, const MeshAnswer& answer)
{
    return answer.face >= 0 && answer.face < static_cast<double>(against.mesh.triangles.size());
}

// Of a ray that meets a triangle, and an answer that names one.
void judge_triangle(const AnswerCase& against, const MeshRay& ray, const MeshAnswer& answer, JudgedAnswer& judged)
{
    const auto face = static_cast<std::uint32_t>(answer.face);
    const std::uint32_t met = judged.nearest.front();
    const bool is_met = std::ranges::binary_search(judged.nearest, face);
    if (!is_met && !against.search.holds_point_of(ray, face, met))
        set_fault(judged, AnswerVerdict::wrong, "another triangle is nearer, or the ray does not meet this one");
    else if (std::string flaw = is_met ? flaw_of_point(against, ray, answer) : flaw_of_t(against, ray, answer, met);
             !flaw.empty())
        set_fault(judged, AnswerVerdict::inaccurate, std::move(flaw));
    else if (!is_met || judged.nearest.size() > 1)
        judged.verdict = AnswerVerdict::tie;
}

} // namespace

JudgedAnswer judge_answer(const AnswerCase& against, const MeshRay& ray, const MeshAnswer& answer)
{
    JudgedAnswer judged{AnswerVerdict::right, against.search.nearest(ray), false, {}};
    const bool is_hit = !judged.nearest.empty(), names_one = names_triangle(against, answer);
    if (answer.face == -1) {
        if (is_hit) set_fault(judged, AnswerVerdict::missed, "the ray meets a triangle");
    } else if (!names_one)
        set_fault(judged, AnswerVerdict::wrong,
                  fmt::format("the mesh has triangles 0 to {}; -1 is a miss", against.mesh.triangles.size() - 1));
    else if (!is_hit)
        set_fault(judged, AnswerVerdict::invented, "the ray meets no triangle");
    else
        judge_triangle(against, ray, answer, judged);
    if (is_fault(judged.verdict) && judged.verdict != AnswerVerdict::inaccurate)
        judged.is_near_edge = (is_hit && passes_edge(against, ray, judged.nearest.front())) ||
                              (names_one && passes_edge(against, ray, static_cast<std::uint32_t>(answer.face)));
    return judged;
}

std::uint64_t AnswerCounts::faults() const
{
    std::uint64_t sum = 0;
    for (const AnswerVerdict verdict : values_of<AnswerVerdict>())
        if (is_fault(verdict)) sum += count(verdict);
    return sum;
}

const FaultyRay* AnswerCounts::first_fault() const
{
    const FaultyRay* least = nullptr;
    for (const auto& fault : first)
        if (fault && (least == nullptr || fault->number < least->number)) least = &*fault;
    return least;
}

void AnswerCounts::add(AnswerCounts other)
{
    near_edge += other.near_edge;
    for (std::size_t i = 0; i < answer_verdicts; ++i) {
        of.at(i) += other.of.at(i);
        auto& mine = first.at(i);
        auto& its = other.first.at(i);
        if (its && (!mine || its->number < mine->number)) mine = std::move(its);
    }
}

namespace {

[[noreturn]] void refuse_row(const std::filesystem::path& path, std::size_t row, const std::string& problem,
                             const char* remedy)
{
    throw Error(ErrorKind::invalid_input,
                fmt::format("reading {}: row {} (counted from 0): {}; {}", path.string(), row, problem, remedy));
}

constexpr const char* ray_columns[] = {"origin x",    "origin y",    "origin z",    "t_min",
                                       "direction x", "direction y", "direction z", "t_max"};

} // namespace

std::vector<MeshRay> mesh_rays_of(const NpyArray& array, const std::filesystem::path& path)
{
    std::vector<MeshRay> rays(array.rows);
    for (std::size_t i = 0; i < array.rows; ++i) {
        const auto row = array.row(i);
        for (std::size_t c = 0; c < 8; ++c) {
            const double size = std::abs(row[c]);
            if (c == 3 || c == 7) { // only compared
                if (std::isnan(row[c]) || (std::isinf(row[c]) && (c == 3 || row[c] < 0)))
                    refuse_row(path, i, fmt::format("{} is {:g}", ray_columns[c], row[c]),
                               "t_min is finite, and t_max may be infinite");
            } else if (row[c] != 0 && !(size >= min_magnitude && size <= max_magnitude)) {
                refuse_row(path, i, fmt::format("{} is {:g}", ray_columns[c], row[c]),
                           "numbers are 0 or of a size from 2^-160 to 2^126");
            }
        }
        rays[i] = {{row[0], row[1], row[2]}, {row[4], row[5], row[6]}, row[3], row[7]};
        if (rays[i].direction == Double3{}) refuse_row(path, i, "the direction is 0", "give it a length");
        if (rays[i].t_max < rays[i].t_min)
            refuse_row(path, i, "t_max is below t_min",
                       "the columns are origin (3), "
                       "t_min, direction (3), t_max");
    }
    return rays;
}

std::vector<MeshAnswer> mesh_answers_of(const NpyArray& array, const std::filesystem::path& path)
{
    std::vector<MeshAnswer> answers(array.rows);
    for (std::size_t i = 0; i < array.rows; ++i) {
        const auto row = array.row(i);
        if (!(std::trunc(row[0]) == row[0]))
            refuse_row(path, i, fmt::format("the face is {:g}", row[0]),
                       "the columns are face, t, u, v; a face is a whole number, and -1 a miss");
        answers[i] = {row[0], row[1], row[2], row[3]};
    }
    return answers;
}

namespace {

/// Calls work(first, last) for blocks of [0, count) on that many threads, some blocks at a time, with progress between.
template <class Work>
void in_blocks(std::size_t count, unsigned threads, const JudgingProgress& progress, const Work& work)
{
    constexpr std::size_t block = 256, blocks_at_once = 64;
    const int used = threads != 0 ? static_cast<int>(threads) : omp_get_max_threads();
    std::exception_ptr thrown;
    for (std::size_t done = 0; done < count; done += block * blocks_at_once) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(count));
        const std::size_t blocks = std::min(blocks_at_once, (count - done + block - 1) / block);
#pragma omp parallel for schedule(dynamic, 1) num_threads(used)
        for (std::size_t i = 0; i < blocks; ++i) {
            try {
                const std::size_t begin = done + i * block;
                work(begin, std::min(begin + block, count));
            } catch (...) {
#pragma omp critical(tetrace_answers)
                thrown = std::current_exception();
            }
        }
        if (thrown != nullptr) std::rethrow_exception(thrown);
    }
}

FaultyRay faulty_ray(const AnswerCase& against, std::uint64_t number, const MeshRay& ray, const MeshAnswer& answer,
                     const JudgedAnswer& judged)
{
    FaultyRay faulty{number, ray, answer, judged, std::nullopt, std::nullopt};
    if (!judged.nearest.empty()) faulty.met = against.search.point_of(ray, judged.nearest.front());
    if (names_triangle(against, answer) && !against.search.sees_edge_on(ray, static_cast<std::uint32_t>(answer.face)))
        faulty.named = against.search.point_of(ray, static_cast<std::uint32_t>(answer.face));
    return faulty;
}

} // namespace

AnswerCounts judge_answers(const AnswerCase& against, const std::vector<MeshRay>& rays,
                           const std::vector<MeshAnswer>& answers, unsigned threads, const JudgingProgress& progress)
{
    assert(rays.size() == answers.size());
    AnswerCounts all;
    in_blocks(rays.size(), threads, progress, [&](std::size_t begin, std::size_t end) {
        AnswerCounts counts;
        for (std::size_t i = begin; i < end; ++i) {
            const JudgedAnswer judged = judge_answer(against, rays[i], answers[i]);
            const auto kind = static_cast<std::size_t>(judged.verdict);
            ++counts.of.at(kind);
            counts.near_edge += judged.is_near_edge ? 1 : 0;
            if (is_fault(judged.verdict) && !counts.first.at(kind))
                counts.first.at(kind) = faulty_ray(against, i, rays[i], answers[i], judged);
        }
#pragma omp critical(tetrace_answer_counts)
        all.add(std::move(counts));
    });
    return all;
}

std::vector<float> right_answers(const NearestSearch& search, const std::vector<MeshRay>& rays, unsigned threads,
                                 const JudgingProgress& progress)
{
    std::vector<float> answers(4 * rays.size());
    in_blocks(rays.size(), threads, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto nearest = search.nearest(rays[i]);
            const PlanePoint point = nearest.empty() ? PlanePoint{} : search.point_of(rays[i], nearest.front());
            answers[4 * i] = nearest.empty() ? -1.0f : static_cast<float>(nearest.front());
            answers[4 * i + 1] = static_cast<float>(point.t);
            answers[4 * i + 2] = static_cast<float>(point.u);
            answers[4 * i + 3] = static_cast<float>(point.v);
        }
    });
    return answers;
}

} // namespace tetrace
