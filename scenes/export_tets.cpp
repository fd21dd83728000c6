#include "scenes/export_tets.h"

#include "core/base/files.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <string>
#include <string_view>

namespace tetrace {

namespace {

struct ExportedFace {
    std::uint32_t tet, face, triangle;
};

/// Each occlusive face, from the first of its tets.
std::vector<ExportedFace> occlusive_faces(const Scene& scene)
{
    std::vector<ExportedFace> faces;
    for (std::uint32_t tet = 0; tet < scene.tets.tets.size(); ++tet)
        for (std::uint32_t face = 0; face < 4; ++face) {
            const std::uint32_t triangle = scene.tets.tets[tet].faces[face],
                                across = scene.tets.tets[tet].neighbours[face];
            if (triangle != FREE_FACE && (across == NO_HALF_FACE || across > make_half_face(tet, face)))
                faces.push_back({tet, face, source_triangle(scene, triangle)});
        }
    return faces;
}

/// Of each tet the number of its part, in which free faces join tets; the part of the reached ones is 0.
std::vector<std::int64_t> closed_parts(const TetMesh& mesh)
{
    const std::vector<bool> reached = reached_tets(mesh);
    std::vector<std::int64_t> parts(mesh.tets.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        parts[i] = reached[i] ? 0 : -1;
    std::int64_t count = 0;
    std::vector<std::size_t> pending;
    for (std::size_t first = 0; first < parts.size(); ++first) {
        if (parts[first] >= 0) continue;
        parts[first] = ++count;
        pending.push_back(first);
        while (!pending.empty()) {
            const Tet& tet = mesh.tets[pending.back()];
            pending.pop_back();
            for (std::size_t face = 0; face < 4; ++face) {
                if (tet.faces[face] != FREE_FACE || tet.neighbours[face] == NO_HALF_FACE) continue;
                const std::size_t next = half_face_tet(tet.neighbours[face]);
                if (parts[next] < 0) pending.push_back(next);
                if (parts[next] < 0) parts[next] = count;
            }
        }
    }
    return parts;
}

} // namespace

std::vector<std::int64_t> regions_of(const Scene& scene)
{
    if (scene.source_tets.empty()) return closed_parts(scene.tets);
    std::int64_t least = 1;
    for (const SourceTet& own : scene.source_tets)
        least = std::min<std::int64_t>(least, own.region);
    std::vector<std::int64_t> regions(scene.tets.tets.size(), least - 1);
    std::ranges::transform(scene.source_tets, regions.begin(), &SourceTet::region);
    return regions;
}

std::vector<std::int64_t> numbers_of(const Scene& scene)
{
    std::vector<std::int64_t> numbers(scene.tets.tets.size(), -1);
    if (scene.build.optimised.tets != TetsKind::rays)
        std::ranges::transform(scene.source_tets, numbers.begin(), &SourceTet::number);
    return numbers;
}

std::vector<double> volumes_of(const Scene& scene)
{
    std::vector<double> volumes;
    for (const Tet& tet : scene.tets.tets) {
        const auto at = [&](std::size_t corner) { return to_double(scene.tets.vertices[tet.vertices[corner]]); };
        const double six = dot(at(0) - at(3), cross(at(1) - at(3), at(2) - at(3)));
        volumes.push_back(std::ldexp(std::abs(six) / 6, -3 * scene.build.scale_exponent));
    }
    return volumes;
}

namespace {

std::vector<double> costs_of(const Scene& scene)
{
    const Double3 size = to_double(scene.domain.high()) - to_double(scene.domain.low());
    const double box_area = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const std::vector<bool> reached = reached_tets(scene.tets);
    const bool has_own = !scene.source_tets.empty(); // their insides are what rays are for
    std::vector<double> costs(scene.tets.tets.size());
    for (std::size_t i = 0; i < costs.size(); ++i) {
        const Tet& tet = scene.tets.tets[i];
        for (std::size_t face = 0; face < 4; ++face) {
            if (!(reached[i] || has_own) || tet.faces[face] != FREE_FACE || tet.neighbours[face] == NO_HALF_FACE)
                continue;
            const auto corner = [&](std::size_t k) {
                return to_double(scene.tets.vertices[tet.vertices[face_corners[face][k]]]);
            };
            // A uniform line that meets a convex body crosses a flat face inside it 2 area / surface times.
            costs[i] += 0.5 * length(cross(corner(1) - corner(0), corner(2) - corner(0))) / box_area;
        }
    }
    return costs;
}

/// Appends text to one file after the other.
class TetsText {
public:
    explicit TetsText(const Scene& scene) : scene_(scene), faces_(occlusive_faces(scene)), regions_(regions_of(scene))
    {
    }

    [[nodiscard]] std::string vtk()
    {
        const std::size_t tets = regions_.size(), cells = tets + faces_.size();
        add("# vtk DataFile Version 3.0\n{}, by tetrace\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
            one_line(scene_.name), scene_.tets.vertices.size());
        add_points(false, "");
        add("CELLS {} {}\n", cells, 5 * tets + 4 * faces_.size());
        add_tets([&](std::size_t, const auto& v) { add("4 {} {} {} {}\n", v[0], v[1], v[2], v[3]); });
        add_faces([&](const auto& v, std::uint32_t) { add("3 {} {} {}\n", v[0], v[1], v[2]); });
        add("CELL_TYPES {}\n", cells);
        for (std::size_t i = 0; i < cells; ++i)
            text_ += i < tets ? "10\n" : "5\n";
        add("CELL_DATA {}\n", cells);
        add_cell_data();
        return std::move(text_);
    }

    [[nodiscard]] std::string vtu()
    {
        const std::size_t tets = regions_.size(), cells = tets + faces_.size();
        add("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
            "NumberOfCells=\"{}\">\n<Points>\n",
            scene_.tets.vertices.size(), cells);
        begin_array("Float64", "Points", 3);
        add_points(false, "");
        add("{}</Points>\n<Cells>\n", end_of_array);
        begin_array("Int64", "connectivity");
        add_tets([&](std::size_t, const auto& v) { add("{} {} {} {}\n", v[0], v[1], v[2], v[3]); });
        add_faces([&](const auto& v, std::uint32_t) { add("{} {} {}\n", v[0], v[1], v[2]); });
        text_ += end_of_array;
        begin_array("Int64", "offsets");
        for (std::size_t i = 0; i < cells; ++i)
            add("{}\n", i < tets ? 4 * (i + 1) : 3 * (i + 1) + tets);
        text_ += end_of_array;
        begin_array("UInt8", "types");
        for (std::size_t i = 0; i < cells; ++i)
            text_ += i < tets ? "10\n" : "5\n";
        add("{}</Cells>\n<CellData>\n", end_of_array);
        is_xml_ = true;
        add_cell_data();
        text_ += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        return std::move(text_);
    }

    [[nodiscard]] std::string medit()
    {
        add("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", scene_.tets.vertices.size());
        add_points(false, " 0");
        add("Triangles\n{}\n", faces_.size());
        add_faces([&](const auto& v, std::uint32_t triangle) {
            add("{} {} {} {}\n", v[0] + 1, v[1] + 1, v[2] + 1, triangle);
        });
        add("Tetrahedra\n{}\n", regions_.size());
        add_tets([&](std::size_t i, const auto& v) {
            add("{} {} {} {} {}\n", v[0] + 1, v[1] + 1, v[2] + 1, v[3] + 1, regions_[i]);
        });
        add("End\n");
        return std::move(text_);
    }

    [[nodiscard]] std::string node()
    {
        add("{} 3 0 0\n", scene_.tets.vertices.size());
        add_points(true, "");
        return std::move(text_);
    }
    [[nodiscard]] std::string ele()
    {
        add("{} 4 1\n", regions_.size());
        add_tets(
            [&](std::size_t i, const auto& v) { add("{} {} {} {} {} {}\n", i, v[0], v[1], v[2], v[3], regions_[i]); });
        return std::move(text_);
    }
    [[nodiscard]] std::string face()
    {
        add("{} 1\n", faces_.size());
        std::size_t number = 0;
        add_faces([&](const auto& v, std::uint32_t triangle) {
            add("{} {} {} {} {}\n", number++, v[0], v[1], v[2], triangle);
        });
        return std::move(text_);
    }

private:
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values)
    {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }
    static constexpr std::string_view end_of_array = "</DataArray>\n";
    void begin_array(std::string_view type, std::string_view name, int components = 1)
    {
        add("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type, name, components);
    }
    static std::string one_line(std::string name)
    {
        std::ranges::replace(name, '\n', ' ');
        return name.substr(0, 200); // VTK's title has less than 256 characters
    }
    /// As short as they can be read again without a change.
    void add_points(bool numbered, std::string_view end)
    {
        const BuildInfo& build = scene_.build;
        std::size_t number = 0;
        for (const Float3 vertex : scene_.tets.vertices) {
            if (numbered) add("{} ", number++);
            for (int axis = 0; axis < 3; ++axis) {
                const double value = std::ldexp(static_cast<double>(vertex[axis]), -build.scale_exponent),
                             centre = axis == 0   ? build.centre.x
                                      : axis == 1 ? build.centre.y
                                                  : build.centre.z;
                text_ += axis == 0 ? "" : " ";
                centre == 0 ? add("{}", static_cast<float>(value)) : add("{}", value + centre);
            }
            text_ += end;
            text_ += '\n';
        }
    }
    /// Turned over: det > 0, as all formats have it.
    template <class Write>
    void add_tets(const Write& write)
    {
        for (std::size_t i = 0; i < regions_.size(); ++i) {
            const auto& [a, b, c, d] = scene_.tets.tets[i].vertices;
            write(i, std::array{b, a, c, d});
        }
    }
    template <class Write>
    void add_faces(const Write& write)
    {
        for (const ExportedFace& face : faces_) {
            const auto& vertices = scene_.tets.tets[face.tet].vertices;
            const auto& [a, b, c] = face_corners[face.face];
            write(std::array{vertices[a], vertices[b], vertices[c]}, face.triangle);
        }
    }
    /// VTK's arrays of the cells: tets, then faces.
    void add_cell_data()
    {
        const std::vector<std::int64_t> none(regions_.size(), -1);
        add_cells("region", "long", regions_, [&](const ExportedFace& face) { return regions_[face.tet]; });
        add_cells("number", "long", numbers_of(scene_), [](const ExportedFace&) { return -1; });
        add_cells("triangle", "long", none, [](const ExportedFace& face) { return face.triangle; });
        add_cells("cost", "double", costs_of(scene_), [](const ExportedFace&) { return 0; });
    }
    template <class Values, class OfFace>
    void add_cells(std::string_view name, std::string_view type, const Values& of_tets, const OfFace& of_face)
    {
        if (is_xml_)
            begin_array(type == "long" ? "Int64" : "Float64", name);
        else
            add("SCALARS {} {} 1\nLOOKUP_TABLE default\n", name, type);
        for (const auto value : of_tets)
            add("{}\n", value);
        for (const ExportedFace& face : faces_)
            add("{}\n", of_face(face));
        if (is_xml_) text_ += end_of_array;
    }

    const Scene& scene_;
    std::vector<ExportedFace> faces_;
    std::vector<std::int64_t> regions_;
    std::string text_;
    bool is_xml_ = false; ///< how arrays are written
};

} // namespace

bool is_tets_file(const std::filesystem::path& path)
{
    const std::string ending = path.extension().string();
    return ending == ".vtk" || ending == ".vtu" || ending == ".mesh" || ending == ".node" || ending == ".ele";
}

void export_tets(const Scene& scene, const std::filesystem::path& path)
{
    const std::string ending = path.extension().string();
    TetsText text(scene);
    if (ending == ".vtk") return write_whole(path, text.vtk());
    if (ending == ".vtu") return write_whole(path, text.vtu());
    if (ending == ".mesh") return write_whole(path, text.medit());
    std::filesystem::path file = path;
    write_whole(file.replace_extension(".node"), text.node());
    write_whole(file.replace_extension(".ele"), text.ele());
    write_whole(file.replace_extension(".face"), text.face());
}

} // namespace tetrace
