#pragma once

#include "core/rays/ray_set.h"

namespace tetrace {

/// Puts the rays of a set into another order, the same on every machine. Precondition: the set is as make_rays()
/// returned it, in the order of the tiles.
/// - morton: along the Morton curve through 64^3 cells of the origins' bounding box, rays of a cell along the Morton
/// curve through 16^3
/// cells of directions, rays of the same two cells in the order of the tiles;
/// - shuffled: a permutation that depends only on the set's view, kind and size.
void arrange(RaySet& set, RayOrder order);

} // namespace tetrace
