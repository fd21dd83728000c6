#pragma once

#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"
#include "core/rays/camera.h"
#include "core/rays/hit.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

struct DefectLaunch; // core/device/defects.h
struct LaunchParams; // core/device/launch.h

/// Where a launch's jobs write their results in its output: each job between GUARD_WORDS of its own before and after
/// them, one job after the other. All sizes are in words.
class OutputParts {
public:
    /// Each part begins at a multiple of it: 4096 bytes, which suits every API as the offset of a buffer's part.
    static constexpr std::size_t alignment = 1024;

    OutputParts() = default;
    /// rays: of each job. tally_words: of the sums that follow its rays' results.
    OutputParts(std::span<const std::size_t> rays, std::size_t words_per_ray, std::size_t tally_words = 0)
        : tally_words_(tally_words)
    {
        for (const std::size_t count : rays) {
            const std::size_t begin = (words() + alignment - 1) / alignment * alignment;
            parts_.push_back({begin, 2 * std::size_t{GUARD_WORDS} + words_per_ray * count + tally_words});
        }
    }

    /// Number of jobs.
    [[nodiscard]] std::size_t count() const { return parts_.size(); }
    /// The whole output.
    [[nodiscard]] std::size_t words() const { return parts_.empty() ? 0 : parts_.back().begin + parts_.back().size; }
    /// First guard word of a job: what its kernel is given as the output.
    [[nodiscard]] std::size_t begin(std::size_t job) const { return parts_[job].begin; }
    /// Of a job, with its guard words.
    [[nodiscard]] std::size_t size(std::size_t job) const { return parts_[job].size; }
    /// What a job writes in the whole output: its rays' results, then its sums.
    template <class Word>
    [[nodiscard]] std::span<Word> written(std::span<Word> output, std::size_t job) const
    {
        return output.subspan(begin(job) + GUARD_WORDS, size(job) - 2 * std::size_t{GUARD_WORDS});
    }
    /// A job's results of rays.
    template <class Word>
    [[nodiscard]] std::span<Word> results(std::span<Word> output, std::size_t job) const
    {
        const std::span<Word> all = written(output, job);
        return all.first(all.size() - tally_words_);
    }
    /// A job's sums.
    template <class Word>
    [[nodiscard]] std::span<Word> tally(std::span<Word> output, std::size_t job) const
    {
        return written(output, job).last(tally_words_);
    }

    friend bool operator==(const OutputParts&, const OutputParts&) = default;

private:
    struct Part {
        std::size_t begin, size;
        friend bool operator==(const Part&, const Part&) = default;
    };
    std::vector<Part> parts_;
    std::size_t tally_words_ = 0;
};

/// What a device's compiler made of a kernel.
struct CompiledCode {
    std::string compiler;                     ///< driver with version, and the device that it compiled for
    unsigned lanes = 0;                       ///< of a subgroup
    std::map<std::string, double> statistics; ///< under the names that the compiler gives them
    std::string text;                         ///< the code, one instruction per line; empty if the driver shows none
    std::string messages = {};                ///< of the compiler; ptxas's report with NVIDIA's OpenCL
};

/// A file for those who look into a kernel without this program.
struct KernelFile {
    std::string name;
    std::string what;    ///< a description, and what else compiling it needs; without a full stop
    std::string command; ///< that makes or compiles it without tetrace; empty if there is none
    std::string bytes;
};

/// A launch as plain data: all that a host needs that knows nothing of tetrace. case.h has it as
/// macros, for backends/<api>/run_case.c. The expected output is not a part of it.
struct LaunchCase {
    /// A file, and its entry in the macro INPUTS before its name: "buffer, 5".
    struct Input {
        std::string place;
        KernelFile file;
    };
    KernelFile program, host;       ///< host: run_case.c, with the command that compiles and runs it
    std::vector<std::string> lines; ///< "NAME VALUE" of the API's own macros
    std::vector<Input> inputs;
    std::uint32_t output = 0; ///< argument (OpenCL) or binding (Vulkan) of what the program writes
};

/// What a device computes on. Emulated: a GPU's API that runs on this machine's processor.
enum class DeviceKind { cpu, gpu, emulated };
/// As in results.
template <>
inline constexpr auto enum_names<DeviceKind> = names_up_to<DeviceKind::emulated>("cpu", "gpu", "emulated");

/// A device as its API describes it; usable, or with the reason why not and what to install.
struct Device {
    std::string name;
    DeviceKind kind = DeviceKind::cpu;
    std::string driver;         ///< driver or library, with version
    std::string implementation; ///< of the API, short, as in tests/expected/: "pocl-3.1", "lavapipe-22.3"
    std::string id;             ///< the name by which the user selects it: UUID, else PCI id, else the name
    std::string uuid;           ///< 32 lower-case hexadecimal digits, the same under every API; empty where unknown
    std::string pci;            ///< domain:bus:device.function, for example "0000:41:00.0"; empty where unknown
    std::string library;        ///< path of the driver's shared library; empty where there is none, or it is unknown
    std::uint64_t memory_bytes = 0;
    std::uint64_t max_buffer_bytes = 0; ///< the largest buffer that a kernel can be given; 0: memory is the limit
    unsigned max_group_items = 0;       ///< the most work items of a group; 0: does not apply
    unsigned group_width = 0;           ///< items or rays in lockstep (warp, subgroup, packet); 0: unknown, or none
    std::uint32_t max_steps = 0;        ///< longer walks may end early, without an error; 0: no limit
    double timer_period_s = 0;          ///< resolution of the clock that Session::wait reads; 0: unknown
    unsigned threads = 1;               ///< hardware threads or compute units
    bool usable = true;
    bool compile_only = false;     ///< not usable, but its driver compiles for it: hardware that is not here
    bool broken = false;           ///< not usable because its driver failed: its rows are errors, and not skipped
    std::string reason;            ///< why not, where not usable
    bool reports_code = false;     ///< its driver reports what it made of a kernel: Backend::compiled()
    std::uint64_t cache_bytes = 0; ///< of its largest cache; 0: unknown
};

/// What a session works on; the caller keeps it alive. `packed` is null for kernels that are not portable, which build
/// a structure from the mesh.
struct SceneData {
    const TriangleMesh* mesh = nullptr;
    const PackedScene* packed = nullptr;
};

/// The possible numbers of rays in a packet of schedule packets; each ray has a lane of a vector.
inline constexpr unsigned packet_widths[] = {4, 8, 16};

struct SessionOptions {
    unsigned threads = 0;                     ///< host threads; 0: all that the process may use
    unsigned tile_height = 0;                 ///< 4 or 8; 0: see tile_height_of()
    unsigned packet_lanes = 0;                ///< of schedule packets, one of packet_widths; 0: the widest there is
    std::uint64_t max_buffer_bytes = 0;       ///< limit to impose on the device's largest buffer; 0: none
    std::filesystem::path program_cache = {}; ///< folder for compiled kernels; empty: they are not kept
    /// A file that replaces the kernel's program: for opencl OpenCL C; for vulkan SPIR-V that reads the scene from
    /// storage buffers; for cuda what its driver loads; for cuda-host a shared object. Other backends do not read it.
    /// Empty: nothing is replaced.
    std::filesystem::path program_file = {};
};

/// Passes of a launch that may be in flight together (TraceJob::in_flight).
inline constexpr std::uint32_t max_in_flight = 8;

/// One image's worth of primary rays, or the rays that a session was given: see given_job(), search_job().
struct TraceJob {
    View view; ///< of primary rays
    std::uint32_t width = 0, height = 0;
    std::uint32_t start_tet = NO_TET; ///< tet that holds view.origin, in packed order; NO_TET: rays enter from outside
    StartTet start;                   ///< of start_tet, see start_in()
    std::uint32_t max_steps = 0;      ///< a walk with this many steps is LOST
    bool any_hit = false;             ///< any hit will do, so the first one found is the answer
    std::uint32_t passes = 1;         ///< how often the whole launch is traced, with the same hits each time
    std::uint32_t in_flight = 1;      ///< passes that may be on the device together, each with its own output

    [[nodiscard]] std::size_t rays() const { return std::size_t{width} * height; }
};

/// The cap of walks through this many tets: one step more than the number of tets, because a path visits none twice
/// (docs/spec/project.md, P6); less on a device with max_steps.
[[nodiscard]] std::uint32_t step_cap(std::uint64_t tets, const Device& device);

/// Lets the job's rays start in a tet.
/// tet: of the scene that was packed, as its mesh numbers them; NO_TET: rays enter from outside.
void start_in(TraceJob& job, const PackedScene& packed, const Scene& scene, std::uint32_t tet);

/// The job that traces all rays given to a session of task rays or segments: a column of tiles.
/// rays: their number, a multiple of TILE_WIDTH.
[[nodiscard]] TraceJob given_job(std::size_t rays, std::uint32_t max_steps, bool any_hit);

/// The job that searches the exits of all rays given to a session: a column of tiles.
/// rays: their number, a multiple of TILE_WIDTH.
[[nodiscard]] TraceJob search_job(std::size_t rays);

/// Seconds spent once per session, outside any kernel.
struct SetupTimes {
    double compile_s = 0;        ///< kernels compiled, or a BVH built
    double upload_s = 0;         ///< data copied to where the kernel reads it
    bool compile_cached = false; ///< the kernels came from SessionOptions::program_cache
    double build_s = 0;          ///< a BVH built by the device's driver, on the device's clock
};

/// Memory copied to memory, again and again: a level of caches that holds both buffers serves it.
struct CopyRate {
    std::uint64_t bytes = 0; ///< of both buffers together
    double bytes_per_s = 0;  ///< read and written
};

/// What a device can do at best; every row on the device is compared with it.
struct Yardstick {
    double copy_bytes_per_s = 0; ///< its memory copied to its memory, bytes read and written: the largest of `copies`
    double launch_s = 0;         ///< an empty kernel, from launch to the end of wait on the host's clock; median
    std::array<CopyRate, 6> copies = {}; ///< of ascending sizes; those of no bytes were not measured

    /// The rate of the level of memory that holds this many bytes: the best of the copies that are as large or larger,
    /// else that of the largest. Launching makes small copies slow on a GPU, so a larger one may be the best.
    [[nodiscard]] double copy_bytes_per_s_of(std::uint64_t bytes) const;
};

/// One scene on one device with one kernel. Every call throws Error, and only Error: unsupported where memory or a
/// limit is too small (reported with both numbers), driver where the device was lost or its driver failed, ended its
/// own process or never answered (core/isolation).
class Session {
public:
    virtual ~Session() = default;
    /// Tasks rays, search and segments: gives the device the rays of the following launches, in place of earlier rays.
    /// Call it before the first launch. quads: GIVEN_RAY_QUADS or RAY_QUADS a ray (kernels/layouts/layout.h), for a
    /// multiple of TILE_WIDTH rays. Throws Error{unsupported} with both numbers where the rays exceed the largest
    /// buffer.
    virtual void set_rays(std::span<const Quad> quads);
    /// Fills the whole output with POISON, untimed, then starts the kernel for every job. The jobs are in flight
    /// together: none waits for another's end. Uses several launches if one would run long enough for a watchdog to
    /// fire (core/device/launch.h). jobs: one or more, all with the same passes and in_flight. Passes that fit in one
    /// launch follow each other without the host, between two readings of the device's clock. A pass begins when the
    /// pass that is in_flight before it has ended, of all jobs; it writes to output number pass % in_flight. Throws
    /// Error{unsupported} if several are to be in flight, and the session traces on the host or sums up for each tet.
    void launch(std::span<const TraceJob> jobs);
    /// The same for one job.
    void launch(const TraceJob& job) { launch(std::span(&job, 1)); }
    /// Waits for the launch; returns device seconds of only the kernel, of all its jobs and passes together.
    [[nodiscard]] virtual double wait() = 0;
    /// Copies the hits of the last launch, job after job, row after row; hits.size(): the sum of width * height. If
    /// passes were in flight together, those of each output that has been written follow each other: min(passes,
    /// in_flight) times as many. Throws Error{wrong_result} if the kernel wrote outside its output.
    void read_back(std::span<Hit> hits);
    /// Task search: copies the faces that the last launch found, 0 to 3 or NO_EXIT, in the order of the rays.
    /// faces.size(): the number of rays. Throws Error{wrong_result} if the kernel wrote outside its output, or a word
    /// that is not a face.
    void read_back(std::span<std::uint32_t> faces);
    /// Task tally: the sum of the lengths of all rays in each tet, in packed order, as the last read_back() of hits has
    /// read it; of each pass alone. Empty for other tasks. Throws Error{wrong_result} if the passes have different
    /// sums.
    [[nodiscard]] std::vector<std::uint64_t> tally() const;
    /// The same as words of the output: two per tet, lower word first, counted from POISON, all passes together.
    [[nodiscard]] std::span<const std::uint32_t> tally_words() const { return tally_words_; }
    /// launch(), wait() and read_back(); returns device seconds.
    [[nodiscard]] double trace(std::span<const TraceJob> jobs, std::span<Hit> hits);
    [[nodiscard]] double trace(const TraceJob& job, std::span<Hit> hits) { return trace(std::span(&job, 1), hits); }
    /// The same for one job of task search.
    [[nodiscard]] double search(const TraceJob& job, std::span<std::uint32_t> faces);
    /// Seconds that copying the output took in the last read_back(), without its checks.
    [[nodiscard]] virtual double download_s() const { return download_s_; }
    [[nodiscard]] virtual SetupTimes setup_times() const = 0;
    /// Device bytes that the structure and its scene data occupy.
    [[nodiscard]] virtual std::uint64_t bytes() const = 0;

protected:
    /// Where the results of the last launch are in its output; start() may call it. If passes are in flight together,
    /// each has parts of its own for all jobs: those of pass p are from jobs * (p % in_flight) on.
    [[nodiscard]] OutputParts output_parts(std::size_t words_per_ray) const
    {
        return {job_rays_, words_per_ray, tally_words_.size()};
    }
    /// How many of these parts the last launch has written; the others are still POISON.
    [[nodiscard]] std::size_t written_parts() const
    {
        return job_rays_.size() / in_flight_ * std::min(passes_, in_flight_);
    }
    /// Number of rays of the parts that are written.
    [[nodiscard]] std::size_t written_rays() const;
    /// For the constructor of a session: its kernel's task may sum up for each tet.
    void make_tally(Task task, std::size_t tets);

private:
    template <class Result>
    void read_results(std::span<Result> results);
    /// launch(), whose jobs are as it says.
    virtual void start(std::span<const TraceJob> jobs) = 0;
    /// Copies the whole output, as output_parts() has it: words_per_ray() per ray, row after row, between guard words.
    virtual void read_output(std::span<std::uint32_t> words) = 0;

    std::vector<std::size_t> job_rays_; ///< of the last launch, of each part of its output
    std::vector<std::uint32_t> tally_words_;
    std::uint32_t passes_ = 1, in_flight_ = 1; ///< of the last launch
    double download_s_ = 0;
};

/// An API. Prints nothing, validates nothing, computes no statistics.
class Backend {
public:
    virtual ~Backend() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string clock() const = 0; ///< which clock Session::wait reads
    /// The devices, found once per process. Never empty: an API without devices has one that is not usable, with the
    /// reason and the package to install.
    [[nodiscard]] virtual const std::vector<Device>& devices() const = 0;
    /// Whether this build has the kernel for this API, regardless of what the host and its devices can run.
    [[nodiscard]] virtual bool has_kernel(const KernelId& kernel) const = 0;
    /// Empty if the kernel can run on the device (its index in devices()), else the reason.
    [[nodiscard]] virtual std::string why_not(std::size_t device, const KernelId& kernel) const = 0;
    [[nodiscard]] virtual std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel,
                                                        const SceneData& scene, const SessionOptions& options) = 0;
    /// Runs kernels/probe.h, one work item per quad of {operation, a, b, c}; returns one word per quad
    /// (core/device/self_test.h). Empty if the API runs none of our kernels.
    [[nodiscard]] virtual std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                           std::span<const Quad> operations) = 0;
    /// Measures the device, in about a second; empty if the API has neither memory nor launches of its own.
    [[nodiscard]] virtual std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) = 0;

    // For those who look into a driver or a compiler. A backend overrides what it can do. No driver is loaded for the
    // files and cases.

    /// The files of a kernel of that method and layout, in its math mode, for all tasks: texts, or code that a driver
    /// gets. Empty if there is none.
    [[nodiscard]] virtual std::vector<KernelFile> kernel_files(const KernelId&) const { return {}; }
    /// The launch of the tile number launch.first_tile, as such a device gets it (facts that are not known may be
    /// missing). kernel: portable, of task trace or rays. rays: those given, for task rays. program_file: as in
    /// SessionOptions. The output has the results of all rays of the launch, as OutputParts has them for one job. Empty
    /// if there is no host for the API.
    [[nodiscard]] virtual std::optional<LaunchCase> tile_case(const Device&, const KernelId&, const PackedScene&,
                                                              const LaunchParams&, std::span<const Quad>,
                                                              const std::filesystem::path& /*program_file*/) const
    {
        return std::nullopt;
    }
    /// That launch of the reduced kernel or stressor of that name (core/device/defects.h). Empty if there is no host
    /// for the API.
    [[nodiscard]] virtual std::optional<LaunchCase> defect_case(std::string_view, const DefectLaunch&) const
    {
        return std::nullopt;
    }
    /// Whether compiled() shows the code itself, of drivers that do.
    [[nodiscard]] virtual bool shows_code() const { return false; }
    /// What the device's driver made of a kernel, as sessions compile it for a GPU. The device need not be usable:
    /// compile_only is enough. kernel: without one, a kernel that needs next to no registers is compiled.
    /// starts_outside: of task trace, no ray starts in a tet. program_file: replaces the kernel's program under Vulkan,
    /// as in SessionOptions. Throws Error{unsupported} if the driver reports nothing of its code, Error{missing} if the
    /// device cannot be used, Error{driver} if it fails.
    [[nodiscard]] virtual CompiledCode compiled(std::size_t device, const std::optional<KernelId>& kernel,
                                                bool starts_outside, const std::filesystem::path& program_file) const;
    /// Whether run_defect() runs the reduced kernels of core/device/defects.h.
    [[nodiscard]] virtual bool runs_defects() const { return false; }
    /// Compiles the reduced kernel of that name and runs it; returns a word for each item. Throws Error as open() does.
    [[nodiscard]] virtual std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name,
                                                                const DefectLaunch& launch);
    /// Ends the processes of drivers, if they have some, so that the next sessions have drivers in a new state. No
    /// session may be open.
    virtual void restart() {}
};

/// Every backend of this build, in CMake's order; those that cannot run here say so in their devices.
[[nodiscard]] const std::vector<Backend*>& all_backends();

/// Null if there is none of this name.
[[nodiscard]] Backend* find_backend(std::string_view name, const std::vector<Backend*>& backends = all_backends());
/// Throws Error{internal} if there is none of this name.
[[nodiscard]] Backend& backend_named(std::string_view name, const std::vector<Backend*>& backends = all_backends());

/// The backend with whose answers all others' are compared; it runs on the host, on one device.
[[nodiscard]] Backend& reference_backend();

/// The backend whose rates those of the other APIs on one device are compared with, of a kind of devices.
[[nodiscard]] std::string reference_name(DeviceKind kind);

} // namespace tetrace
