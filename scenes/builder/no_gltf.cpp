#include "scenes/builder/mesh_source.h"

// In place of read_gltf.cpp if tinygltf is not installed.

namespace tetrace {

void read_gltf(MeshSource& source)
{
    source.fail("name", "this tetrace-builder was built without tinygltf, and does not read glTF",
                "install libtinygltf-dev and build all of tetrace (`make build`), or export the mesh as PLY");
}

} // namespace tetrace
