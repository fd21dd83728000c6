#include "scenes/catalogue.h"

#include "core/base/hash.h"
#include "scenes/mesh_files.h"
#include "scenes/procedural.h"
#include "tests/support/temporary_folder.h"

#include <set>
#include <sstream>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

const CatalogueEntry& row(const std::string& name)
{
    return *find_in_catalogue(name);
}

class Catalogue : public ::testing::Test {
protected:
    /// A data.tar.gz as the package has it, with these texts as meshes.
    void make_archive(const fs::path& target, const std::string& bunny, const std::string& armadillo)
    {
        write_file(folder / "tar/data/meshes/bunny00.off", bunny);
        write_file(folder / "tar/data/meshes/armadillo.off", armadillo);
        fs::create_directories(folder / "tar/data/meshes/folder.off");
        fs::create_directories(target.parent_path());
        ASSERT_EQ(std::system(("tar -C " + (folder / "tar").string() + " -czf " + target.string() + " data").c_str()),
                  0);
    }
    [[nodiscard]] std::string error_of_member(const std::string& member, std::size_t max_bytes = 1000)
    {
        return error_of([&] { (void)read_archive_member(archive, member, max_bytes); });
    }

    TemporaryFolder folder;
    ScopedVariable xdg{"XDG_CACHE_HOME", folder / "cache"};
    fs::path meshes = folder / "meshes", archive = folder / "meshes" / "data.tar.gz";
};

} // namespace

TEST_F(Catalogue, has_each_name_once)
{
    std::set<std::string> names;
    for (const CatalogueEntry& entry : catalogue())
        EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    for (const char* name : {"cubes", "banana", "bunny", "armadillo", "atrium", "city", "terrain", "spheres", "grass",
                             "plant", "nested", "field", "lattice"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST_F(Catalogue, labels_a_path_by_its_stem_and_a_row_by_its_name)
{
    EXPECT_EQ(scene_label("bunny"), "bunny");
    EXPECT_EQ(scene_label("lattice:138"), "lattice:138");
    EXPECT_EQ(scene_label("/some/where/dragon.v2.ply"), "dragon.v2");
    EXPECT_EQ(scene_label("some/\xff\x1b[2J\n.ply"), "??[2J?") << "of any name a text that can be shown";
}

TEST_F(Catalogue, prefers_a_mesh_in_the_folder_that_the_user_names)
{
    const ScopedVariable given("TETRACE_MESHES", meshes);
    make_archive(archive, "of the archive", "of the archive");
    write_file(meshes / "bunny.ply", "of the user");
    EXPECT_EQ(mesh_file(row("bunny")), meshes / "bunny.ply");
    EXPECT_EQ(read_text(mesh_file(row("armadillo"))), "of the archive");
    EXPECT_EQ(why_not_available("bunny"), "");
}

TEST_F(Catalogue, takes_the_first_of_a_mesh_s_names)
{
    const ScopedVariable given("TETRACE_MESHES", meshes);
    write_file(meshes / "bun_zipper.ply", "Stanford's own");
    write_file(meshes / "bunny00.off", "the one that results are of");
    EXPECT_EQ(mesh_file(row("bunny")), meshes / "bunny00.off");
}

TEST_F(Catalogue, finds_the_archive_in_an_unpacked_package)
{
    const ScopedVariable given("TETRACE_MESHES", meshes);
    make_archive(meshes / "usr/share/doc/libcgal-dev/data.tar.gz", "unpacked", "unpacked");
    EXPECT_EQ(read_text(mesh_file(row("bunny"))), "unpacked");
}

TEST_F(Catalogue, unpacks_a_member_once_and_a_newer_archive_again)
{
    const ScopedVariable given("TETRACE_MESHES", meshes);
    make_archive(archive, "old", "other");
    const fs::path old = mesh_file(row("bunny"));
    EXPECT_EQ(old.filename(), "bunny00.off");
    const auto written = fs::last_write_time(old);
    EXPECT_EQ(mesh_file(row("bunny")), old);
    EXPECT_EQ(fs::last_write_time(old), written);
    make_archive(archive, "newer", "other");
    EXPECT_EQ(read_text(mesh_file(row("bunny"))), "newer");
}

TEST_F(Catalogue, says_how_to_get_a_mesh_that_is_not_here)
{
    const ScopedVariable wrong("TETRACE_MESHES", folder / "none");
    const std::string reason = why_not_available("bunny");
    for (const char* part : {"scene bunny", "which is not a folder", "libcgal-demo", "apt-get download", "dpkg -x",
                             "TETRACE_MESHES", "bunny.ply"})
        EXPECT_TRUE(contains(reason, part));
    EXPECT_EQ(error_of([] { (void)mesh_file(row("bunny")); }), "missing: " + reason);
    EXPECT_EQ(default_scenes().front(), "cubes");
    EXPECT_TRUE(contains(why_not_available("/no/such/file.ply"), "neither a name of the catalogue nor a file"));
    EXPECT_EQ(why_not_available("cubes"), "");
    EXPECT_EQ(why_not_available("banana"), "");
    EXPECT_EQ(why_not_available("lattice:138"), "");
    EXPECT_EQ(why_not_available("city@5000"), "");
}

TEST_F(Catalogue, runs_bunny_armadillo_and_atrium_by_default)
{
    using Names = std::vector<std::string>;
    write_file(folder / "builder", "");
    fs::permissions(folder / "builder", fs::perms::owner_all);
    const ScopedVariable builder("TETRACE_BUILDER", folder / "builder");
    {
        const ScopedVariable missing("TETRACE_MESHES", folder / "none");
        EXPECT_EQ(default_scenes(), (Names{"cubes", "banana", "atrium"}));
        EXPECT_EQ(all_scenes(),
                  (Names{"cubes", "banana", "atrium", "city", "terrain", "spheres", "grass", "plant", "nested"}));
    }
    const ScopedVariable given("TETRACE_MESHES", meshes);
    make_archive(archive, "x", "y");
    EXPECT_EQ(default_scenes(), (Names{"bunny", "armadillo", "atrium"}));
    EXPECT_EQ(all_scenes(), (Names{"cubes", "banana", "bunny", "armadillo", "atrium", "city", "terrain", "spheres",
                                   "grass", "plant", "nested"}));
    const ScopedVariable no_builder("TETRACE_BUILDER", folder / "none");
    EXPECT_EQ(default_scenes(), (Names{"bunny", "armadillo"}));
}

TEST_F(Catalogue, refuses_a_damaged_archive)
{
    make_archive(archive, std::string(900, 'x'), "y");
    EXPECT_EQ(read_archive_member(archive, "data/meshes/bunny00.off", 1000).size(), 900u);
    EXPECT_TRUE(contains(error_of_member("data/meshes/none.off"), "lacks this member"));
    EXPECT_TRUE(contains(error_of_member("data/meshes/folder.off/"), "not a regular file"));
    EXPECT_TRUE(contains(error_of_member("data/meshes/bunny00.off", 899), "it has 900 bytes, at most 899"));
    const std::string bytes = read_text(archive);
    for (std::size_t length = 0; length < bytes.size() - 8; length += 13) { // the last 8 are gzip's own trailer
        write_file(archive, bytes.substr(0, length));
        const std::string error = error_of_member("data/meshes/none.off");
        EXPECT_TRUE(contains(error, "invalid_input: unpacking data/meshes/none.off from " + archive.string()))
            << length;
    }
    fs::remove(archive);
    EXPECT_TRUE(contains(error_of_member("data/meshes/bunny00.off"), "invalid_input: unpacking"));
}

TEST_F(Catalogue, writes_the_banana_so_that_it_reads_back_bit_for_bit)
{
    const TriangleMesh banana = make_banana();
    std::istringstream text(read_text(mesh_file(row("banana"))));
    std::string head;
    std::size_t vertices = 0, triangles = 0, edges = 0;
    text >> head >> vertices >> triangles >> edges;
    ASSERT_EQ(head, "OFF");
    ASSERT_EQ(vertices, banana.vertices.size());
    ASSERT_EQ(triangles, banana.triangles.size());
    TriangleMesh read;
    for (std::string x, y, z; read.vertices.size() < vertices && text >> x >> y >> z;)
        read.vertices.push_back({std::stof(x), std::stof(y), std::stof(z)});
    for (std::uint32_t n = 0, a = 0, b = 0, c = 0; text >> n >> a >> b >> c;)
        read.triangles.push_back({a, b, c});
    EXPECT_EQ(read, banana);
}

TEST_F(Catalogue, repairs_a_damaged_banana_file)
{
    const fs::path path = mesh_file(row("banana"));
    const std::string good = read_text(path);
    write_file(path, good.substr(0, 1000));
    EXPECT_EQ(read_text(mesh_file(row("banana"))), good);
}

// Debian 12 and 13 ship these very bytes.
TEST_F(Catalogue, finds_debian_s_meshes)
{
    const ScopedVariable unset("TETRACE_MESHES", nullptr);
    if (!why_not_available("bunny").empty()) GTEST_SKIP() << why_not_available("bunny");
    const std::string bunny = read_text(mesh_file(row("bunny"))), armadillo = read_text(mesh_file(row("armadillo")));
    EXPECT_TRUE(bunny.starts_with("OFF\n37706 75408 0\n"));
    EXPECT_TRUE(armadillo.starts_with("OFF\n26002 52000 0\n"));
    EXPECT_EQ(hash_text(hash_of(bunny)), "78924a553c61dc43");
    EXPECT_EQ(hash_text(hash_of(armadillo)), "cfd9a20c2f3456b8");
}
