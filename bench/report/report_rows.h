#pragma once

#include "bench/results/result_file.h"
#include "bench/rows/contest.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A row's speed with its spread; rates of the samples' quartiles.
struct RowRate {
    double mrays_per_s = 0, low = 0, high = 0;
    std::vector<double> samples; ///< Mrays/s of each sample
    std::optional<double> msteps_per_s, bytes_per_step;
    std::optional<double> ceiling_bytes_per_s; ///< of the level of memory that holds the scene; old results lack it
    std::optional<double> launch_share;        ///< launching and waiting, as a share of the wall time
};

/// A row on the page. Refers to its file.
struct ReportRow {
    std::size_t file = 0;  ///< its index on the command line
    std::size_t index = 0; ///< in its file
    const ResultRow* row = nullptr;
    Structure structure = Structure::cdt;
    std::string layout;
    std::string walk; ///< "maria tet80", and whatever differs from the defaults
    /// Empty if this program lacks the kernel: a page shows results of other versions too. That is why its rows are not
    /// RowRecords, for which read_rows() rejects such a result.
    std::optional<KernelId> known_kernel;
    std::string api; ///< "vulkan", "vulkan:1", "openmp, 1 thread"
    RayKind rays = RayKind::primary;
    Task task = Task::trace;                      ///< as options call it
    std::string device;                           ///< the row's, but of the processor the machine's name
    std::optional<double> enter_share, hit_share; ///< of its rays: that enter the domain, and that hit
    std::optional<RowRate> rate;                  ///< only of rows with a device

    [[nodiscard]] const std::string& name() const { return row->name; }
    /// "cdt maria tet80", as kernel_title().
    [[nodiscard]] std::string kernel() const { return subject() + " " + walk; }
    /// "bvh bvh2 on vulkan".
    [[nodiscard]] std::string label() const { return kernel() + " on " + api; }
    /// For a row with a device. Rows that may be ranked with each other ran on devices of one kind.
    [[nodiscard]] DeviceKind kind() const { return row->device_kind.value(); }
    /// Ends in the kind of rays where they are not primary.
    [[nodiscard]] std::string kernel_and_rays() const { return subject() + " " + walk_and_rays(); }
    [[nodiscard]] std::string walk_and_rays() const
    {
        return rays == RayKind::primary ? walk : walk + ", " + std::string(name_of(rays));
    }

private:
    [[nodiscard]] std::string subject() const
    {
        return std::string(task == Task::trace ? name_of(structure) : name_of(task));
    }
};

/// What Contest asks of a row. Precondition: the kernel is known.
[[nodiscard]] inline const KernelId& kernel_of(const ReportRow& row)
{
    return row.known_kernel.value();
}
[[nodiscard]] inline std::optional<double> mrays_of(const ReportRow& row)
{
    return row.rate ? std::optional(row.rate->mrays_per_s) : std::nullopt;
}

/// Rows of any file that do the same task for the same rays in the same scene on devices of one kind.
struct RowGroup {
    ResultScene scene;
    RayKind rays = RayKind::primary;
    Task task = Task::trace;
    DeviceKind kind = DeviceKind::cpu;
    std::vector<const ReportRow*> rows; ///< those with a rate, fastest first
};

/// All rows of a file. Throws Error{invalid_input} naming file and key where a rate or a time is not as
/// results/README.md describes.
[[nodiscard]] std::vector<ReportRow> report_rows(const ResultFile& result, std::size_t file);

/// Rows with a rate, grouped: by scene in order of appearance, then processors, GPUs, emulated devices.
[[nodiscard]] std::vector<RowGroup> rated_groups(const std::vector<ResultFile>& files,
                                                 const std::vector<ReportRow>& rows);

/// "random", "segments of random".
[[nodiscard]] std::string rays_text(RayKind rays, Task task);
/// "4 views of smoke at 1024 × 1024".
[[nodiscard]] std::string views_text(const ResultScene& scene);
/// "bunny: 4 views of smoke at 1024 × 1024, primary rays".
[[nodiscard]] std::string rays_title(const ResultScene& scene, std::string_view rays);

/// A result's name on the page: A, B, ... Z, then 27, 28, ...; empty if there is only one.
[[nodiscard]] std::string file_letter(std::size_t file, std::size_t files);

/// A title followed by that name: "bunny · A".
[[nodiscard]] std::string with_letter(const std::string& title, std::size_t file, std::size_t files);

/// "2026-11-21 17:34" of "2026-11-21T17:34:21Z".
[[nodiscard]] std::string minute_of(std::string date);

/// "processors", "GPUs", "emulated".
[[nodiscard]] const char* plural_of(DeviceKind kind);

} // namespace tetrace
