#include "scenes/builder/read_draco.h"

// In place of read_draco.cpp if libdraco is not installed.

namespace tetrace {

DracoMesh read_draco(const MeshSource& source, std::string_view, std::uint64_t, const std::string& place)
{
    source.fail(place,
                "it is compressed by Draco, which this tetrace-builder does not read: it was built without libdraco",
                "install libdraco-dev and build all of tetrace (`make build`), or export the mesh without compression");
}

} // namespace tetrace
