#include "bench/judging/judged_report.h"

#include "bench/output/junit.h"
#include "bench/terminal/text.h"
#include "core/base/hash.h"
#include "core/mesh/scene.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

const char* meaning_of(AnswerVerdict verdict)
{
    switch (verdict) {
    case AnswerVerdict::right: return "the nearest triangle, or a miss where there is none";
    case AnswerVerdict::tie: return "another triangle is exactly as near";
    case AnswerVerdict::inaccurate: return "the nearest triangle; t, u or v is not of the point";
    case AnswerVerdict::wrong: return "not the nearest triangle";
    case AnswerVerdict::missed: return "a miss, and the ray meets a triangle";
    case AnswerVerdict::invented: return "a triangle, and the ray meets none";
    }
    return "";
}

const char* precision_name(bool is_double)
{
    return is_double ? "float64" : "float32";
}

/// Digits that name the number exactly.
std::string numbers_text(std::initializer_list<double> numbers)
{
    return fmt::format("{:.17g}", fmt::join(numbers, ", "));
}

std::string vector_text(Double3 a)
{
    return "(" + numbers_text({a.x, a.y, a.z}) + ")";
}

std::string point_text(const PlanePoint& point)
{
    return fmt::format("t {:.17g}, u {:.17g}, v {:.17g}", point.t, point.u, point.v);
}

Table verdict_table(const JudgedRun& run)
{
    Table table({{"verdict", "Verdict"}, {"rays", "Rays"}, {"share", "Share", "%", 4}, {"meaning", "Meaning"}});
    for (const AnswerVerdict verdict : values_of<AnswerVerdict>()) {
        const std::uint64_t count = run.counts.count(verdict);
        const double share = run.rays > 0 ? 100 * static_cast<double>(count) / static_cast<double>(run.rays) : 0;
        table.add({std::string(name_of(verdict)), count, share, std::string(meaning_of(verdict))});
    }
    return table;
}

/// How many triangles that are exactly as near are listed at most.
constexpr std::size_t max_listed = 8;

std::string nearest_text(const FaultyRay& fault)
{
    const auto& nearest = fault.judged.nearest;
    if (nearest.empty()) return "no triangle";
    const std::size_t shown = std::min(nearest.size(), max_listed);
    std::string text =
        fmt::format("{} {}", nearest.size() == 1 ? "triangle" : "triangles",
                    fmt::join(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    if (shown < nearest.size()) text += fmt::format(" and {} more", nearest.size() - shown);
    return text + ", " + point_text(*fault.met);
}

void add_fault(Sheet& sheet, const FaultyRay& fault)
{
    const MeshRay& ray = fault.ray;
    sheet.gap();
    sheet.heading(fmt::format("First fault: ray {} is {}", fault.number, name_of(fault.judged.verdict)));
    sheet.labelled("Reason", fault.judged.reason);
    sheet.labelled("Origin", vector_text(ray.origin));
    sheet.labelled("Direction", vector_text(ray.direction));
    sheet.labelled("Range", fmt::format("t from {:.17g} to {:.17g}", ray.t_min, ray.t_max));
    sheet.labelled("Answer", fault.answer.face == -1
                                 ? "a miss"
                                 : fmt::format("triangle {:.17g}, t {:.17g}, u {:.17g}, v {:.17g}", fault.answer.face,
                                               fault.answer.t, fault.answer.u, fault.answer.v));
    sheet.labelled("Exact", nearest_text(fault));
    if (fault.named)
        sheet.labelled("Its plane", "the ray meets the plane of the answer's triangle at " + point_text(*fault.named));
    if (fault.judged.is_near_edge) sheet.labelled("Edge", "the ray passes an edge as near as rounding may decide");
}

nlohmann::json point_json(const PlanePoint& point)
{
    return {{"t", point.t}, {"u", point.u}, {"v", point.v}};
}

nlohmann::json vector_json(Double3 a)
{
    return nlohmann::json::array({a.x, a.y, a.z});
}

/// JSON has neither infinity nor NaN: these numbers are left out, and without a t_max the ray has no end.
nlohmann::json fault_json(const FaultyRay& fault)
{
    nlohmann::json json = {{"ray", fault.number},
                           {"verdict", name_of(fault.judged.verdict)},
                           {"reason", fault.judged.reason},
                           {"near_edge", fault.judged.is_near_edge},
                           {"origin", vector_json(fault.ray.origin)},
                           {"direction", vector_json(fault.ray.direction)},
                           {"t_min", fault.ray.t_min},
                           {"nearest", fault.judged.nearest}};
    if (std::isfinite(fault.ray.t_max)) json["t_max"] = fault.ray.t_max;
    const MeshAnswer& answer = fault.answer;
    const std::pair<const char*, double> numbers[] = {
        {"face", answer.face}, {"t", answer.t}, {"u", answer.u}, {"v", answer.v}};
    for (const auto& [key, number] : numbers)
        if (std::isfinite(number)) json["answer"][key] = number;
    if (fault.met) json["exact"] = point_json(*fault.met);
    if (fault.named) json["plane_of_answer"] = point_json(*fault.named);
    return json;
}

nlohmann::json judged_json(const JudgedRun& run, const Options& options)
{
    nlohmann::json judged = {{"mesh", run.mesh},
                             {"vertices", run.vertices},
                             {"triangles", run.triangles},
                             {"mesh_hash", hash_text(run.mesh_hash)},
                             {"rays", run.rays},
                             {"ray_type", precision_name(run.rays_are_double)},
                             {"hit_type", precision_name(run.hits_are_double)},
                             {"slack", run.tolerance.slack},
                             {"faults", run.counts.faults()},
                             {"near_edge", run.counts.near_edge},
                             {"judging_s", run.seconds},
                             {"first_faults", nlohmann::json::array()}};
    for (const AnswerVerdict verdict : values_of<AnswerVerdict>())
        judged["verdicts"][std::string(name_of(verdict))] = run.counts.count(verdict);
    for (const auto& fault : run.counts.first)
        if (fault) judged["first_faults"].push_back(fault_json(*fault));
    nlohmann::json section = result_head(options);
    section["judged"] = std::move(judged);
    return {{"tetrace", std::move(section)}};
}

} // namespace

void note_mesh(JudgedRun& run, const std::string& name, const TriangleMesh& mesh)
{
    run.mesh = name;
    run.vertices = mesh.vertices.size();
    run.triangles = mesh.triangles.size();
    run.mesh_hash = mesh_hash(mesh);
}

Report judged_report(const JudgedRun& run, const Options& options)
{
    Report report{{}, verdict_table(run), judged_json(run, options)};
    Sheet& sheet = report.sheet;
    sheet.line(fmt::format("{}, {}, by exact arithmetic on {} ({}; rays {}, answers {})",
                           counted(run.rays, "ray", "rays"), seconds_text(run.seconds), run.mesh,
                           counted(run.triangles, "triangle", "triangles"), precision_name(run.rays_are_double),
                           precision_name(run.hits_are_double)));
    sheet.gap();
    sheet.table(report.table);
    if (const FaultyRay* fault = run.counts.first_fault()) add_fault(sheet, *fault);
    sheet.gap();
    const std::uint64_t faults = run.counts.faults();
    sheet.line(faults == 0
                   ? "All answers are right."
                   : fmt::format("{} of {} answers are faults; {} of them pass an edge as near as rounding may "
                                 "decide.",
                                 with_commas(faults), with_commas(run.rays), with_commas(run.counts.near_edge)));
    if (options.out) sheet.labelled("Result", options.out->string());
    if (options.junit && *options.junit != "-") sheet.labelled("JUnit", options.junit->string());
    report.markdown = sheet.markdown();
    return report;
}

std::string judged_junit(const JudgedRun& run)
{
    std::vector<JunitCase> cases;
    for (const AnswerVerdict verdict : values_of<AnswerVerdict>()) {
        if (!is_fault(verdict)) continue;
        JunitCase test;
        test.backend = "judge";
        test.name = fmt::format("no ray is {}", name_of(verdict));
        const auto& fault = run.counts.first.at(static_cast<std::size_t>(verdict));
        if (fault) {
            test.outcome = CaseOutcome::failed;
            test.reason = fmt::format("{} of {} rays; the first is ray {}: {}", run.counts.count(verdict), run.rays,
                                      fault->number, fault->judged.reason);
        }
        cases.push_back(test);
    }
    return junit_suite(run.mesh, cases, {}, "judge");
}

std::string judged_junit_of(const std::string& problem)
{
    return junit_suite({}, {}, problem, "judge");
}

} // namespace tetrace
