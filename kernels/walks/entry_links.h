// Boundary faces as links to tets that hold their corners; include after entry.h.
KERNEL_FN EntryFace entry_face(SceneView scene, uint index)
{
    uint link = FETCH(scene, entry_links, index);
    EntryFace face;
    face.a = vertex(scene, link >> 2u, corner(link & 3u, 0u));
    face.b = vertex(scene, link >> 2u, corner(link & 3u, 1u));
    face.c = vertex(scene, link >> 2u, corner(link & 3u, 2u));
    return face;
}

// The link of a boundary face; NO_LINK for NO_ENTRY, and for a ray that is left.
KERNEL_FN uint entry_link(SceneView scene, uint index)
{
    return index >= LEFT ? NO_LINK : FETCH(scene, entry_links, index);
}
