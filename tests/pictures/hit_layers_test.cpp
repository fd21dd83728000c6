// `render --picture hits`: what OpenImageIO reads from its file is what the kernel returned, bit for bit.
#include "bench/pictures/images.h"
#include "bench/rows/row_run.h"
#include "bench/rows/row_tracing.h"
#include "bench/rows/rows.h"
#include "bench/verbs/commands.h"
#include "scenes/build_scene.h"
#include "tests/support/temporary_folder.h"

#include <OpenImageIO/imageio.h>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The pixels of an .exr of hits, as the file stores them; none if it cannot be read, or has other channels.
std::vector<HitPixel> read_hits(const std::filesystem::path& path)
{
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input || input->spec().nchannels != 6) return {};
    const OIIO::ImageSpec& spec = input->spec();
    std::vector<HitPixel> pixels(spec.image_pixels());
    const auto read = [&](const std::string& name, OIIO::TypeDesc type, auto member_of) {
        const int channel = spec.channelindex(name);
        std::vector<std::uint32_t> words(pixels.size());
        if (channel < 0 || spec.channelformat(channel) != type ||
            !input->read_image(0, 0, channel, channel + 1, type, words.data()))
            return false;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            std::memcpy(&member_of(pixels[i]), &words[i], sizeof words[i]);
        return true;
    };
    const OIIO::TypeDesc real = OIIO::TypeDesc::FLOAT, whole = OIIO::TypeDesc::UINT32;
    const bool is_read = read(
                             "t", real, [](HitPixel & pixel) -> auto& { return pixel.t; }) &&
                         read(
                             "steps", whole, [](HitPixel & pixel) -> auto& { return pixel.steps; }) &&
                         read(
                             "normal.x", real, [](HitPixel & pixel) -> auto& { return pixel.normal.x; }) &&
                         read(
                             "normal.y", real, [](HitPixel & pixel) -> auto& { return pixel.normal.y; }) &&
                         read(
                             "normal.z", real, [](HitPixel & pixel) -> auto& { return pixel.normal.z; }) &&
                         read(
                             "face", whole, [](HitPixel & pixel) -> auto& { return pixel.face; });
    return is_read ? pixels : std::vector<HitPixel>{};
}

/// The same view, traced by the row that `render` chooses.
std::vector<Hit> hits_of_view(SceneWork& scene, const Options& options)
{
    RowRun row = open_row(select_rows(options, {scene.label()}).front(), scene, options);
    if (row.session == nullptr) throw std::runtime_error(reason_of(row));
    std::vector<Hit> hits(scene.rays_per_view());
    static_cast<void>(trace_view(row, 0, hits));
    return hits;
}

void expect_normal(Float3 normal, std::uint32_t face, const TriangleMesh& mesh, Double3 direction)
{
    const auto [a, b, c] = mesh.triangles[face];
    const Double3 origin = to_double(mesh.vertices[a]), wide = to_double(normal);
    EXPECT_NEAR(length(wide), 1, 1e-6); // three roundings to float
    for (const std::uint32_t other : {b, c}) {
        const Double3 edge = to_double(mesh.vertices[other]) - origin;
        EXPECT_NEAR(dot(wide, edge) / length(edge), 0, 1e-6);
    }
    EXPECT_LE(dot(wide, direction), 1e-6) << "it points to the viewer";
}

class HitsPicture : public testing::TestWithParam<const char*> {};

} // namespace

TEST_P(HitsPicture, has_each_hit_that_openmp_returns)
{
    const TemporaryFolder folder;
    const std::string path = folder / "hits.exr";
    const Options options =
        parse_options({"render", "--scene", "cubes", "--resolution", "6", "--size", "40x30", "--views", "1",
                       "--backend", "openmp", "--layout", GetParam(), "--picture", "hits", "--out", path});
    ASSERT_EQ(render_command(options), 0);
    SceneWork scene = load_work(scene_requests(options).front(), options);
    const TriangleMesh& mesh = scene.loaded().scene.mesh;
    const View view = scene.views().front();
    const auto hits = hits_of_view(scene, options);
    const auto pixels = read_hits(path);
    ASSERT_EQ(pixels.size(), 40u * 30u);
    ASSERT_EQ(pixels.size(), hits.size());
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < pixels.size(); ++i) {
        EXPECT_EQ(pixels[i].t, hits[i].t) << i;
        EXPECT_EQ(pixels[i].steps, hits[i].steps) << i;
        EXPECT_EQ(pixels[i].face, hits[i].face_id) << i;
        if (hits[i].face_id == NO_HIT) {
            EXPECT_EQ(pixels[i].normal, Float3{}) << i;
            continue;
        }
        const Double3 direction =
            to_double(view.corner) + to_double(view.step_x) * (i % 40) + to_double(view.step_y) * (i / 40);
        expect_normal(pixels[i].normal, hits[i].face_id, mesh, direction);
        ++found;
    }
    EXPECT_GT(found, 300u);
    EXPECT_LT(found, pixels.size()) << "some rays miss";
}

INSTANTIATE_TEST_SUITE_P(each, HitsPicture, testing::Values("half32", "bvh2"), [](const auto& i) { return i.param; });

TEST(HitLayers, name_the_triangles_of_the_meshs_file)
{
    if (find_builder().empty()) GTEST_SKIP() << "the builder was not built";
    const TemporaryFolder folder;
    write_file(folder / "own.off",
               "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 0 1\n3 0 1 2\n3 0 2 3\n"); // the first is without area
    const std::string path = folder / "hits.exr";
    const Options options = parse_options({"render", "--scene", folder / "own.off", "--effort", "0", "--size", "16",
                                           "--views", "0", "--backend", "openmp", "--picture", "hits", "--out", path});
    ASSERT_EQ(render_command(options), 0);
    std::set<std::uint32_t> faces;
    for (const HitPixel& pixel : read_hits(path))
        faces.insert(pixel.face);
    EXPECT_TRUE(faces.contains(1) || faces.contains(2));
    for (const std::uint32_t none : {0u, 3u})
        EXPECT_FALSE(faces.contains(none)) << none;
}

TEST(HitLayers, keep_their_bits_in_the_file)
{
    const TemporaryFolder folder;
    const float tiny = std::numeric_limits<float>::denorm_min();
    const HitLayers layers{3,
                           2,
                           {{0.1f, 16777217, {1, 0, 0}, 16777219}, // no float, and no half, has these
                            {0, 0, {}, NO_HIT},
                            {0, 70000, {}, LOST},
                            {tiny, 1, {0, -1, 0}, 0},
                            {1e30f, 2, {0, 0, 1}, 1},
                            {70000.5f, 3, {0.6f, 0, -0.8f}, 2}}};
    PictureWriter(".exr").write(folder / "hits.exr", layers);
    EXPECT_EQ(read_hits(folder / "hits.exr"), layers.pixels);
    EXPECT_TRUE(contains(error_of([&] { PictureWriter(".exr").write(folder / "none.exr", HitLayers{}); }),
                         "the picture is empty"));
}
