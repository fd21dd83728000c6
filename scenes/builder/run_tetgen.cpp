#include "scenes/builder/run_tetgen.h"

#include "core/base/error.h"
#include "scenes/builder_exit.h"

#define TETLIBRARY
#include <tetgen.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fmt/format.h>
#include <memory>
#include <new>
#include <numeric>
#include <random>

namespace tetrace {
namespace {

constexpr int domain_marker = -1;
// z: count from 0; n: neighbours; J: input points keep their numbers; Q: no chatter. Each triangle has a marker of its
// own, and TetGen merges only coplanar facets of equal markers: so no triangle's faces are taken for another's, with or
// without M.
constexpr const char* our_switches = "znJQ";

void add_points(tetgenio& input, const std::vector<Float3>& vertices, int& next)
{
    for (const Float3 vertex : vertices)
        for (int axis = 0; axis < 3; ++axis)
            input.pointlist[next++] = static_cast<double>(vertex[axis]);
}

// TetGen's destructor frees with delete[], so these are made with new[].
void add_facet(tetgenio& input, int index, const std::array<std::uint32_t, 3>& triangle, std::size_t first_vertex,
               int marker)
{
    tetgenio::facet& facet = input.facetlist[index];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (std::size_t i = 0; i < 3; ++i)
        facet.polygonlist->vertexlist[i] = static_cast<int>(first_vertex + triangle[i]);
    input.facetmarkerlist[index] = marker;
}

// Points that TetGen inserts once the triangles are in: as vertices from the start they make its recovery of triangles
// crash (3torus.off and blob.off of libcgal-demo).
void fill_points(tetgenio& input, const std::vector<Float3>& points)
{
    input.firstnumber = 0;
    input.numberofpoints = static_cast<int>(points.size());
    input.pointlist = new double[3 * points.size()];
    int next = 0;
    add_points(input, points, next);
}

// Of each number below `count`, its place; a shuffle that is the same on every machine.
std::vector<std::uint32_t> places_of(std::size_t count, std::uint32_t order)
{
    std::vector<std::uint32_t> places(count);
    std::iota(places.begin(), places.end(), 0u);
    std::mt19937_64 random(order);
    for (std::size_t i = count; order > 0 && i > 1; --i)
        std::swap(places[i - 1], places[random() % i]);
    return places;
}

// A mesh whose vertices and triangles are in another order.
TriangleMesh shuffled(const TriangleMesh& mesh, const std::vector<std::uint32_t>& vertices,
                      const std::vector<std::uint32_t>& triangles)
{
    TriangleMesh result = mesh;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        result.vertices[vertices[i]] = mesh.vertices[i];
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t corner = 0; corner < 3; ++corner)
            result.triangles[triangles[i]][corner] = vertices[mesh.triangles[i][corner]];
    return result;
}

template <class Indices>
void rename(Indices& indices, const std::vector<std::uint32_t>& names)
{
    for (std::int32_t& index : indices)
        if (static_cast<std::size_t>(index) < names.size())
            index = static_cast<std::int32_t>(names[static_cast<std::size_t>(index)]);
}

// Back into the order that shuffled() changed.
void restore_order(RawTets& output, const std::vector<std::uint32_t>& vertices,
                   const std::vector<std::uint32_t>& triangles)
{
    const auto inverse = [](const std::vector<std::uint32_t>& places) {
        std::vector<std::uint32_t> names(places.size());
        for (std::uint32_t i = 0; i < places.size(); ++i)
            names[places[i]] = i;
        return names;
    };
    const std::vector<Double3> points = output.points;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        output.points[i] = points[vertices[i]];
    const auto names = inverse(vertices), numbers = inverse(triangles);
    for (auto& tet : output.tets)
        rename(tet, names);
    for (auto& face : output.surface_faces) {
        rename(face.corners, names);
        if (face.triangle >= 0)
            face.triangle = static_cast<std::int32_t>(numbers[static_cast<std::size_t>(face.triangle)]);
    }
}

void fill(tetgenio& input, const TriangleMesh& mesh, const TriangleMesh& surface)
{
    input.firstnumber = 0;
    input.numberofpoints = static_cast<int>(mesh.vertices.size() + surface.vertices.size());
    input.pointlist = new double[3 * static_cast<std::size_t>(input.numberofpoints)];
    int next = 0;
    add_points(input, mesh.vertices, next);
    add_points(input, surface.vertices, next);
    input.numberoffacets = static_cast<int>(mesh.triangles.size() + surface.triangles.size());
    input.facetlist = new tetgenio::facet[static_cast<std::size_t>(input.numberoffacets)];
    input.facetmarkerlist = new int[static_cast<std::size_t>(input.numberoffacets)];
    int facet = 0;
    for (const auto& triangle : mesh.triangles) {
        add_facet(input, facet, triangle, 0, facet + 1);
        ++facet;
    }
    // Unlike markers on the domain's sides too: each square stays two triangles unless TetGen must split it.
    int marker = domain_marker;
    for (const auto& triangle : surface.triangles)
        add_facet(input, facet++, triangle, mesh.vertices.size(), marker--);
}

template <std::size_t size>
std::vector<std::array<std::int32_t, size>> rows(const int* from, int count)
{
    std::vector<std::array<std::int32_t, size>> result(static_cast<std::size_t>(count));
    for (auto& row : result)
        for (auto& value : row)
            value = *from++;
    return result;
}

// Tets are positive for TetGen where orient3d of its corners is negative.
std::uint64_t count_flat(tetgenio& output)
{
    std::uint64_t flat = 0;
    for (int i = 0; i < output.numberoftetrahedra; ++i) {
        double* corner[4];
        for (int k = 0; k < 4; ++k)
            corner[k] = output.pointlist + 3 * output.tetrahedronlist[4 * i + k];
        if (orient3d(corner[0], corner[1], corner[2], corner[3]) >= 0) ++flat;
    }
    return flat;
}

RawTets take(tetgenio& output, std::size_t input_points)
{
    RawTets result;
    result.input_points = input_points;
    for (int i = 0; i < output.numberofpoints; ++i)
        result.points.push_back({output.pointlist[3 * i], output.pointlist[3 * i + 1], output.pointlist[3 * i + 2]});
    result.tets = rows<4>(output.tetrahedronlist, output.numberoftetrahedra);
    result.neighbours = rows<4>(output.neighborlist, output.numberoftetrahedra);
    const auto corners = rows<3>(output.trifacelist, output.numberoftrifaces);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const int marker = output.trifacemarkerlist[i];
        result.surface_faces.push_back({corners[i], marker > 0 ? marker - 1 : domain_marker});
    }
    result.flat_tets = count_flat(output);
    return result;
}

const char* meaning_of(int code)
{
    switch (code) {
    case 2: return "an internal error (a known weakness of TetGen 1.5)";
    case 3: return "it takes two facets for intersecting (exactly none do: some are closer than its tolerance)";
    case 4: return "a feature is too small for its tolerance";
    case 5: return "two facets are very close to each other";
    case 10: return "it does not accept the input";
    default: return "a code that it does not document";
    }
}

std::string remedy_for(int code)
{
    if (code == 5) return "try --switches with Y, for example pq5Y"; // TetGen's own hint
    const bool too_near = code == 3 || code == 4;
    return fmt::format("{}, or repair the mesh{}", try_other_switches,
                       too_near ? " (merge nearly equal vertices)" : "");
}

[[noreturn]] void end_process(int code, const std::string& text)
{
    std::fflush(stdout);
    fmt::print(stderr, "error: {}\n", text);
    std::fflush(stderr);
    std::_Exit(code);
}

} // namespace

void require_switches(const std::string& switches)
{
    const auto fail = [&](const std::string& why) {
        throw Error(ErrorKind::usage,
                    fmt::format("reading --switches: '{}' {}; TetGen's switches begin with p and may hold "
                                "q a A Y M T O S D C V X with their numbers, for example pq5Y",
                                switches, why));
    };
    if (!switches.starts_with('p')) fail("does not begin with p");
    const auto bad = switches.find_first_not_of("pqaAYMTOSDCVX0123456789./e-");
    if (bad != std::string::npos) fail(fmt::format("holds '{}'", switches[bad]));
    // TetGen copies its command line into a fixed buffer.
    if (switches.size() > 200) fail("is longer than 200 characters");
    tetgenbehavior behavior;
    std::string text = switches;
    if (!behavior.parse_commandline(text.data())) fail("is refused by TetGen");
}

RawTets run_tetgen(const TriangleMesh& mesh, const TriangleMesh& surface, const std::vector<Float3>& points,
                   const std::string& switches, std::uint32_t order)
{
    // Not on the stack: if TetGen throws, nothing may be unwound.
    auto* const input = new tetgenio;
    auto* const output = new tetgenio;
    auto* const later = new tetgenio;
    const auto vertices = places_of(mesh.vertices.size(), order), triangles = places_of(mesh.triangles.size(), order);
    fill(*input, shuffled(mesh, vertices, triangles), surface);
    fill_points(*later, points);
    std::string text = switches + our_switches + (points.empty() ? "" : "i");
    tetgenbehavior behavior;
    behavior.parse_commandline(text.data());
    tetrahedralize(&behavior, input, output, later);
    RawTets result = take(*output, static_cast<std::size_t>(input->numberofpoints));
    restore_order(result, vertices, triangles);
    delete input;
    delete later;
    delete output;
    return result;
}

void explain_tetgen_failure()
{
    if (const std::exception_ptr current = std::current_exception()) {
        try {
            std::rethrow_exception(current);
        } catch (const int code) {
            if (code == 1)
                end_process(BUILDER_OUT_OF_MEMORY, fmt::format("TetGen: out of memory; {}", allow_more_memory));
            end_process(BUILDER_TETGEN_REFUSED,
                        fmt::format("TetGen gave up with code {}: {}; {}", code, meaning_of(code), remedy_for(code)));
        } catch (const std::bad_alloc&) {
            end_process(BUILDER_OUT_OF_MEMORY, fmt::format("TetGen: out of memory; {}", allow_more_memory));
        } catch (const std::exception& unexpected) {
            end_process(BUILDER_INTERNAL, fmt::format("an exception that nothing handles: {}", unexpected.what()));
        } catch (...) {
        }
    }
    std::abort();
}

} // namespace tetrace
