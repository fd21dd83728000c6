#include "bench/output/array_folder.h"

#include "bench/results/npy.h"
#include "bench/rows/row_tracing.h"
#include "core/base/files.h"
#include "core/rays/absorbed.h"
#include "core/rays/segments.h"
#include "scenes/export_tets.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace tetrace {

namespace {

/// In place of a number: none, and that of a walk that was lost.
constexpr std::int32_t no_number = -1, lost_number = -2;

std::string array_name(const RowKey& key)
{
    std::string name = row_name(key);
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == ':' || c == '/'; }, '-');
    return name;
}

template <class Value>
NpyColumn column(const char* name, std::size_t count, const Value& value)
{
    std::vector<decltype(value(std::size_t{0}))> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = value(i);
    return {name, std::move(values)};
}

/// A row's rays of a view as columns: where each comes from, and its answer.
class RayColumns {
public:
    explicit RayColumns(const SeenImage& image)
        : image_(&image), scene_(&image.row.scene->loaded().scene), rays_(image.hits.size())
    {
        if (image.row.key.kernel.structure == Structure::cdt)
            mesh_of_packed_ = inverse_of(image.row.packed->data.packed_of_mesh);
    }

    std::vector<NpyColumn> all()
    {
        add("pixel", [this](std::size_t i) { return pixel_of_ray(image_->row, image_->view, i); });
        const Task task = image_->row.key.kernel.task;
        if (traits_of(task).takes_rays) add_rays();
        if (traits_of(task).absorbs)
            add_absorbed();
        else if (traits_of(task).crosses)
            add_segments();
        else
            add_hits();
        return std::move(columns_);
    }

private:
    template <class Value>
    void add(const char* name, const Value& value)
    {
        columns_.push_back(column(name, rays_, value));
    }
    template <class Answer, class Of>
    void add(const char* name, Of of, std::uint32_t Answer::*member)
    {
        add(name, [this, of, member](std::size_t i) { return of(image_->hits[i]).*member; });
    }
    template <class Answer, class Of>
    void add_tets(Of of)
    {
        for (const auto& [name, member] : {std::pair("first", &Answer::first), std::pair("last", &Answer::last)})
            add(name, [this, of, member](std::size_t i) { return tet(of(image_->hits[i]).*member); });
    }

    /// In the scene's order.
    [[nodiscard]] std::int32_t tet(std::uint32_t packed) const
    {
        if (packed < mesh_of_packed_.size()) return static_cast<std::int32_t>(mesh_of_packed_[packed]);
        return packed == LOST ? lost_number : no_number;
    }
    [[nodiscard]] std::int32_t triangle(std::uint32_t face_id) const
    {
        if (face_id == LOST) return lost_number;
        return face_id < scene_->mesh.triangles.size() ? static_cast<std::int32_t>(source_triangle(*scene_, face_id))
                                                       : no_number;
    }

    /// In the units of the mesh.
    void add_rays()
    {
        const RowKey& key = image_->row.key;
        const RaySet& set =
            image_->row.scene->given_rays().set(*image_->row.scene, key.rays, key.ray_order, image_->view);
        const BuildInfo& build = scene_->build;
        const double unit = std::ldexp(1.0, -build.scale_exponent);
        static constexpr std::array axes{&Float3::x, &Float3::y, &Float3::z};
        static constexpr std::array origins{"ox", "oy", "oz"}, directions{"dx", "dy", "dz"};
        const std::array centre{build.centre.x, build.centre.y, build.centre.z};
        for (std::size_t k = 0; k < axes.size(); ++k)
            add(origins[k], [&](std::size_t i) { return double{set.rays[i].origin.*axes[k]} * unit + centre[k]; });
        for (std::size_t k = 0; k < axes.size(); ++k)
            add(directions[k], [&](std::size_t i) { return double{set.rays[i].direction.*axes[k]} * unit; });
    }

    void add_segments()
    {
        add_tets<Segments>(segments_of);
        add("crossings", segments_of, &Segments::crossings);
        add("reversed", segments_of, &Segments::reversed);
        add("hash", segments_of, &Segments::hash);
        add("units", segments_of, &Segments::length);
        const double unit = std::ldexp(1.0, -scene_->build.scale_exponent);
        add("length", [&](std::size_t i) { return length_of(segments_of(image_->hits[i]).length) * unit; });
    }

    void add_absorbed()
    {
        add_tets<Absorbed>(absorbed_of);
        add("crossings", absorbed_of, &Absorbed::crossings);
        add("hash", absorbed_of, &Absorbed::hash);
        add("light", [this](std::size_t i) { return share_of_light(absorbed_of(image_->hits[i]).light); });
        add("transmittance",
            [this](std::size_t i) { return share_passed(absorbed_of(image_->hits[i]).transmittance); });
    }

    void add_hits()
    {
        add("face", [this](std::size_t i) { return triangle(image_->hits[i].face_id); });
        add("tet", [this](std::size_t i) { return tet(image_->hits[i].tet); });
        for (const auto& [name, member] : {std::pair("t", &Hit::t), std::pair("u", &Hit::u), std::pair("v", &Hit::v)})
            add(name, [this, member](std::size_t i) { return image_->hits[i].*member; });
        add("steps", [this](std::size_t i) { return image_->hits[i].steps; });
    }

    const SeenImage* image_;
    const Scene* scene_;
    std::size_t rays_;
    std::vector<std::uint32_t> mesh_of_packed_;
    std::vector<NpyColumn> columns_;
};

/// The sums in the order of the scene's tets, with what the user calls these.
std::vector<NpyColumn> tally_columns(const Scene& scene, std::span<const std::uint32_t> packed_of_mesh,
                                     const std::vector<std::uint64_t>& sums)
{
    const std::size_t tets = sums.size();
    std::vector<NpyColumn> columns;
    std::vector<std::int64_t> numbers = numbers_of(scene);
    if (scene.source_tets.empty()) std::iota(numbers.begin(), numbers.end(), 0);
    columns.push_back({"number", std::move(numbers)});
    columns.push_back({"region", regions_of(scene)});
    columns.push_back({"volume", volumes_of(scene)});
    columns.push_back(column("units", tets, [&](std::size_t i) { return sums[packed_of_mesh[i]]; }));
    columns.push_back(column("length", tets, [&](std::size_t i) {
        return std::ldexp(length_of(sums[packed_of_mesh[i]]), -scene.build.scale_exponent);
    }));
    return columns;
}

} // namespace

ArrayFolder::ArrayFolder(std::filesystem::path folder) : folder_(std::move(folder))
{
    std::error_code problem;
    std::filesystem::create_directories(folder_, problem);
    if (!std::filesystem::is_directory(folder_))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--out-arrays: the folder '{}' cannot be made: {}; name another one", folder_.string(),
                                problem ? problem.message() : "a file has that name"));
    require_writable(folder_ / "rays.npy");
}

void ArrayFolder::see(const SeenImage& image)
{
    if (image.hits.empty()) return; // given rays, of which this view has none
    const std::string name = array_name(image.row.key);
    const std::uint32_t view = image.row.scene->view_numbers()[image.view];
    write_npy(folder_ / fmt::format("{}-view{}.npy", name, view), RayColumns(image).all());
    if (traits_of(image.row.key.kernel.task).tallies) add_tally(image, name);
}

void ArrayFolder::add_tally(const SeenImage& image, const std::string& name)
{
    const std::vector<std::uint64_t> tally = image.row.session->tally();
    std::vector<std::uint64_t>& sums = sums_[name];
    sums.resize(tally.size());
    for (std::size_t i = 0; i < tally.size(); ++i)
        sums[i] += tally[i];
    if (image.view != last_view_with_rays(image.row)) return;
    write_npy(folder_ / fmt::format("{}-tets.npy", name),
              tally_columns(image.row.scene->loaded().scene, image.row.packed->data.packed_of_mesh, sums));
    sums_.erase(name);
}

std::unique_ptr<ArrayFolder> make_array_folder(const Options& options)
{
    if (!options.array_folder) return nullptr;
    const auto reject = [](const char* why) { throw Error(ErrorKind::usage, why); };
    if (options.resume)
        reject("--resume: --out-arrays would lack the views that were traced before; leave one of them out");
    if (!shard_of(options).is_whole())
        reject("--out-arrays: a shard has some of the views, and no sums of all; leave out --shard");
    if (options.repeat > 1) reject("--repeat: --out-arrays has each view once; leave one of them out");
    return std::make_unique<ArrayFolder>(*options.array_folder);
}

} // namespace tetrace
