#include "bench/rows/ray_json.h"

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
    return {{"face_id", hit.face_id}, {"tet", hit.tet}, {"t", hit.t}, {"u", hit.u}, {"v", hit.v}, {"steps", hit.steps}};
}

json wrong_ray_json(const WrongRay& ray)
{
    return {{"view", ray.view},
            {"x", ray.x},
            {"y", ray.y},
            {"reason", ray.reason},
            {"ours", hit_json(ray.ours)},
            {"exact", {{"face_id", ray.reference_face}, {"t", ray.reference_t}}}};
}

json differing_ray_json(const DifferingRay& ray)
{
    return {
        {"view", ray.view}, {"x", ray.x}, {"y", ray.y}, {"ours", hit_json(ray.ours)}, {"openmp", hit_json(ray.openmp)}};
}

Hit hit_from(const json& object)
{
    return {word_from(object.at("face_id")), word_from(object.at("tet")), float_from(object.at("t")),
            float_from(object.at("u")),      float_from(object.at("v")),  word_from(object.at("steps"))};
}

WrongRay wrong_ray_from(const json& object)
{
    const json& exact = object.at("exact");
    return {word_from(object.at("view")), word_from(object.at("x")),      word_from(object.at("y")),
            hit_from(object.at("ours")),  word_from(exact.at("face_id")), float_from(exact.at("t")),
            object.at("reason")};
}

DifferingRay differing_ray_from(const json& object)
{
    return {word_from(object.at("view")), word_from(object.at("x")), word_from(object.at("y")),
            hit_from(object.at("ours")), hit_from(object.at("openmp"))};
}

} // namespace tetrace
