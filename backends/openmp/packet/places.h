#pragma once

// Where lanes meet the faces that they leave by: kernels/walks/places.h, lane by lane, in its order of operations.
// Walks see vertices by shear_of(), whose y has another sign in some lanes; no place depends on that. Include after
// walk.h.

// The numbers of a face's three corners.
struct Corners {
    Floats of[3];
};
LANE_FN Corners magnitudes_of(const Corners& a)
{
    return {{magnitude(a.of[0]), magnitude(a.of[1]), magnitude(a.of[2])}};
}
LANE_FN Corners select(Mask mask, const Corners& a, const Corners& b)
{
    return {{select(mask, a.of[0], b.of[0]), select(mask, a.of[1], b.of[1]), select(mask, a.of[2], b.of[2])}};
}
LANE_FN Floats least_of(const Corners& a)
{
    return least(least(a.of[0], a.of[1]), a.of[2]);
}
LANE_FN Floats greatest_of(const Corners& a)
{
    return greatest(greatest(a.of[0], a.of[1]), a.of[2]);
}
LANE_FN Floats median_of(const Corners& a)
{
    return greatest(least(a.of[0], a.of[1]), least(greatest(a.of[0], a.of[1]), a.of[2]));
}
LANE_FN Floats sum_of(const Corners& a)
{
    return (least_of(a) + greatest_of(a)) + median_of(a);
}

// fine_side() of shear.h.
LANE_FN Floats fine_side(const Seen& a, const Seen& b)
{
    const Floats plus = a.x * b.y, minus = a.y * b.x;
    return (plus - minus) + (lost_by(a.x, b.y, plus) - lost_by(a.y, b.x, minus));
}

LANE_FN Floats above_zero(Floats a)
{
    return greatest(a, Floats{});
}

// Where a face is seen in its longer axis, and the product up to which its weights count as none.
struct Extent {
    Mask is_high; // that axis is y
    Floats least_sum;
};
LANE_FN Extent extent_of(const Seen* p)
{
    const Floats x = greatest_of(magnitudes_of({{p[0].x, p[1].x, p[2].x}})),
                 y = greatest_of(magnitudes_of({{p[0].y, p[1].y, p[2].y}}));
    const Floats size = greatest(x, y);
    return {greater(y, x), size * size * 0x1p-23f};
}

LANE_FN Corners weights_edge_on(const Corners& h)
{
    const Floats zero{};
    const Floats above = above_zero(h.of[0]) + above_zero(h.of[1]) + above_zero(h.of[2]);
    const Floats below = above_zero(-h.of[0]) + above_zero(-h.of[1]) + above_zero(-h.of[2]);
    const Corners away = magnitudes_of(h);
    const Floats nearest = least_of(away);
    Corners weights, instead;
    for (uint i = 0; i < 3; ++i) {
        weights.of[i] = select(greater(h.of[i], zero), below, select(greater(zero, h.of[i]), above, above + below));
        instead.of[i] = select(greater(away.of[i], nearest), zero, all(1.0f));
    }
    return select(greater(sum_of(weights), zero), weights, instead);
}

LANE_FN Floats weight_on_edge(const Seen& p, const Seen& q)
{
    return above_zero(q.x * (q.x - p.x) + q.y * (q.y - p.y));
}

// is_inside: by corner, the lanes on its side of the edge across from it.
LANE_FN Corners weights_outside(const Seen* p, const Mask* is_inside)
{
    const Floats zero{};
    Mask is_on[3]; // the edge from corner i to the next one
    Floats first[3], second[3];
    for (uint i = 0; i < 3; ++i) {
        const uint next = (i + 1) % 3, other = (i + 2) % 3;
        first[i] = weight_on_edge(p[i], p[next]);
        second[i] = weight_on_edge(p[next], p[i]);
        const Mask rises = (is_inside[i] & greater(second[i], zero)) | without(greater(first[i], zero), is_inside[i]);
        is_on[i] =
            without((is_inside[i] & is_inside[next]) | ((is_inside[i] | is_inside[next]) & rises), is_inside[other]);
    }
    const Mask is_on_any = is_on[0] | is_on[1] | is_on[2];
    Corners weights;
    for (uint i = 0; i < 3; ++i) {
        const uint before = (i + 2) % 3;
        const Floats on_edges = select(is_on[i], first[i], zero) + select(is_on[before], second[before], zero);
        weights.of[i] = select(is_on_any, on_edges, select(is_inside[i], all(1.0f), zero));
    }
    return weights;
}

// The weights of lanes that see a face edge-on, or pass it outside, which is rare.
[[gnu::noinline]] Corners unusual_weights(const Seen* p, const Corners& areas)
{
    const Floats zero{}, area = sum_of(areas);
    const Extent extent = extent_of(p);
    Corners h;
    Mask is_inside[3];
    for (uint i = 0; i < 3; ++i) {
        h.of[i] = select(extent.is_high, p[i].y, p[i].x);
        const Mask is_positive = greater(area, zero);
        is_inside[i] =
            without(is_positive, greater(zero, areas.of[i])) | neither(is_positive, greater(areas.of[i], zero));
    }
    const Corners sides = magnitudes_of(areas);
    const Mask has_area = without(greater(sum_of(sides), extent.least_sum), equal(area, zero));
    const Corners passed = select(is_inside[0] & is_inside[1] & is_inside[2], sides, weights_outside(p, is_inside));
    return select(has_area, passed, weights_edge_on(h));
}

LANE_FN Floats reciprocal(Floats a)
{
    Floats result = as_floats(all(0x7EF311C3u) - as_words(a));
    for (uint i = 0; i < 3; ++i)
        result = result * (2.0f - a * result);
    return result;
}

// A number of units, truncated, modulo 2^32.
LANE_FN Words whole(Floats units)
{
    return reinterpret_cast<Words>(__builtin_convertvector(units, Ints));
}
LANE_FN Words place_of_coordinate(Floats along)
{
    return PLACE_OF_ZERO + whole(along * 0x1p29f);
}

// Where rays meet faces, whose corners they see at p, in units of length. along: the corners' coordinates along each
// ray's deepest axis, in its sense. lanes: those whose place is used.
LANE_FN Words places_on_faces(const Seen* p, const Corners& along, Words stretch, Mask lanes)
{
    const Corners areas = {{fine_side(p[1], p[2]), fine_side(p[2], p[0]), fine_side(p[0], p[1])}};
    Corners weights = magnitudes_of(areas);
    const Floats zero{};
    const Mask is_outside = greater(zero, least_of(areas)) & greater(greatest_of(areas), zero);
    // Else the sum of the areas is that of the weights, or its negative.
    const Mask is_usual = without(greater(sum_of(weights), extent_of(p).least_sum), is_outside);
    if (lanes_of(without(lanes, is_usual)) != 0) weights = select(is_usual, weights, unusual_weights(p, areas));
    const Floats median = median_of(along);
    Floats offsets[3];
    for (uint i = 0; i < 3; ++i)
        offsets[i] = (along.of[i] - median) * 0x1p40f;
    const Floats weighted = weights.of[0] * offsets[0] + weights.of[1] * offsets[1] + weights.of[2] * offsets[2];
    const Floats units = weighted * reciprocal(sum_of(weights)) * 0x1p-11f;
    return high_product(place_of_coordinate(median) + whole(units), stretch);
}
