#include "bench/rows/view_starts.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

ViewStarts locate_each(const Scene& scene, const std::vector<Float3>& origins)
{
    ViewStarts found;
    const Stopwatch watch;
    for (const Float3 origin : origins)
        found.starts.push_back(find_start(scene, origin));
    found.seconds = watch.seconds();
    return found;
}

} // namespace

ViewStarts find_starts(const Scene& scene, const std::vector<Float3>& origins)
{
    const ViewStarts exact = locate_each(scene, origins);
    if (scene.domain.kind != DomainKind::wide || scene.tets.tets.empty()) return exact;
    ViewStarts found;
    MovingStart camera(scene, usual_move_limit(scene.domain));
    const Stopwatch watch;
    for (const Float3 origin : origins)
        found.starts.push_back(camera.next(origin));
    found.seconds = watch.seconds();
    found.walk = StartWalk{camera.counts(), exact.seconds};
    for (std::size_t view = 0; view < origins.size(); ++view)
        if (found.starts[view] != exact.starts[view])
            throw Error(ErrorKind::internal, fmt::format("walking to the camera of view {} ends in tet {}, where exact "
                                                         "location finds tet {}",
                                                         view, found.starts[view].tet, exact.starts[view].tet));
    return found;
}

} // namespace tetrace
