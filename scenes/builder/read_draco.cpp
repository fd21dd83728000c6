#include "scenes/builder/read_draco.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

namespace tetrace {

DracoMesh read_draco(const MeshSource& source, std::string_view bytes, std::uint64_t attribute,
                     const std::string& place)
{
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        source.fail(place, fmt::format("its Draco data cannot be read: {}", decoded.status().error_msg_string()));
    const draco::Mesh& mesh = *decoded.value();
    const draco::PointAttribute* const positions = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(attribute));
    if (positions == nullptr || positions->num_components() != 3)
        source.fail(place, fmt::format("its Draco data lack the attribute {} of three components", attribute));
    DracoMesh result;
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        const draco::AttributeValueIndex value = positions->mapped_index(point);
        std::array<double, 3> position{};
        if (value.value() >= positions->size() || !positions->ConvertValue(value, 3, position.data()))
            source.fail(place, fmt::format("its Draco data lack the position of point {}", point.value()));
        result.positions.push_back({position[0], position[1], position[2]});
    }
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
        const auto& corners = mesh.face(face);
        for (const draco::PointIndex& corner : corners)
            if (corner.value() >= mesh.num_points())
                source.fail(place, fmt::format("triangle {} of its Draco data names point {} of {}", face.value(),
                                               corner.value(), mesh.num_points()));
        result.triangles.push_back({corners[0].value(), corners[1].value(), corners[2].value()});
    }
    return result;
}

} // namespace tetrace
