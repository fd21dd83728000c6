// What is written of all tets of a ray: arrays by --out-arrays, pictures by `render`.
#include "tests/support/program_fixture.h"

#include <cstring>
#include <numeric>
#include <regex>

using namespace tetrace::test;

namespace {

/// The columns of a .npy file of records, by the names in its header.
class Records {
public:
    explicit Records(std::string bytes) : bytes_(std::move(bytes))
    {
        static const std::regex field(R"(\('([a-z]+)', '<[iuf]([48])'\))"), shape(R"('shape': \(([0-9]+),\))");
        const std::size_t head =
            10 + static_cast<unsigned char>(bytes_[8]) + 256 * static_cast<unsigned char>(bytes_[9]);
        const std::string header = bytes_.substr(10, head - 10);
        for (std::sregex_iterator at(header.begin(), header.end(), field), end; at != end; ++at) {
            offsets_[(*at)[1]] = head + size_;
            size_ += std::stoul((*at)[2]);
        }
        std::smatch found;
        if (std::regex_search(header, found, shape)) rows_ = std::stoul(found[1]);
        EXPECT_EQ(bytes_.size(), head + rows_ * size_) << header;
    }

    template <class Number>
    std::vector<Number> column(const std::string& name) const
    {
        std::vector<Number> values(rows_);
        for (std::size_t i = 0; i < rows_; ++i)
            std::memcpy(&values[i], bytes_.data() + offsets_.at(name) + i * size_, sizeof(Number));
        return values;
    }

private:
    std::string bytes_;
    std::map<std::string, std::size_t> offsets_;
    std::size_t size_ = 0, rows_ = 0;
};

class Arrays : public ProgramTest {
protected:
    Records records(const std::string& name) const { return Records(file(("arrays/" + name + ".npy").c_str())); }
};

} // namespace

TEST_F(Arrays, of_own_tets_have_the_users_numbers_and_sums_that_are_those_of_the_rays)
{
    write_file(folder_ / "own.mesh",
               "MeshVersionFormatted 2\nDimension 3\nVertices\n6\n0 0 0 0\n4 0 0 0\n0 4 0 0\n0 0 4 0\n4 4 4 0\n-4 -4 "
               "2 0\nTetrahedra\n3\n1 2 3 4 7\n3 2 4 5 9\n1 3 4 6 7\nEnd\n");
    const Ended ended = run("check --scene own.mesh --task segments,tally,absorb,trace --layout half32 --rays random "
                            "--schedule tiles --size 32 --views 0,1 --backend openmp --out-arrays arrays");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "Arrays    arrays")) << ended.out;
    const std::string name = "-project-half32-own-random-math-exact-api-openmp";
    const Records tets = records("tally" + name + "-tets");
    const auto numbers = tets.column<std::int64_t>("number");
    ASSERT_GT(numbers.size(), 3u);
    EXPECT_EQ(std::vector(numbers.begin(), numbers.begin() + 4), (std::vector<std::int64_t>{1, 2, 3, -1}));
    const auto regions = tets.column<std::int64_t>("region");
    EXPECT_EQ(std::vector(regions.begin(), regions.begin() + 4), (std::vector<std::int64_t>{7, 9, 7, 0}));
    const auto volumes = tets.column<double>("volume");
    EXPECT_NEAR(volumes[0], 64.0 / 6, 1e-6) << "in the mesh's units";

    std::uint64_t units = 0;
    double length = 0;
    for (const std::string view : {"0", "1"}) {
        const Records rays = records("tally" + name + "-view" + view),
                      same = records("segments" + name + "-view" + view);
        const auto of_rays = rays.column<std::uint32_t>("units");
        EXPECT_EQ(of_rays.size(), 32u * 32);
        units = std::accumulate(of_rays.begin(), of_rays.end(), units);
        const auto lengths = rays.column<double>("length");
        length = std::accumulate(lengths.begin(), lengths.end(), length);
        EXPECT_EQ(rays.column<std::uint32_t>("hash"), same.column<std::uint32_t>("hash"));
        for (const std::int32_t tet : rays.column<std::int32_t>("first"))
            EXPECT_TRUE(tet >= -1 && tet < static_cast<std::int32_t>(numbers.size())) << tet;
    }
    const auto sums = tets.column<std::uint64_t>("units");
    EXPECT_EQ(std::accumulate(sums.begin(), sums.end(), std::uint64_t{0}), units);
    const auto of_tets = tets.column<double>("length");
    EXPECT_NEAR(std::accumulate(of_tets.begin(), of_tets.end(), 0.0), length, 1e-9 * length);

    const Records light = records("absorb" + name + "-view0"), hits = records("cdt" + name + "-view0");
    for (const double share : light.column<double>("transmittance"))
        EXPECT_TRUE(share >= 0 && share <= 1) << share;
    const auto faces = hits.column<std::int32_t>("face");
    const auto t = hits.column<float>("t");
    const auto oz = hits.column<double>("oz"), dz = hits.column<double>("dz");
    std::size_t hit = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (faces[i] < 0) continue;
        ++hit;
        const double z = oz[i] + static_cast<double>(t[i]) * dz[i];
        EXPECT_TRUE(z > -1e-4 && z < 4 + 1e-4) << "in the mesh's units: " << z;
    }
    EXPECT_GT(hit, 50u);
}

TEST_F(Arrays, of_tets_for_rays_in_a_files_regions_have_the_same_sum_in_each_region)
{
    ASSERT_EQ(run("build --scene lattice:6 --size 16 --views 0 --out grid.mesh").code, 0);
    std::map<std::string, std::map<std::int64_t, std::uint64_t>> sums;
    std::map<std::string, std::size_t> tets;
    for (const std::string kind : {"cdt", "rays"}) {
        const Ended ended =
            run("check --scene grid.mesh --task tally --layout half32 --rays random --size 32 --views 0 "
                "--backend openmp --out-arrays arrays --tets " +
                kind);
        ASSERT_EQ(ended.code, 0) << ended.errors;
        EXPECT_EQ(contains(ended.errors, "so a tally is by region"), kind == "rays") << ended.errors;
        const Records sum = records("tally-project-half32-grid-random-math-exact-api-openmp-tets");
        const auto regions = sum.column<std::int64_t>("region"), numbers = sum.column<std::int64_t>("number");
        const auto units = sum.column<std::uint64_t>("units");
        tets[kind] = units.size();
        EXPECT_EQ(numbers[0], kind == "rays" ? -1 : 1);
        for (std::size_t i = 0; i < units.size(); ++i)
            sums[kind][regions[i]] += units[i];
    }
    EXPECT_LT(tets["rays"], tets["cdt"]);
    ASSERT_GT(sums["cdt"].size(), 3u);
    EXPECT_EQ(sums["rays"].size(), sums["cdt"].size());
    for (const auto& [region, units] : sums["cdt"])
        EXPECT_EQ(region < 0 ? units : sums["rays"][region], units) << "places on faces between regions are the same";
    const Ended usual = run("build --scene grid.mesh --size 16 --views 0");
    EXPECT_TRUE(contains(usual.out, "cdt")) << "a file's tets are data: " << usual.out;
}

TEST_F(Arrays, are_refused_before_the_run_if_they_cannot_be_written_or_would_not_be_whole)
{
    write_file(folder_ / "taken", "");
    const std::string check = "check --scene cubes --size 8 --views 0 --backend openmp --out-arrays ";
    const Ended taken = run(check + "taken");
    EXPECT_EQ(taken.code, 2);
    EXPECT_TRUE(contains(taken.errors, "--out-arrays: the folder 'taken' cannot be made")) << taken.errors;
    for (const std::string other : {"--resume --out a.json", "--repeat 2", "--shard 1/2 --views 1 --out a.json"}) {
        const Ended ended = run(check + "arrays " + other);
        EXPECT_EQ(ended.code, 2) << other;
        EXPECT_TRUE(contains(ended.errors, "--out-arrays")) << ended.errors;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "arrays")) << other;
    }
}

TEST_F(Arrays, pictures_of_crossings_depth_light_and_a_tally_are_drawn_for_each_kind_of_tets)
{
    const Ended ended = run("render --scene cubes --resolution 6 --size 64 --views 0 --picture "
                            "steps,crossings,depth,light,tally --rays diffuse --out a.ppm");
    ASSERT_EQ(ended.code, 0) << ended.errors;
    std::map<std::string, std::string> pictures;
    for (const std::string kind : {"steps", "crossings", "depth", "light", "tally"})
        pictures[kind] = file(("a-cubes-0-" + kind + ".ppm").c_str());
    for (const auto& [a, bytes] : pictures) {
        EXPECT_TRUE(bytes.starts_with("P6")) << a;
        for (const auto& [b, other] : pictures)
            EXPECT_EQ(bytes == other, a == b) << a << " and " << b;
    }
    const Ended bvh =
        run("render --scene cubes --resolution 6 --size 8 --views 0 --layout bvh2 --picture light --out b.ppm");
    EXPECT_EQ(bvh.code, 2) << bvh.errors;
    EXPECT_EQ(run("render --scene cubes --picture steps --rays random").code, 2) << "only a tally has other rays";
}
