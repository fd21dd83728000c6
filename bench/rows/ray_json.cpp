#include "bench/rows/ray_json.h"

namespace tetrace {

namespace {

using nlohmann::json;

Hit hit_from(const json& object)
{
    return {object.at("face_id"), object.at("tet"), object.at("t"), object.at("u"), object.at("v"), object.at("steps")};
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

WrongRay wrong_ray_from(const json& object)
{
    const json& exact = object.at("exact");
    return {object.at("view"),   object.at("x"), object.at("y"),     hit_from(object.at("ours")),
            exact.at("face_id"), exact.at("t"),  object.at("reason")};
}

DifferingRay differing_ray_from(const json& object)
{
    return {object.at("view"), object.at("x"), object.at("y"), hit_from(object.at("ours")),
            hit_from(object.at("openmp"))};
}

} // namespace tetrace
