// Boundary faces that rays enter by, as links into tets that hold their corners.
STRUCT(EntryFace)
{
    Vec3 a; // in the order of faces.h
    Vec3 b;
    Vec3 c;
};

KERNEL_FN EntryFace entry_face(SceneView scene, uint index)
{
    uint link = FETCH(scene, entry_links, index);
    EntryFace face;
    face.a = vertex(scene, link >> 2u, corner(link & 3u, 0u));
    face.b = vertex(scene, link >> 2u, corner(link & 3u, 1u));
    face.c = vertex(scene, link >> 2u, corner(link & 3u, 2u));
    return face;
}

#include "kernels/walks/entry.h"

// The link of the boundary face that a ray enters the domain by, or NO_LINK.
KERNEL_FN uint entry_link(SceneView scene, Ray ray)
{
    uint entry = entry_index(scene, ray);
    return entry == NO_ENTRY ? NO_LINK : FETCH(scene, entry_links, entry);
}
