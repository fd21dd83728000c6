#include "scenes/scene_file.h"

#include "core/base/hash.h"
#include "scenes/procedural.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <random>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

// The header's layout, stated again: 32 bytes, seven sections of 48 bytes each, 8 bytes of checksum.
constexpr std::size_t version_at = 8, sections_at = 12, file_bytes_at = 16, table_at = 32, entry_bytes = 48,
                      table_entries = 7;
constexpr std::size_t checksum_at = table_at + table_entries * entry_bytes;
constexpr std::size_t offset_in_entry = 16, bytes_in_entry = 24, elements_in_entry = 32;
constexpr const char* section_names[] = {"information",  "mesh vertices", "triangles",   "origins",
                                         "tet vertices", "tets",          "domain lines"};

Scene sample_scene()
{
    Scene scene = make_cubes(3);
    scene.name = "a name with spaces, \u00ff and \"quotes\"";
    const OptimisedInfo optimised = {TetsKind::rays,
                                     TetsKind::cdt,
                                     "a \n reason",
                                     3,
                                     5.5,
                                     4.5,
                                     0.25,
                                     7,
                                     {{"moves", 8, 0.75, 0.5}, {"flips"}},
                                     OptimiserEnd::out_of_time};
    const RepairInfo repair = {true, 5, 6, 7, 8, 9, 0.5, 0.25};
    scene.build = {
        "file \"x\".off", 0x123456789ABCDEFu, "pq5Y", 3, "TetGen 1.5", 1.25, {10, -20, 0.1}, 0.5, -7, 1, 2, 3, 4,
        repair,           optimised};
    for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i)
        scene.origins.push_back(i / 2);
    return scene;
}

class SceneFile : public ::testing::Test {
protected:
    SceneFile()
    {
        write_scene(path, sample_scene());
        good = read_text(path);
    }
    /// What reading these bytes says.
    std::string error_with(const std::string& bytes)
    {
        write_file(path, bytes);
        return error_of([&] { (void)read_scene(path); });
    }
    std::uint64_t word(std::size_t at) const
    {
        std::uint64_t value = 0;
        std::memcpy(&value, good.data() + at, sizeof value);
        return value;
    }
    template <class Value>
    static void put(std::string& bytes, std::size_t at, Value value)
    {
        std::memcpy(bytes.data() + at, &value, sizeof value);
    }
    /// Makes a forged header's checksum right again.
    static std::string resealed(std::string bytes)
    {
        const std::uint64_t head = hash_of(bytes.substr(0, table_at));
        put(bytes, checksum_at, hash_of(bytes.substr(table_at, checksum_at - table_at), head));
        return bytes;
    }

    TemporaryFolder folder;
    std::filesystem::path path = folder / "scene.tet";
    std::string good;
};

std::string error_of_written(const std::filesystem::path& path, const Scene& scene)
{
    write_scene(path, scene);
    return error_of([&] { (void)read_scene(path); });
}

} // namespace

TEST_F(SceneFile, returns_what_was_written)
{
    EXPECT_EQ(read_scene(path), sample_scene());
}

TEST_F(SceneFile, writes_the_same_bytes_again)
{
    write_scene(folder / "again.tet", read_scene(path));
    EXPECT_EQ(read_text(folder / "again.tet"), good);
}

TEST_F(SceneFile, has_texts_that_can_be_shown_whoever_wrote_it)
{
    Scene scene = sample_scene();
    scene.name = "two\nlines\x1b[2J";
    scene.build.tool = "caf\xe9";
    write_scene(path, scene);
    EXPECT_EQ(read_scene(path).name, "two?lines?[2J");
    EXPECT_EQ(read_scene(path).build.tool, "caf?");
}

TEST_F(SceneFile, says_that_a_file_is_missing)
{
    EXPECT_TRUE(contains(error_of([&] { (void)read_scene(folder / "none.tet"); }), "missing: reading scene"));
    EXPECT_TRUE(contains(error_of([&] { (void)read_scene(folder.path()); }), "not a regular file"));
}

TEST_F(SceneFile, refuses_every_truncation)
{
    std::set<std::size_t> lengths = {0, 1, version_at, table_at, checksum_at};
    for (std::size_t i = 0; i < table_entries; ++i) {
        const std::size_t start = word(table_at + i * entry_bytes + offset_in_entry);
        for (const std::size_t length : {start - 1, start, start + 1})
            lengths.insert(length);
        for (std::size_t at = table_at + i * entry_bytes; at < table_at + (i + 1) * entry_bytes; at += 8)
            lengths.insert(at);
    }
    for (std::size_t length = 0; length < good.size(); length += 97)
        lengths.insert(length);
    lengths.insert(good.size() - 1);
    for (const std::size_t length : lengths) {
        const std::string error = error_with(good.substr(0, length));
        EXPECT_TRUE(contains(error, "invalid_input: reading scene " + path.string() + ": section `")) << length;
    }
}

TEST_F(SceneFile, refuses_what_follows_its_end)
{
    EXPECT_TRUE(contains(error_with(good + '\0'), "should have"));
    std::string forged = good + "x";
    put(forged, file_bytes_at, std::uint64_t{forged.size()});
    EXPECT_TRUE(contains(error_with(resealed(forged)), "1 bytes follow the last section"));
}

TEST_F(SceneFile, refuses_every_flipped_byte)
{
    const unsigned seed = 20240607;
    RecordProperty("seed", static_cast<int>(seed));
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 1000; ++i) {
        // Every other flip goes to header and table, which are small and decide about memory.
        const std::size_t at = random() % (i % 2 == 0 ? good.size() : checksum_at + 8);
        std::string bytes = good;
        bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + random() % 255));
        const std::string error = error_with(bytes);
        EXPECT_TRUE(contains(error, "invalid_input: reading scene " + path.string() + ": section `")) << "byte " << at;
    }
}

TEST_F(SceneFile, names_the_damaged_section)
{
    for (std::size_t i = 0; i < table_entries; ++i) {
        const std::size_t start = word(table_at + i * entry_bytes + offset_in_entry);
        std::string bytes = good;
        bytes[start] = static_cast<char>(bytes[start] ^ 0x10);
        EXPECT_TRUE(contains(error_with(bytes), std::string("section `") + section_names[i] + "`: its checksum"));
    }
}

TEST_F(SceneFile, says_which_version_wrote_it)
{
    std::string bytes = good;
    put(bytes, version_at, std::uint32_t{scene_file_version + 41});
    EXPECT_TRUE(
        contains(error_with(bytes), fmt::format("written by version {} of the format, this program reads version {}",
                                                scene_file_version + 41, scene_file_version)));
    EXPECT_TRUE(contains(error_with(bytes), "tetrace build"));
}

TEST_F(SceneFile, refuses_foreign_files)
{
    EXPECT_TRUE(contains(error_with("OFF\n8 12 0\n" + std::string(1000, '1')), "not a .tet file"));
}

// Forged headers with a right checksum: the sizes must still hold before anything is allocated for them.
TEST_F(SceneFile, allocates_nothing_for_forged_sizes)
{
    for (std::size_t i = 0; i < table_entries; ++i) {
        const std::size_t entry = table_at + i * entry_bytes;
        for (const std::uint64_t size :
             {std::uint64_t{48} << 40, ~std::uint64_t{0} - 47, word(entry + bytes_in_entry) + 48}) {
            std::string bytes = good;
            put(bytes, entry + bytes_in_entry, size);
            EXPECT_TRUE(contains(error_with(resealed(bytes)), std::string("section `") + section_names[i])) << size;
            bytes = good;
            put(bytes, entry + elements_in_entry, size);
            EXPECT_TRUE(contains(error_with(resealed(bytes)), std::string("section `") + section_names[i])) << size;
            bytes = good;
            put(bytes, entry + offset_in_entry, size);
            EXPECT_TRUE(contains(error_with(resealed(bytes)), "it is outside the file")) << size;
        }
    }
    std::string bytes = good;
    put(bytes, sections_at, std::uint32_t{8});
    EXPECT_TRUE(contains(error_with(resealed(bytes)), "it states 8 sections"));
}

TEST_F(SceneFile, refuses_another_scene_s_hash)
{
    std::string bytes = good;
    put(bytes, 24, word(24) ^ 1u);
    EXPECT_TRUE(contains(error_with(resealed(bytes)), "the scene's hash"));
}

// Files whose checksums are right, and whose content is not: as a faulty writer would make them.
TEST_F(SceneFile, refuses_content_that_no_scene_has)
{
    const Scene sample = sample_scene();
    Scene bad = sample;
    std::swap(bad.tets.tets[7].vertices[0], bad.tets.tets[7].vertices[1]);
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `tets`"));
    bad = sample;
    bad.tets.tets[7].neighbours[1] = 0x7FFFFFFFu;
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `tets`"));
    bad = sample;
    bad.tets.vertices[5].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `tet vertices`: vertex 5"));
    bad = sample;
    bad.mesh.vertices[2].x = 65;
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `mesh vertices`: vertex 2"));
    bad = sample;
    bad.mesh.triangles[3][1] = 1000000;
    EXPECT_TRUE(contains(error_of_written(path, bad), "triangle 3 names vertex 1000000"));
    bad = sample;
    bad.domain.lines[1][2] = bad.domain.lines[1][1];
    EXPECT_TRUE(contains(error_of_written(path, bad), "line 2 of axis 1"));
    bad = sample;
    bad.domain.divisions = 4;
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `domain lines`"));
    bad.domain.divisions = 0xFFFFFFFFu;
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `domain lines`"));
    bad = sample;
    bad.domain.kind = static_cast<DomainKind>(9);
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `information`"));
}

TEST_F(SceneFile, has_no_tets_only_if_none_are_expected)
{
    const Scene whole = sample_scene();
    Scene mesh_only = whole;
    mesh_only.tets = {};
    write_scene(path, mesh_only);
    EXPECT_EQ(read_scene(path, SceneFileKind::mesh_only), mesh_only);
    EXPECT_TRUE(contains(error_of([&] { (void)read_scene(path); }), "it is empty; every scene has some"));
    write_scene(path, whole);
    EXPECT_TRUE(contains(error_of([&] { (void)read_scene(path, SceneFileKind::mesh_only); }), "it is not empty"));
}

TEST_F(SceneFile, refuses_a_scene_of_nothing)
{
    const auto expect_empty = [&](const auto& spoil, const std::string& section) {
        Scene bad = sample_scene();
        spoil(bad);
        EXPECT_TRUE(contains(error_of_written(path, bad),
                             "reading scene " + path.string() + ": section `" + section + "`: it is empty"));
    };
    const auto free_all = [](Scene& s) {
        s.origins.clear();
        for (Tet& tet : s.tets.tets)
            tet.faces.fill(FREE_FACE);
        s.mesh.triangles.clear();
    };
    expect_empty(free_all, "triangles");
    const auto clear_mesh = [&](Scene& s) {
        free_all(s);
        s.mesh.vertices.clear();
    };
    expect_empty(clear_mesh, "mesh vertices");
    expect_empty([](Scene& s) { s.tets.tets.clear(); }, "tets");
    expect_empty([](Scene& s) { s.tets.vertices.clear(); }, "tet vertices");
}

TEST_F(SceneFile, has_an_origin_for_each_triangle_or_none)
{
    Scene scene = sample_scene();
    EXPECT_EQ(source_triangle(scene, 5), 2u);
    EXPECT_EQ(source_triangle(scene, NO_HIT), NO_HIT);
    scene.origins.pop_back();
    EXPECT_TRUE(contains(error_of_written(path, scene), "section `origins`"));
    scene.origins.clear();
    write_scene(path, scene);
    EXPECT_EQ(read_scene(path), scene);
    EXPECT_EQ(source_triangle(scene, 5), 5u);
}

TEST_F(SceneFile, refuses_a_triangle_that_no_face_covers)
{
    Scene bad = sample_scene();
    for (Tet& tet : bad.tets.tets)
        for (std::uint32_t& face : tet.faces)
            if (face == 1) face = FREE_FACE;
    const std::string error = error_of_written(path, bad);
    EXPECT_TRUE(contains(error, "invalid_input: reading scene " + path.string() + ": section `tets`: the faces that"));
    EXPECT_TRUE(contains(error, "(first: 1, 1 in all)"));
}

TEST_F(SceneFile, refuses_another_domain_than_the_tets_fill)
{
    Scene bad = sample_scene();
    bad.domain.lines[0].back() += 0.01f;
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `tets`: the tets' volumes sum to"));
    bad = sample_scene();
    for (float& line : bad.domain.lines[0])
        line += 0.25f; // as large, so that only the sides tell
    EXPECT_TRUE(contains(error_of_written(path, bad), "section `domain lines`: making the entry grid: tet"));
}

TEST_F(SceneFile, keeps_the_old_file_and_no_temporary_where_writing_fails)
{
    const std::string error = error_of([&] { write_scene(folder / "no/such/folder.tet", sample_scene()); });
    EXPECT_TRUE(contains(error, "invalid_input: writing " + (folder / "no/such/folder.tet").string()));
    std::filesystem::create_directories(folder / "taken.tet");
    EXPECT_TRUE(contains(error_of([&] { write_scene(folder / "taken.tet", sample_scene()); }), "renaming"));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    EXPECT_EQ(read_scene(path), sample_scene());
}

TEST_F(SceneFile, refuses_sides_that_rounding_could_fold)
{
    const auto expect_refused = [&](const Scene& scene, const std::string& reason) {
        const std::string error = error_of_written(path, scene);
        EXPECT_TRUE(contains(error, "invalid_input: reading scene " + path.string() + ": section `domain lines`: "))
            << error;
        EXPECT_TRUE(contains(error, reason)) << error;
        EXPECT_TRUE(contains(error, "make the file again")) << error;
    };
    Scene bent = make_cubes(3);
    const auto on_side = [](Float3 at) { return at.x == 1 && std::abs(at.y) < 1 && std::abs(at.z) < 1; };
    std::ranges::find_if(bent.tets.vertices, on_side)->x = std::nextafter(1.0f, 0.0f);
    expect_refused(bent, "has a boundary face that is on no side of the domain");

    Scene large = make_cubes(3);
    const auto doubled = [](Float3 at) { return Float3{2 * at.x, 2 * at.y, 2 * at.z}; };
    std::ranges::transform(large.mesh.vertices, large.mesh.vertices.begin(), doubled);
    std::ranges::transform(large.tets.vertices, large.tets.vertices.begin(), doubled);
    for (auto& lines : large.domain.lines)
        for (float& line : lines)
            line *= 2;
    expect_refused(large, "the domain exceeds [-1, 1] along axis x; scale mesh and domain by a power of two");

    const auto even = even_lines(4, 1);
    expect_refused(grid_of({even, even, {-1, -1 + 0x1p-20f, 0, 0.5f, 1}}),
                   "of the mesh is 9.53674e-07 away from the domain's low z side, rounding asks for");
    const auto fine = even_lines(8, 1);
    expect_refused(grid_of({fine, fine, {-1, -1 + 0x1p-20f, -0.5f, -0.25f, 0, 0.25f, 0.5f, 0.75f, 1}}),
                   "on the domain's low x side, has a height of 9.53674e-07, rounding asks for");
}
