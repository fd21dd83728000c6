#include "bench/rows/ray_json.h"

#include "bench/rows/json_numbers.h"
#include "core/rays/segments.h"

namespace tetrace {

namespace {

using nlohmann::json;

std::uint32_t word_from(const json& value)
{
    return count_from<std::uint32_t>(value);
}

} // namespace

json hit_json(const Hit& hit)
{
    return {{"face_id", hit.face_id}, {"tet", hit.tet}, {"t", hit.t}, {"u", hit.u}, {"v", hit.v}, {"steps", hit.steps}};
}

Hit hit_from(const json& object)
{
    return {word_from(object.at("face_id")), word_from(object.at("tet")), float_from(object.at("t")),
            float_from(object.at("u")),      float_from(object.at("v")),  word_from(object.at("steps"))};
}

namespace {

json segments_json(const Segments& all)
{
    return {{"first", all.first}, {"last", all.last},         {"length", all.length},
            {"hash", all.hash},   {"reversed", all.reversed}, {"crossings", all.crossings}};
}

json answer_json(const Hit& answer, Task task)
{
    return task == Task::segments ? segments_json(segments_of(answer)) : hit_json(answer);
}

/// The answers of the two tasks have different keys.
Task task_of(const json& answer)
{
    return answer.contains("crossings") ? Task::segments : Task::trace;
}

Hit answer_from(const json& object)
{
    if (task_of(object) == Task::trace) return hit_from(object);
    return as_hit({word_from(object.at("first")), word_from(object.at("last")), word_from(object.at("length")),
                   word_from(object.at("hash")), word_from(object.at("reversed")), word_from(object.at("crossings"))});
}

} // namespace

json wrong_ray_json(const WrongRay& ray)
{
    json object = {{"view", ray.view},
                   {"x", ray.x},
                   {"y", ray.y},
                   {"reason", ray.reason},
                   {"ours", answer_json(ray.ours, ray.task)}};
    if (ray.task != Task::segments) object["exact"] = {{"face_id", ray.reference_face}, {"t", ray.reference_t}};
    return object;
}

json differing_ray_json(const DifferingRay& ray)
{
    return {{"view", ray.view},
            {"x", ray.x},
            {"y", ray.y},
            {"ours", answer_json(ray.ours, ray.task)},
            {"openmp", answer_json(ray.openmp, ray.task)}};
}

WrongRay wrong_ray_from(const json& object)
{
    WrongRay ray;
    ray.view = word_from(object.at("view"));
    ray.x = word_from(object.at("x"));
    ray.y = word_from(object.at("y"));
    ray.ours = answer_from(object.at("ours"));
    ray.task = task_of(object["ours"]);
    if (ray.task != Task::segments) {
        ray.reference_face = word_from(object.at("exact").at("face_id"));
        ray.reference_t = float_from(object["exact"].at("t"));
    }
    ray.reason = object.at("reason");
    return ray;
}

DifferingRay differing_ray_from(const json& object)
{
    return {word_from(object.at("view")),   word_from(object.at("x")),        word_from(object.at("y")),
            answer_from(object.at("ours")), answer_from(object.at("openmp")), task_of(object["ours"])};
}

} // namespace tetrace
