#include "bench/rows/ray_json.h"

#include "bench/rows/answer_form.h"
#include "bench/rows/json_numbers.h"

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
    return answers_of(Task::trace).to_json(hit);
}

Hit hit_from(const json& object)
{
    return answers_of(Task::trace).from_json(object);
}

json wrong_ray_json(const WrongRay& ray)
{
    json object = {{"view", ray.view},
                   {"x", ray.x},
                   {"y", ray.y},
                   {"reason", ray.reason},
                   {"ours", answers_of(ray.task).to_json(ray.ours)}};
    if (traits_of(ray.task).finds_hits) object["exact"] = {{"face_id", ray.reference_face}, {"t", ray.reference_t}};
    return object;
}

json differing_ray_json(const DifferingRay& ray)
{
    return {{"view", ray.view},
            {"x", ray.x},
            {"y", ray.y},
            {"ours", answers_of(ray.task).to_json(ray.ours)},
            {"openmp", answers_of(ray.task).to_json(ray.openmp)}};
}

WrongRay wrong_ray_from(const json& object)
{
    WrongRay ray;
    ray.view = word_from(object.at("view"));
    ray.x = word_from(object.at("x"));
    ray.y = word_from(object.at("y"));
    ray.task = task_of(object.at("ours"));
    ray.ours = answers_of(ray.task).from_json(object["ours"]);
    if (traits_of(ray.task).finds_hits) {
        ray.reference_face = word_from(object.at("exact").at("face_id"));
        ray.reference_t = float_from(object["exact"].at("t"));
    }
    ray.reason = object.at("reason");
    return ray;
}

DifferingRay differing_ray_from(const json& object)
{
    const Task task = task_of(object.at("ours"));
    const AnswerForm& form = answers_of(task);
    return {word_from(object.at("view")),   word_from(object.at("x")),           word_from(object.at("y")),
            form.from_json(object["ours"]), form.from_json(object.at("openmp")), task};
}

} // namespace tetrace
