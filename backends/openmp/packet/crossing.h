#pragma once

// Given rays that cross all tets to the domain's boundary: what kernels/walks/segments.h and absorption.h keep of a
// walk, lane by lane. The records' exits at triangles lead on (packet_session.cpp). Include after places.h.

struct CrossingWalk : Walk<any_axis> {
    Mask is_y, is_z; // each ray's deepest axis
    Words turned;    // the sign bit if it runs down that axis
    Words first, begin, farthest, hash, reversed;
    Words halvings, fraction, transmittance, light;
    LaneWords added; // lengths that are not 0, in a tally
};

// The component along each ray's deepest axis.
LANE_FN Words component(const CrossingWalk& walk, const Words* of)
{
    return select(walk.is_z, of[2], select(walk.is_y, of[1], of[0]));
}

// along_axis() of places.h.
LANE_FN Floats depth_for(const Packet&, const CrossingWalk& walk, const Words* place)
{
    return as_floats(component(walk, place) ^ walk.turned);
}

LANE_FN Words places_of(const Packet& packet, const CrossingWalk& walk, Mask lanes)
{
    return places_on_faces(walk.carried, {{walk.depths[0], walk.depths[1], walk.depths[2]}}, as_words(packet.end),
                           lanes);
}

LANE_FN Words place_of_origin(const Packet& packet, const CrossingWalk& walk)
{
    const Words origin[3] = {as_words(packet.origin[0]), as_words(packet.origin[1]), as_words(packet.origin[2])};
    return high_product(place_of_coordinate(depth_for(packet, walk, origin)), as_words(packet.end));
}

// Of lanes with a new ray, which has not entered a tet yet.
LANE_FN void clear_crossing(const Packet& packet, CrossingWalk& walk, Mask mask)
{
    const Floats x = magnitude(packet.direction[0]), y = magnitude(packet.direction[1]),
                 z = magnitude(packet.direction[2]);
    walk.is_z = greater(z, x) & greater(z, y);
    walk.is_y = without(greater(y, x), walk.is_z);
    const Words direction[3] = {as_words(packet.direction[0]), as_words(packet.direction[1]),
                                as_words(packet.direction[2])};
    walk.turned = component(walk, direction) & 0x80000000u;
    walk.first = select(mask, all(NO_HIT), walk.first);
    Words* const sums[] = {&walk.begin,    &walk.farthest, &walk.hash,  &walk.reversed,
                           &walk.halvings, &walk.fraction, &walk.light, reinterpret_cast<Words*>(walk.added.of)};
    for (Words* const words : sums)
        *words = select(mask, Words{}, *words);
    walk.transmittance = select(mask, all(NO_ABSORPTION), walk.transmittance);
}

LANE_FN void begin_crossing(CrossingWalk& walk, Mask mask, Words half_faces, Words places)
{
    walk.first = select(mask, half_faces >> 2, walk.first);
    walk.begin = select(mask, places, walk.begin);
    walk.farthest = select(mask, places, walk.farthest);
}

LANE_FN Words hash_with(Words hash, Words word)
{
    const Words mixed = (hash ^ word) * 0x9E3779B1u;
    return mixed ^ (mixed >> 15);
}

// add_length() of segments.h, one lane at a time.
LANE_FN void add_lengths(const PacketJob& job, CrossingWalk& walk, Words tets, Words lengths, Mask mask)
{
    LaneWords tet, length;
    store(tet, tets);
    store(length, lengths);
    for (uint left = lanes_of(without(mask, equal(lengths, Words{}))); left != 0; left &= left - 1) {
        const uint lane = first_of(left);
        uint* const sum = job.sums + 2 * std::size_t{tet.of[lane]};
        const uint before = __atomic_fetch_add(sum, length.of[lane], __ATOMIC_RELAXED);
        if (before > ~length.of[lane]) __atomic_fetch_add(sum + 1, 1u, __ATOMIC_RELAXED);
        ++walk.added.of[lane];
    }
}

// Prefetches the sums to which lanes add next.
LANE_FN void prefetch_sums(const PacketJob& job, const CrossingWalk& walk)
{
    if (job.sums == nullptr) return;
    for (const uint offset : walk.offsets.of)
        __builtin_prefetch(job.sums + 2 * std::size_t{offset / (4 * 4 * HALF32_QUADS)}, 1);
}

// absorbed_in() and transmittance_of() of absorption.h.
LANE_FN void absorb(CrossingWalk& walk, Words tets, Words lengths, Mask mask)
{
    Words medium = (tets + 1u) * 0x9E3779B1u;
    medium = (medium ^ (medium >> 15)) * 0x85EBCA6Bu;
    const Words density = medium >> 24, value = (medium >> 16) & 255u;
    const Words fraction = walk.fraction + density * lengths;
    const Words carry = select(greater(walk.fraction, fraction), all(1u), Words{});
    const Words halvings = walk.halvings + high_product(density, lengths) + carry;
    const Words f = fraction & 0xFFFFFF00u;
    Words rest = all(0x78809u);
    constexpr uint coefficients[] = {0x54A612u, 0x274F388u, 0xE353290u, 0x3D7F7506u, 0xB17217DFu};
    for (const uint coefficient : coefficients)
        rest = coefficient - high_product(f, rest);
    const Words power = (0x80000000u - (high_product(f, rest) >> 1)) >> (31u - TRANSMITTANCE_BITS);
    const Mask is_dark = greater(halvings, all(TRANSMITTANCE_BITS));
    const Words transmittance = select(is_dark, Words{}, power >> least(halvings, all(TRANSMITTANCE_BITS)));
    walk.light = select(mask, walk.light + value * (walk.transmittance - transmittance), walk.light);
    walk.fraction = select(mask, fraction, walk.fraction);
    walk.halvings = select(mask, halvings, walk.halvings);
    walk.transmittance = select(mask, transmittance, walk.transmittance);
}

// leaving_tet() of segments.h: lanes leave the tets of their records by the faces that they carry. Returns the lanes
// whose light is absorbed.
LANE_FN Mask cross(const PacketJob& job, const Packet& packet, CrossingWalk& walk, Mask mask)
{
    const Words tets = walk.record >> 2, places = places_of(packet, walk, mask);
    const Mask is_reversed = greater(walk.farthest, places);
    const Words farthest = select(is_reversed, walk.farthest, places), lengths = farthest - walk.farthest;
    walk.hash = select(mask, hash_with(hash_with(walk.hash, tets), places), walk.hash);
    walk.reversed = select(mask & is_reversed, walk.reversed + 1u, walk.reversed);
    walk.farthest = select(mask, farthest, walk.farthest);
    if (job.sums != nullptr) add_lengths(job, walk, tets, lengths, mask);
    if (!job.absorbs) return mask_of(0);
    absorb(walk, tets, lengths, mask);
    return greater(all(MIN_TRANSMITTANCE), walk.transmittance);
}

// The answers of lanes whose rays have ended, or are left to the scalar kernel.
[[gnu::noinline]] void write_answers(const PacketJob& job, const Packet& packet, const CrossingWalk& walk, uint lanes)
{
    const Words length = walk.farthest - walk.begin;
    write_words(job, packet, lanes & ~packet.deferred,
                {{walk.first, packet.record >> 2, job.absorbs ? walk.light : length, walk.hash,
                  job.absorbs ? walk.transmittance : walk.reversed, packet.steps}});
    for (uint left = lanes & packet.deferred; left != 0; left &= left - 1) {
        const uint lane = first_of(left);
        job.cross_one(job, packet.numbers.of[lane], walk.added.of[lane]);
    }
}
