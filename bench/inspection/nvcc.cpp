#include "bench/inspection/nvcc.h"

#include "backends/cuda/driver_backend.h"
#include "bench/inspection/compiler.h"
#include "bench/inspection/work_folder.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"
#include "core/device/launch.h"
#include "core/device/session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

namespace tetrace {

namespace {

struct Multiprocessor {
    unsigned capability;
    std::uint64_t warps, blocks, shared_kib; ///< the most
};

constexpr std::array multiprocessors = {
    Multiprocessor{70, 64, 32, 96},   Multiprocessor{72, 64, 32, 96},   Multiprocessor{75, 32, 16, 64},
    Multiprocessor{80, 64, 32, 164},  Multiprocessor{86, 48, 16, 100},  Multiprocessor{87, 48, 16, 164},
    Multiprocessor{89, 48, 24, 100},  Multiprocessor{90, 64, 32, 228},  Multiprocessor{100, 64, 32, 228},
    Multiprocessor{103, 64, 32, 228}, Multiprocessor{110, 48, 24, 228}, Multiprocessor{120, 48, 24, 100},
    Multiprocessor{121, 48, 24, 100},
};

constexpr std::uint64_t registers_of_part = 65'536 / 4;

} // namespace

std::optional<Warps> resident_warps(unsigned capability, std::uint64_t registers, std::uint64_t block,
                                    std::uint64_t shared_bytes)
{
    const auto found = std::ranges::find(multiprocessors, capability, &Multiprocessor::capability);
    if (found == multiprocessors.end() || registers == 0 || block == 0) return std::nullopt;
    constexpr std::uint64_t lanes = 32, unit = 256, parts = 4;
    const std::uint64_t of_warp = (registers * lanes + unit - 1) / unit * unit;
    const std::uint64_t by_registers = registers_of_part / of_warp * parts;
    const std::uint64_t of_block = (block + lanes - 1) / lanes;
    const std::uint64_t reserved = capability >= 80 ? 1024 : 0;
    const std::uint64_t by_shared =
        shared_bytes == 0 ? found->blocks : found->shared_kib * 1024 / (shared_bytes + reserved);
    const std::uint64_t blocks = std::min({by_registers / of_block, found->blocks, by_shared});
    return Warps{std::min(blocks * of_block, found->warps / of_block * of_block), found->warps};
}

namespace {

namespace fs = std::filesystem;

/// The folders of the toolkits' programs, after those of PATH.
std::vector<fs::path> toolkit_folders()
{
    std::vector<fs::path> folders;
    for (const char* const variable : {"CUDA_PATH", "CUDA_HOME"})
        if (const char* const value = std::getenv(variable); value != nullptr && *value != 0)
            folders.push_back(fs::path(value) / "bin");
    folders.insert(folders.end(), {"/usr/local/cuda/bin", "/opt/cuda/bin"});
    return folders;
}

std::string text_of(const fs::path& file)
{
    return file_bytes(file).value_or("");
}

/// What became of a kernel: the texts of its code and ptxas's words, or the reason why there are none.
struct Compiled {
    std::string ptx, sass;
    std::map<std::string, PtxasReport> reports;
    std::string reason;
};

Compiled compile(const Nvcc& nvcc, const Target& target, const cuda::ProgramId& program, const fs::path& code,
                 const std::string& text)
{
    const WorkFolder folder;
    const fs::path source = folder.path() / (program.name() + ".cu"),
                   binary = folder.path() / (program.name() + ".cubin");
    const EmbeddedKernel* const kernel = find_kernel(cuda::embedded_sources(), program.source);
    if (kernel == nullptr) return {{}, {}, {}, "this build lacks the source of " + program.source};
    std::ofstream(source) << (text.empty() ? kernel->text() : std::string_view(text));
    std::vector<std::string> arguments = {
        "--cubin", "-std=c++17", "--keep", "--keep-dir", folder.path().string(), "-arch=" + target.name,
        "-Xptxas", "-v"};
    for (const std::string& option : cuda::compiler_options(program))
        arguments.push_back(option);
    arguments.insert(arguments.end(), {"-o", binary.string(), source.string()});
    const ChildOutcome outcome = run_compiler(nvcc.program, arguments);
    if (!succeeded(outcome)) return {{}, {}, {}, first_line(outcome.errors)};
    Compiled compiled{text_of(folder.path() / (program.name() + ".ptx")), {}, read_ptxas(outcome.errors), {}};
    const std::string name = target.name + "-" + program.name();
    if (!code.empty()) write_whole(code / (name + ".ptx"), compiled.ptx);
    if (nvcc.disassembler.empty()) return compiled;
    const fs::path listing = folder.path() / "listing"; // longer than what run_child() keeps
    if (succeeded(
            run_compiler("/bin/sh", {"-c", "exec \"$0\" -c \"$1\" > \"$2\"", nvcc.disassembler, binary, listing})))
        compiled.sass = text_of(listing);
    if (!code.empty()) write_whole(code / (name + ".sass"), compiled.sass);
    return compiled;
}

void take(Inspected& row, const Compiled& compiled, const std::string& entry)
{
    const auto report = compiled.reports.find(entry);
    if (report == compiled.reports.end() || compiled.ptx.empty()) {
        row.status = InspectedStatus::error;
        row.reason = compiled.reason.empty() ? "ptxas does not report " + entry : compiled.reason;
        return;
    }
    row.registers = report->second.registers;
    row.spill_store_bytes = report->second.spill_store_bytes;
    row.spill_load_bytes = report->second.spill_load_bytes;
    row.scratch_bytes = report->second.stack_bytes;
    row.lanes = 32;
    unsigned capability = 0;
    std::from_chars(row.target.name.data() + 3, row.target.name.data() + row.target.name.size(), capability);
    const std::uint64_t block = row.point.kernel.schedule == Schedule::persistent
                                    ? cuda::persistent_block_threads
                                    : std::uint64_t{TILE_WIDTH} * tile_height_of({});
    if (const auto warps =
            resident_warps(capability, *row.registers, block, block * stack_bytes_of_item(row.point.kernel.layout))) {
        row.subgroups = warps->resident;
        row.max_subgroups = warps->max;
    }
    const CodeFigures ptx = read_ptx(compiled.ptx, entry);
    row.loads = ptx.loads;
    row.loads_in_loops = ptx.loads_in_loops;
    row.fused = ptx.fused;
    row.unrounded = ptx.unrounded;
    row.first_fused = printable_line(ptx.first_fused);
    row.divisions = ptx.divisions;
    const CodeFigures sass = read_sass(compiled.sass, entry);
    if (sass.instructions == 0) return;
    row.instructions = sass.instructions;
    row.branches = sass.branches;
    row.loads = sass.loads;
    row.loads_in_loops = sass.loads_in_loops;
    row.sass_fused = sass.fused;
    // Without a division nothing may be fused in machine code that PTX did not fuse.
    if (ptx.divisions == 0 && sass.fused > ptx.fused) {
        row.fused = sass.fused;
        row.first_fused = printable_line(sass.first_fused);
    }
}

} // namespace

Nvcc find_nvcc()
{
    Nvcc nvcc;
    nvcc.program = find_compiler("nvcc", toolkit_folders());
    if (nvcc.program.empty()) {
        nvcc.reason = "NVIDIA's compiler, nvcc, is missing; install the CUDA toolkit (Debian: nvidia-cuda-toolkit)";
        return nvcc;
    }
    const ChildOutcome version = run_compiler(nvcc.program, {"--version"}),
                       known = run_compiler(nvcc.program, {"--list-gpu-code"});
    std::smatch found;
    if (!succeeded(version) || !succeeded(known) ||
        !std::regex_search(version.out, found, std::regex("release ([0-9.]+)"))) {
        nvcc.reason = nvcc.program.string() + " does not work: " + first_line(version.errors + known.errors);
        return nvcc;
    }
    nvcc.version = "nvcc " + found[1].str();
    std::istringstream lines(known.out);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("sm_")) nvcc.targets.push_back(printable_line(line));
    nvcc.disassembler = find_compiler("nvdisasm", toolkit_folders());
    return nvcc;
}

std::map<std::string, PtxasReport> read_ptxas(const std::string& messages)
{
    static const std::regex begins("Compiling entry function '([^']+)'"),
        frame("([0-9]+) bytes stack frame, ([0-9]+) "
              "bytes spill stores, ([0-9]+) bytes "
              "spill loads"),
        used("Used ([0-9]+) registers");
    std::map<std::string, PtxasReport> reports;
    PtxasReport* current = nullptr;
    std::istringstream lines(messages);
    std::smatch found;
    for (std::string line; std::getline(lines, line);)
        if (std::regex_search(line, found, begins))
            current = &reports[found[1].str()];
        else if (current != nullptr && std::regex_search(line, found, frame)) {
            current->stack_bytes = std::stoull(found[1].str());
            current->spill_store_bytes = std::stoull(found[2].str());
            current->spill_load_bytes = std::stoull(found[3].str());
        } else if (current != nullptr && std::regex_search(line, found, used))
            current->registers = std::stoull(found[1].str());
    return reports;
}

std::vector<Inspected> ask_nvcc(const Nvcc& nvcc, const Target& target, const std::vector<EntryPoint>& points,
                                const fs::path& code, const PartDone& tell, const std::string& text)
{
    if (!nvcc.reason.empty()) return unasked(target, points, nvcc.reason);
    if (std::ranges::find(nvcc.targets, target.name) == nvcc.targets.end())
        return unasked(target, points,
                       fmt::format("{} supports {}, not {}", nvcc.version, fmt::join(nvcc.targets, ", "), target.name));
    std::map<std::string, Compiled> kernels;
    std::vector<Inspected> rows;
    for (const EntryPoint& point : points) {
        tell(static_cast<double>(rows.size()) / static_cast<double>(points.size()));
        const cuda::ProgramId program = cuda::program_of(point.kernel);
        auto found = kernels.find(program.name());
        if (found == kernels.end())
            found = kernels.emplace(program.name(), compile(nvcc, target, program, code, text)).first;
        Inspected& row = rows.emplace_back();
        row.target = target;
        row.point = point;
        row.compiler = nvcc.version;
        take(row, found->second, cuda::entry_name(point.kernel, point.entry == Entry::outside));
    }
    return rows;
}

} // namespace tetrace
