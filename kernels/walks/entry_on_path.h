// The boundary face by which a ray's path enters the domain. For walks along paths, which begin only at the end of a
// path.

// For a build that counts how often a path is searched from its beginning: 0 entry_anywhere(), 1 exit_ahead(), 2 a ray
// that goes on beyond the face that it starts on. That build is never timed.
#ifndef COUNT_SEARCH
#define COUNT_SEARCH(where)
#endif

// The number of the first boundary face by which the ray enters, or NO_ENTRY. Faces first to last - 1, those of the
// square, are tested first.
KERNEL_FN uint entry_anywhere(SceneView scene, Ray ray, uint first, uint last)
{
    COUNT_SEARCH(0);
    uint in_square = last - first;
    uint faces = in_square + FETCH(scene, entry_ranges, 6u * scene.divisions * scene.divisions);
    uint found = NO_ENTRY;
    for (uint i = 0u; i < faces && found == NO_ENTRY; ++i) {
        uint index = i < in_square ? first + i : i - in_square;
        found = depth_in(entry_face(scene, index), ray) < real(0.0f) ? NO_ENTRY : index;
    }
    return found;
}

// The number of the boundary face by which the ray enters, or NO_ENTRY where it misses the domain. Float products
// decide nearly all cases. Ties are decided after the loop, since some devices execute a conditional block even if no
// lane needs it.
KERNEL_FN uint entry_index(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_ENTRY;
    uint first = FETCH(scene, entry_ranges, square);
    uint last = FETCH(scene, entry_ranges, square + 1u);
    Shear shear = shear_of(ray);
    uint found = NO_ENTRY;
    for (uint index = first;; ++index) {
        EntryFace face = entry_face(scene, index);
        uint held = roughly_held(ray, shear, face.a, face.b, face.c);
        if (held == HELD) {
            found = index;
            break;
        }
        if (held == HELD_OR_TIE || index + 1u == last) break;
    }
    if (found == NO_ENTRY) return entry_anywhere(scene, ray, first, last);
    return found;
}
