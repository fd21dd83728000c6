#include "bench/rows/answer_form.h"

#include "bench/rows/json_numbers.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"
#include "core/rays/absorbed.h"
#include "core/rays/segments.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tetrace {

namespace {

using nlohmann::json;

std::uint32_t word_at(const json& object, const char* key)
{
    return count_from<std::uint32_t>(object.at(key));
}

json json_of_hit(const Hit& hit)
{
    return {{"face_id", hit.face_id}, {"tet", hit.tet}, {"t", hit.t}, {"u", hit.u}, {"v", hit.v}, {"steps", hit.steps}};
}

Hit hit_of_json(const json& object)
{
    return {word_at(object, "face_id"), word_at(object, "tet"),     float_from(object.at("t")),
            float_from(object.at("u")), float_from(object.at("v")), word_at(object, "steps")};
}

std::string text_of_hit(const Hit& hit)
{
    const std::string tet = hit.tet == NO_TET ? "no tet" : fmt::format("tet {}", hit.tet);
    return fmt::format("{}, t {:.9g}, u {:.9g}, v {:.9g}, {}, {} steps", face_text(hit.face_id), hit.t, hit.u, hit.v,
                       tet, hit.steps);
}

std::string no_mean(std::string_view /*rays*/, const RayTotals& /*totals*/)
{
    return {};
}

json json_of_segments(const Hit& answer)
{
    const Segments all = segments_of(answer);
    return {{"first", all.first}, {"last", all.last},         {"length", all.length},
            {"hash", all.hash},   {"reversed", all.reversed}, {"crossings", all.crossings}};
}

Hit segments_of_json(const json& object)
{
    return as_hit(Segments{word_at(object, "first"), word_at(object, "last"), word_at(object, "length"),
                           word_at(object, "hash"), word_at(object, "reversed"), word_at(object, "crossings")});
}

std::string text_of_segments(const Hit& answer)
{
    const Segments all = segments_of(answer);
    if (all.first == NO_HIT) return "no tet";
    return fmt::format("{} crossings, {} to tet {}, hash {:08x}, length {:.9g}, {} reversed", all.crossings,
                       all.first == LOST ? "lost" : fmt::format("tet {}", all.first), all.last, all.hash,
                       length_of(all.length), all.reversed);
}

std::string mean_of_segments(std::string_view rays, const RayTotals& totals)
{
    if (totals.hits == 0) return {};
    const auto crossing = static_cast<double>(totals.hits);
    return fmt::format("{} rays that cross the domain: {:.2f} tets and a length of {:.4f} per ray; {} of {} faces out "
                       "of order within rounding\n",
                       rays, static_cast<double>(totals.hit_steps) / crossing,
                       length_of(totals.length_units) / crossing, with_commas(totals.reversed),
                       with_commas(totals.hit_steps));
}

json json_of_absorbed(const Hit& answer)
{
    const Absorbed all = absorbed_of(answer);
    return {{"first", all.first}, {"last", all.last},      {"light", all.light},
            {"hash", all.hash},   {"tets", all.crossings}, {"transmittance", all.transmittance}};
}

Hit absorbed_of_json(const json& object)
{
    return as_hit(Absorbed{word_at(object, "first"), word_at(object, "last"), word_at(object, "light"),
                           word_at(object, "hash"), word_at(object, "transmittance"), word_at(object, "tets")});
}

std::string text_of_absorbed(const Hit& answer)
{
    const Absorbed all = absorbed_of(answer);
    if (all.first == NO_HIT) return "no tet";
    return fmt::format("{} tets, {} to tet {}, hash {:08x}, light {:.9g}, {:.9g} passes", all.crossings,
                       all.first == LOST ? "lost" : fmt::format("tet {}", all.first), all.last, all.hash,
                       share_of_light(all.light), share_passed(all.transmittance));
}

std::string mean_of_absorbed(std::string_view rays, const RayTotals& totals)
{
    if (totals.hits == 0) return {};
    const auto crossing = static_cast<double>(totals.hits);
    return fmt::format("{} rays that cross the domain: {:.2f} tets and a light of {:.4f} per ray; {} of {} absorbed "
                       "before they leave it\n",
                       rays, static_cast<double>(totals.hit_steps) / crossing,
                       share_of_light(totals.light_units) / crossing, with_commas(totals.absorbed),
                       with_commas(totals.hits));
}

} // namespace

const AnswerForm& answers_of(Task task)
{
    static const AnswerForm hits{count_rays, json_of_hit, hit_of_json, "face_id", text_of_hit, no_mean};
    static const AnswerForm segments{count_segments, json_of_segments, segments_of_json,
                                     "crossings",    text_of_segments, mean_of_segments};
    static const AnswerForm absorbed{count_absorbed, json_of_absorbed, absorbed_of_json,
                                     "light",        text_of_absorbed, mean_of_absorbed};
    const TaskTraits& traits = traits_of(task);
    if (traits.finds_hits) return hits;
    if (traits.absorbs) return absorbed;
    if (traits.crosses) return segments; // a tally's sums have no form: they are judged as they are
    throw Error(ErrorKind::internal, "answers_of: exit searches find faces");
}

Task task_of(const json& answer)
{
    for (const Task task : values_of<Task>())
        if (task != Task::search && answer.contains(answers_of(task).key)) return task;
    throw std::domain_error("the answer of a ray has the keys of no task");
}

std::string face_text(std::uint32_t face)
{
    if (face == NO_HIT) return "no hit";
    if (face == LOST) return "lost";
    return fmt::format("triangle {}", face);
}

} // namespace tetrace
