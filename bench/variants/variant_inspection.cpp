#include "bench/variants/variant_inspection.h"

#include "bench/inspection/hipcc.h"
#include "bench/inspection/inspection.h"
#include "bench/inspection/null_hardware.h"
#include "bench/inspection/nvcc.h"
#include "bench/terminal/progress.h"
#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace tetrace {

namespace {

/// A target with the entry points of one program of its compiler.
struct InspectedProgram {
    Target target;
    std::vector<EntryPoint> points;

    [[nodiscard]] const KernelId& kernel() const { return points.front().kernel; }
    /// RADV gets a module for each task; of CUDA C++ the text is one program.
    [[nodiscard]] bool has(const EntryPoint& point) const
    {
        return point.kernel.method == kernel().method && point.kernel.layout == kernel().layout &&
               point.kernel.math == kernel().math && (target.maker != Maker::amd || point.kernel.task == kernel().task);
    }
};

std::vector<InspectedProgram> programs_of(const Options& options)
{
    std::vector<InspectedProgram> programs;
    for (const Target& target : targets_of(options.gpus))
        for (const EntryPoint& point : points_of(options, target)) {
            const auto found = std::ranges::find_if(programs, [&](const InspectedProgram& program) {
                return program.target.name == target.name && program.has(point);
            });
            if (found == programs.end())
                programs.push_back({target, {point}});
            else
                found->points.push_back(point);
        }
    return programs;
}

RowRecord record_of(const InspectedProgram& program)
{
    RowRecord record;
    record.key.kernel = program.kernel();
    record.key.backend = program.target.maker == Maker::amd ? "vulkan" : "cuda"; // whose text it is
    record.device.name = program.target.name;
    record.device.kind = DeviceKind::gpu;
    return record;
}

std::string name_of_program(const InspectedProgram& program)
{
    const KernelId& kernel = program.kernel();
    std::string name = fmt::format("{} {}", name_of(kernel.method), name_of(kernel.layout));
    if (kernel.math == MathMode::fast) name += " fast";
    if (program.target.maker == Maker::amd && kernel.task != Task::trace)
        name += fmt::format(" {}", name_of(kernel.task));
    return name;
}

/// Those that the targets need.
struct Compilers {
    Nvcc nvcc;
    Hipcc hipcc;
};

Compilers find_compilers(const std::vector<InspectedProgram>& programs)
{
    const auto needs = [&](Maker maker) {
        return std::ranges::any_of(programs, [&](const auto& program) { return program.target.maker == maker; });
    };
    return {needs(Maker::nvidia) ? find_nvcc() : Nvcc{}, needs(Maker::hip) ? find_hipcc() : Hipcc{}};
}

/// The variants of one program.
class InspectedTrials : public VariantTrials {
public:
    InspectedTrials(InspectedProgram program, const Compilers& compilers, const Options& options, const Budget& budget)
        : VariantTrials(record_of(program), name_of_program(program), program.target.name, options, budget),
          inspected_(std::move(program)), compilers_(&compilers), as_it_is_(ask({}, {}))
    {
        result_.spilling = 0;
        result_.row.device.driver = as_it_is_.front().compiler;
        for (const Inspected& row : as_it_is_)
            if (row.status != InspectedStatus::ok) {
                result_.reason = fmt::format("{}: {}", name_of(row.point), row.reason);
                result_.fails_as_it_is = row.status == InspectedStatus::error;
            }
        if (is_runnable()) find_program(result_.row.key.backend);
    }

private:
    /// text, program: in place of the kernel's own; RADV gets the program, the others the text.
    [[nodiscard]] std::vector<Inspected> ask(const std::string& text, const std::filesystem::path& program) const
    {
        const PartDone silent = [](double) {};
        const auto& [target, points] = inspected_;
        if (target.maker == Maker::nvidia) return ask_nvcc(compilers_->nvcc, target, points, {}, silent, text);
        if (target.maker == Maker::hip) return ask_hipcc(compilers_->hipcc, target, points, {}, silent, text);
        return ask_null_hardware(target, points, {}, silent, program);
    }

    [[nodiscard]] Seen look(const std::vector<std::size_t>& changes) override
    {
        const std::string text = program_->text().with(changes);
        std::filesystem::path program;
        try {
            if (inspected_.target.maker == Maker::amd) program = program_->write(text, folder_.path());
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::driver) throw;
            return {VariantSight::not_compiled, 0, {}, error.what(), false};
        }
        Seen seen;
        const std::vector<Inspected> rows = ask(text, program);
        for (std::size_t i = 0; i < rows.size() && seen.sight == VariantSight::right; ++i)
            judge(rows[i], as_it_is_[i], seen);
        return seen;
    }

    static void judge(const Inspected& row, const Inspected& as_it_is, Seen& seen)
    {
        if (row.status != InspectedStatus::ok) {
            seen.sight = VariantSight::not_compiled;
            seen.reason = fmt::format("{}: {}", name_of(row.point), row.reason);
        } else if (decides_fused(row) && !decides_fused(as_it_is)) {
            seen.sight = VariantSight::fused;
            seen.reason = fmt::format("{}: {}", name_of(row.point), row.first_fused);
        }
        seen.spills = seen.spills || (row.spills() && !as_it_is.spills());
    }

    InspectedProgram inspected_;
    const Compilers* compilers_;
    std::vector<Inspected> as_it_is_;
};

} // namespace

std::vector<VariantRow> inspect_variants(const Options& options, const Budget& budget)
{
    const auto programs = programs_of(options);
    if (programs.empty())
        throw Error(ErrorKind::usage, "inspect: no kernel has this combination of --structure, --method, --layout, "
                                      "--schedule, --math, --entry and --target");
    const Compilers compilers = find_compilers(programs);
    std::vector<std::unique_ptr<VariantTrials>> trials;
    for (const InspectedProgram& program : programs) {
        if (!trials.empty() && budget.left_s() <= 0) break; // the others have not even been compiled as they are
        const double done = static_cast<double>(trials.size()) / static_cast<double>(programs.size());
        progress_line().show("compiling", done, -1, name_of_program(program) + " for " + program.target.name);
        trials.push_back(std::make_unique<InspectedTrials>(program, compilers, options, budget));
    }
    return run_trials(trials, options, budget);
}

} // namespace tetrace
