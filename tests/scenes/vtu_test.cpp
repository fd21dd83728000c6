// VTK's XML files: every encoding has the same tets, and what is damaged or compressed otherwise is refused by place.
#include "scenes/export_tets.h"
#include "scenes/procedural.h"
#include "tests/scenes/mesh_samples.h"
#include "tests/support/builder_meshes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <functional>
#include <numeric>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

std::string base64(const std::string& bytes)
{
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k < bytes.size() + 1 ? letters[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string zlib(const std::string& bytes)
{
    std::string packed(::compressBound(bytes.size()), '\0');
    uLongf size = packed.size();
    EXPECT_EQ(::compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                         bytes.size()),
              Z_OK);
    packed.resize(size);
    return packed;
}

/// How a file's arrays are written.
struct Writing {
    std::string format = "ascii"; ///< or binary, raw, base64: the last two are appended
    bool is_little = true, is_compressed = false, has_long_headers = false, has_headers_apart = false;
};

/// Two tets, of regions 5 and 6, and a triangle before them; or two pieces with a tet each.
class VtuText {
public:
    explicit VtuText(Writing writing) : writing_(std::move(writing)) {}

    std::string of_one_piece()
    {
        return file(piece({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, {0, 1, 2, 0, 1, 2, 3, 2, 1, 3, 4}, {3, 7, 11},
                          {5, 10, 10}, {8, 5, 6}));
    }
    std::string of_two_pieces()
    {
        const std::string first =
            piece({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 0, 1, 2, 3}, {3, 7}, {5, 10}, {8, 5});
        return file(first + piece({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, {1, 0, 2, 3}, {4}, {10}, {6}));
    }

private:
    std::string file(const std::string& pieces) const
    {
        return fmt::format("<?xml version=\"1.0\"?>\n<!-- <VTKFile> -->\n<VTKFile type=\"UnstructuredGrid\" "
                           "version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{}>\n<UnstructuredGrid>\n<FieldData>"
                           "<DataArray Name=\"region\" type=\"Int32\" format=\"ascii\">7</DataArray></FieldData>\n{}"
                           "</UnstructuredGrid>\n{}</VTKFile>\n",
                           writing_.is_little ? "LittleEndian" : "BigEndian",
                           writing_.has_long_headers ? "UInt64" : "UInt32",
                           writing_.is_compressed ? " compressor=\"vtkZLibDataCompressor\"" : "", pieces,
                           appended_.empty() ? ""
                                             : fmt::format("<AppendedData encoding=\"{}\">\n  _{}\n</AppendedData>\n",
                                                           writing_.format, appended_));
    }
    std::string piece(const std::vector<double>& points, const std::vector<std::int64_t>& corners,
                      const std::vector<std::int64_t>& ends, const std::vector<std::uint8_t>& types,
                      const std::vector<std::int32_t>& regions)
    {
        std::string text = fmt::format("<Piece NumberOfPoints='{}' NumberOfCells='{}'>\n<PointData>{}</PointData>\n",
                                       points.size() / 3, types.size(),
                                       array("Int32", "region", std::vector<std::int32_t>(points.size() / 3, 9)));
        text += fmt::format("<CellData>\n{}{}</CellData>\n", array("Float64", "other", std::vector<double>{1.5}),
                            array("Int32", "Region", regions));
        text += fmt::format("<Points>\n{}</Points>\n", array("Float64", "Points", points, 3));
        return text + fmt::format("<Cells>\n{}{}{}</Cells>\n</Piece>\n", array("Int64", "connectivity", corners),
                                  array("Int64", "offsets", ends), array("UInt8", "types", types));
    }
    template <class Value>
    std::string array(const std::string& type, const std::string& name, const std::vector<Value>& values,
                      int components = 1)
    {
        const std::string head =
            fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=", type, name, components);
        if (writing_.format == "ascii") {
            std::string text = head + "\"ascii\" RangeMin=\"0\">\n<InformationKey name=\"L2_NORM_RANGE\">\n<Value>0"
                                      "</Value></InformationKey>\n";
            for (const Value value : values)
                text += fmt::format("{} ", value);
            return text + "\n</DataArray>\n";
        }
        std::string bytes;
        for (const Value value : values)
            bytes += bytes_of(value, writing_.is_little);
        const std::string whole = encoded(bytes);
        if (writing_.format == "binary") return head + "\"binary\">\n  " + whole + "\n</DataArray>\n";
        const std::size_t offset = appended_.size();
        appended_ += whole;
        return head + fmt::format("\"appended\" offset=\"{}\"/>\n", offset);
    }
    std::string encoded(const std::string& bytes) const
    {
        const auto size = [&](std::size_t value) {
            return writing_.has_long_headers ? bytes_of(static_cast<std::uint64_t>(value), writing_.is_little)
                                             : bytes_of(static_cast<std::uint32_t>(value), writing_.is_little);
        };
        const auto text = [&](const std::string& part) { return writing_.format == "raw" ? part : base64(part); };
        if (!writing_.is_compressed)
            return writing_.has_headers_apart ? text(size(bytes.size())) + text(bytes)
                                              : text(size(bytes.size()) + bytes);
        const std::string first = zlib(bytes.substr(0, 16)),
                          last = zlib(bytes.substr(std::min<std::size_t>(16, bytes.size())));
        if (bytes.size() <= 16) // one block that is not full
            return text(size(1) + size(32) + size(bytes.size()) + size(first.size())) + text(first);
        const std::size_t rest = bytes.size() - 16;
        if (rest > 16) { // blocks of equal size, but for the last
            std::string sizes, blocks;
            std::size_t count = 0;
            for (std::size_t at = 0; at < bytes.size(); at += 16, ++count) {
                const std::string block = zlib(bytes.substr(at, 16));
                sizes += size(block.size());
                blocks += block;
            }
            return text(size(count) + size(16) + size(bytes.size() % 16) + sizes) + text(blocks);
        }
        return text(size(2) + size(16) + size(rest % 16) + size(first.size()) + size(last.size())) + text(first + last);
    }

    Writing writing_;
    std::string appended_;
};

class Vtu : public Builder {};

} // namespace

TEST_F(Vtu, of_all_encodings_has_the_same_tets_numbers_and_regions)
{
    const std::vector<Writing> writings = {{"ascii"},
                                           {"binary"},
                                           {"binary", true, false, true, true},
                                           {"binary", false},
                                           {"binary", true, true},
                                           {"raw"},
                                           {"raw", false, false, true},
                                           {"raw", true, true, true},
                                           {"base64"},
                                           {"base64", true, true},
                                           {"base64", false, true, true}};
    for (const Writing& writing : writings) {
        SCOPED_TRACE(fmt::format("{} {} {} {}", writing.format, writing.is_little, writing.is_compressed,
                                 writing.has_long_headers));
        const MeshSoup soup = parse_mesh("a.vtu", VtuText(writing).of_one_piece());
        EXPECT_EQ(soup.source_tets, (std::vector<SourceTet>{{1, 5}, {2, 6}}));
        EXPECT_EQ(soup.mesh.triangles.size(), 7u) << "six of the hull, and one between two regions";
        ASSERT_EQ(soup.mesh.vertices.size(), 5u);
        EXPECT_EQ(soup.mesh.vertices[1], (Float3{1, 0, 0}));
        const MeshSoup both = parse_mesh("stdin", VtuText(writing).of_two_pieces());
        EXPECT_EQ(both.source_tets, soup.source_tets);
        EXPECT_EQ(both.mesh.triangles.size(), 7u) << "vertices of two pieces at one place are one";
    }
}

TEST_F(Vtu, that_is_damaged_or_of_another_kind_is_refused_with_its_place)
{
    const auto changed = [](std::string text, const std::string& what, const std::string& into) {
        const auto at = text.find(what);
        EXPECT_NE(at, std::string::npos) << what;
        return text.replace(at, what.size(), into);
    };
    const std::string ascii = VtuText({"ascii"}).of_one_piece(), binary = VtuText({"binary"}).of_one_piece(),
                      packed = VtuText({"raw", true, true}).of_one_piece();
    const std::string array = "Name=\"Points\" NumberOfComponents=\"3\" format=\"binary\">\n  ";
    const struct {
        std::string text, what, into;
        std::vector<std::string> parts;
    } cases[] = {
        {ascii,
         "=\"UnstructuredGrid\"",
         "=\"PolyData\"",
         {"VTKFile (line 3)", "'PolyData', not Unstr", "meshio convert"}},
        {packed,
         "ZLib",
         "LZ4",
         {"compressed by vtkLZ4DataCompressor", "only zlib", "meshio convert FILE.vtu NEW.mesh"}},
        {ascii, "<UnstructuredGrid>", "<Grid>", {"no UnstructuredGrid"}},
        {ascii, "3 7 11", "3 2 11", {"cell 1", "offsets are wrong"}},
        {ascii, "3 7 11", "3 7 12", {"array connectivity (line", "it has 11 numbers and should have 12"}},
        {ascii, "2 1 3 4", "2 1 3 5", {"cell 2", "none of the 5 vertices"}},
        {ascii, "5 10 10", "5 10 12", {"cell 2", "its type is 12", "split them"}},
        {ascii, "8 5 6", "8 5.5 6", {"array Region (line", "5.5 is not a whole number"}},
        {ascii, "0 1 2 0", "0 1 x 0", {"array connectivity", "'x' is not a number"}},
        {ascii, "NumberOfCells='3'", "NumberOfCells='9999999999'", {"Piece (line", "2^32"}},
        {ascii, "NumberOfCells='3'", "NumberOfCells='-3'", {"Piece (line", "'-3', which is not a whole number"}},
        {ascii, "Name=\"types\"", "Name=\"kinds\"", {"array of types is missing"}},
        {ascii, "<Points>", "<Points", {"tag Points"}},
        {ascii, "</VTKFile>\n", "<a", {"a tag (line", "does not end"}},
        {binary, array, array + "!", {"a letter is not of base64"}},
        {binary, array, array + "/////w==", {"the file ends inside it"}},
        {packed, "encoding=\"raw\"", "encoding=\"hex\"", {"AppendedData (line", "not raw or base64"}},
        {packed, "  _", "  x", {"underscore"}},
        {packed, "  _", "  _xxxx", {"array"}},
        {packed,
         "Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"",
         "Name=\"Points\" format=\"appended\" offset=\"999",
         {"array Points", "begins after the end"}},
    };
    for (const auto& bad : cases)
        expect_error("a.vtu", changed(bad.text, bad.what, bad.into), bad.parts);
    for (std::size_t end = 1; end < packed.find("</AppendedData>") - 1; end += 7)
        EXPECT_NE(error_of([&] { (void)parse_mesh("a.vtu", packed.substr(0, end)); }), "") << "cut short at " << end;
}

TEST_F(Vtu, has_what_legacy_vtk_has_of_any_scene)
{
    const Scene cubes = make_cubes(4);
    export_tets(cubes, folder_ / "a.vtu");
    export_tets(cubes, folder_ / "a.vtk");
    const MeshSoup xml = read_mesh(folder_ / "a.vtu"), legacy = read_mesh(folder_ / "a.vtk");
    EXPECT_EQ(xml.tets, legacy.tets);
    EXPECT_EQ(xml.mesh.vertices, legacy.mesh.vertices);
    EXPECT_EQ(xml.source_tets, legacy.source_tets);
    const std::string text = read_text(folder_ / "a.vtu"), old = read_text(folder_ / "a.vtk");
    for (const std::string name : {"number", "triangle", "cost"}) {
        const auto values = [&](const std::string& whole, const std::string& head) {
            std::istringstream rest(whole.substr(whole.find(head) + head.size()));
            std::string line;
            std::getline(rest, line);
            if (whole == old) std::getline(rest, line); // LOOKUP_TABLE
            std::vector<std::string> lines;
            while (std::getline(rest, line) && line.find_first_of("<S") == std::string::npos)
                lines.push_back(line);
            return lines;
        };
        const auto found = values(text, "Name=\"" + name + "\"");
        EXPECT_GT(found.size(), cubes.tets.tets.size());
        EXPECT_EQ(found, values(old, "SCALARS " + name)) << name;
    }
}
