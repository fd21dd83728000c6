#include "bench/pictures/cut.h"
#include "bench/pictures/false_colour.h"
#include "bench/pictures/images.h"
#include "bench/pictures/shading.h"
#include "bench/rows/row_run.h"
#include "bench/rows/row_tracing.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "scenes/export_tets.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>

namespace tetrace {

namespace {

std::vector<Picture> wanted_pictures(const Options& options)
{
    return options.pictures.empty() ? std::vector{Picture::normals} : options.pictures;
}

/// Writes the pictures of a run, all but hits in the same format, and prints the names of their files.
class PictureFiles {
public:
    explicit PictureFiles(const Options& options)
        : options_(&options), ending_(picture_ending(options.out, has_images_module())),
          writer_(writes_hits(options.pictures) ? ".exr" : ending_)
    {
    }

    /// picture: a Pixmap or HitLayers.
    template <class Image>
    void write(const PictureKey& key, bool only_picture, const Image& picture) const
    {
        const std::string ending = key.picture == Picture::hits ? ".exr" : ending_;
        const auto path = picture_path(options_->out, key, ending, only_picture);
        writer_.write(path, picture);
        print(path.string() + "\n");
    }

private:
    const Options* options_;
    std::string ending_;
    PictureWriter writer_;
};

/// The first row that the options select, with its session open: of BVHs where tets are missing and nobody asks for
/// them.
RowRun open_first_row(SceneWork& scene, const Options& options)
{
    Options chosen = options;
    if (scene.loaded().no_tets && options.structures.empty() && options.methods.empty() && options.layouts.empty())
        chosen.structures = {Structure::bvh};
    RowRun row = open_row(select_rows(chosen, {scene.label()}).front(), scene, chosen);
    if (row.session == nullptr)
        throw Error(ErrorKind::missing, fmt::format("rendering {}: {}", row_name(row.key), reason_of(row)));
    return row;
}

std::vector<Hit> trace(RowRun& row, std::size_t view)
{
    std::vector<Hit> hits(row.scene->rays_per_view(), Hit{POISON, NO_TET, 0, 0, 0, 0});
    static_cast<void>(row.session->trace(job_of(row, view), hits));
    return hits;
}

/// The row that crosses tets for these pictures: method project's unless another is named.
Options crossing_options(Options options, Task task)
{
    options.tasks = {task};
    if (task != Task::tally)
        options.rays = {RayKind::primary};
    else if (options.rays.empty())
        options.rays = {RayKind::random};
    if (options.methods.empty()) options.methods = {Method::project};
    return options;
}

/// The values at the pixels, in place of a hit's steps.
std::vector<Hit> values_at_pixels(RowRun& row, std::size_t view, const CrossedPicture& picture)
{
    std::vector<Hit> answers(ray_count(row, view), Hit{POISON, NO_TET, 0, 0, 0, 0});
    static_cast<void>(trace_view(row, view, answers));
    std::vector<Hit> pixels(row.scene->rays_per_view(), Hit{NO_HIT, NO_TET, 0, 0, 0, 0});
    for (std::size_t ray = 0; ray < answers.size(); ++ray) {
        Hit& pixel = pixels[pixel_of_ray(row, view, ray)];
        pixel.face_id = answers[ray].face_id;
        if (pixel.face_id != NO_HIT && pixel.face_id != LOST) pixel.steps = picture.value(answers[ray]);
    }
    return pixels;
}

void refuse_steps_without_tets(const RowRun& row, const std::vector<Picture>& pictures)
{
    for (const Picture picture : pictures)
        if (picture == Picture::steps && row.key.kernel.structure != Structure::cdt)
            throw row.scene->loaded().no_tets
                ? Error(ErrorKind::missing, fmt::format("--picture steps: {} has no tets", row.scene->label()))
                : Error(ErrorKind::usage,
                        fmt::format("--picture steps: {} counts no steps; use --structure cdt", row_name(row.key)));
}

/// Warns of lost rays, because a picture shows them only as a few magenta pixels, or as the number LOST.
void tell_lost_rays(const RowRun& row, std::size_t view, std::span<const Hit> hits)
{
    if (const std::uint64_t lost = count_rays(hits).lost; lost > 0)
        say(fmt::format("{}, view {}: {} rays are lost (magenta; face {} in hits)", row_name(row.key),
                        row.scene->view_numbers()[view], lost, LOST));
}

/// The task of the rows that cross tets for a picture; none for pictures of hits.
std::optional<Task> crossing_task(Picture picture)
{
    if (picture == Picture::tally) return Task::tally;
    const CrossedPicture* const crossed = crossed_picture(picture);
    return crossed != nullptr ? std::optional(crossed->task) : std::nullopt;
}

bool shows_hits(const Options& options)
{
    return std::ranges::any_of(wanted_pictures(options), [](Picture picture) { return !crossing_task(picture); });
}

/// A scene in each kind of tets asked for, with the row that traces it. Scenes whose tets are their own are one.
struct Subject {
    std::vector<std::unique_ptr<SceneWork>> scenes;
    std::vector<RowRun> rows;                          ///< that find hits, if a picture shows them
    std::map<Task, std::vector<RowRun>> crossing = {}; ///< rows of other tasks, opened when they are needed

    [[nodiscard]] const SceneWork& first() const { return *scenes.front(); }
};

Subject load_subject(const std::string& name, const Options& options)
{
    Subject subject;
    for (const TetsKind tets : options.tets) {
        Options one = options;
        one.scenes = {name};
        one.tets = {tets};
        one.rays = {RayKind::primary}; // others are a tally's
        auto scene = std::make_unique<SceneWork>(load_work(scene_requests(one).front(), one));
        const auto is_same = [&](const auto& other) { return other->loaded().hash == scene->loaded().hash; };
        if (std::ranges::any_of(subject.scenes, is_same)) continue;
        if (shows_hits(options)) subject.rows.push_back(open_first_row(*scene, one));
        subject.scenes.push_back(std::move(scene));
    }
    return subject;
}

std::string title_of(const RowRun& row, std::size_t view, bool names_tets)
{
    std::string title = fmt::format("{}, view {}", row.scene->label(), row.scene->view_numbers()[view]);
    if (names_tets) title += fmt::format(", {}", name_of(row.scene->loaded().scene.build.optimised.tets));
    return title;
}

/// Opens the rows of all pictures of what rays cross, before the first picture is written.
void open_crossing_rows(Subject& subject, const std::vector<Picture>& pictures, const Options& options)
{
    for (const Picture picture : pictures) {
        const std::optional<Task> task = crossing_task(picture);
        if (!task || !subject.crossing[*task].empty()) continue;
        for (const auto& scene : subject.scenes)
            subject.crossing[*task].push_back(open_first_row(*scene, crossing_options(options, *task)));
    }
}

/// The sums of the view's rays in the mesh's order.
std::vector<std::uint64_t> sums_of_view(RowRun& row, std::size_t view)
{
    std::vector<std::uint64_t> sums(row.scene->loaded().scene.tets.tets.size());
    std::vector<Hit> answers(ray_count(row, view), Hit{POISON, NO_TET, 0, 0, 0, 0});
    if (answers.empty()) return sums;
    static_cast<void>(trace_view(row, view, answers));
    tell_lost_rays(row, view, answers);
    const std::vector<std::uint64_t> packed = row.session->tally();
    std::ranges::transform(row.packed->data.packed_of_mesh, sums.begin(),
                           [&](std::uint32_t place) { return packed[place]; });
    return sums;
}

/// The sums of the view's rays on the cut, in each kind of tets.
std::vector<StepsImage> tally_all(Subject& subject, std::size_t view)
{
    std::vector<RowRun>& rows = subject.crossing[Task::tally];
    std::vector<StepsImage> images;
    for (RowRun& row : rows) {
        const SceneWork& scene = *row.scene;
        const auto tets = tets_on_cut(scene.loaded().scene, scene.views()[view], scene.width(), scene.height());
        images.push_back({tally_at_pixels(tets, sums_of_view(row, view), volumes_of(scene.loaded().scene)),
                          title_of(row, view, rows.size() > 1),
                          fmt::format("tally of {} rays, % of the mean", name_of(row.key.rays)), true});
    }
    return images;
}

/// What each ray of the view crosses in each kind of tets.
std::vector<StepsImage> cross_all(Subject& subject, std::size_t view, const CrossedPicture& picture)
{
    std::vector<RowRun>& rows = subject.crossing[picture.task];
    std::vector<StepsImage> images;
    for (RowRun& row : rows) {
        images.push_back({values_at_pixels(row, view, picture), title_of(row, view, rows.size() > 1), picture.what});
        tell_lost_rays(row, view, images.back().hits);
    }
    return images;
}

/// picture: one with a crossing_task().
std::vector<StepsImage> cross_for(Picture picture, Subject& subject, std::size_t view)
{
    return picture == Picture::tally ? tally_all(subject, view) : cross_all(subject, view, *crossed_picture(picture));
}

/// The view's rays in each kind of tets.
std::vector<StepsImage> trace_all(Subject& subject, std::size_t view)
{
    std::vector<StepsImage> images;
    for (RowRun& row : subject.rows) {
        images.push_back({trace(row, view), title_of(row, view, subject.rows.size() > 1)});
        tell_lost_rays(row, view, images.back().hits);
    }
    return images;
}

Pixmap draw(Picture picture, const std::vector<StepsImage>& images, const SceneWork& scene, std::size_t view)
{
    if (picture == Picture::steps) return draw_steps(images, scene.width(), scene.height());
    return shade_hits(images.front().hits, scene.views()[view], scene.width(), scene.height(),
                      scene.loaded().scene.mesh); // all kinds of tets show the same
}

HitLayers layers_of(const StepsImage& image, const SceneWork& scene, std::size_t view)
{
    const Scene& loaded = scene.loaded().scene;
    HitLayers layers = layers_of_hits(image.hits, scene.views()[view], scene.width(), scene.height(), loaded.mesh);
    for (HitPixel& pixel : layers.pixels)
        pixel.face = source_triangle(loaded, pixel.face);
    return layers;
}

void render_subject(Subject& subject, const Options& options, const PictureFiles& files, bool only_scene)
{
    const auto pictures = wanted_pictures(options);
    const SceneWork& scene = subject.first();
    const bool only_picture = only_scene && scene.views().size() == 1 && pictures.size() == 1;
    if (!subject.rows.empty()) refuse_steps_without_tets(subject.rows.front(), pictures);
    open_crossing_rows(subject, pictures, options);
    for (std::size_t view = 0; view < scene.views().size(); ++view) {
        progress_line().show("rendering " + scene.label(),
                             static_cast<double>(view) / static_cast<double>(scene.views().size()));
        const auto images = trace_all(subject, view);
        for (const Picture picture : pictures) {
            const PictureKey key{scene.label(), scene.view_numbers()[view], picture};
            if (picture == Picture::hits)
                files.write(key, only_picture, layers_of(images.front(), scene, view));
            else if (crossing_task(picture))
                files.write(key, only_picture,
                            draw_steps(cross_for(picture, subject, view), scene.width(), scene.height()));
            else
                files.write(key, only_picture, draw(picture, images, scene, view));
        }
    }
}

} // namespace

int render_command(const Options& options)
{
    check_picture_ending(options.out, options.pictures);
    const PictureFiles files(options); // first: without it, tracing is pointless
    for (const std::string& reason : missing_default_scenes(options))
        say(reason);
    const auto requests = scene_requests(options);
    for (const SceneRequest& request : requests) {
        Subject subject = load_subject(request.name, options);
        render_subject(subject, options, files, requests.size() == 1);
    }
    return 0;
}

} // namespace tetrace
