#include "core/isolation/isolated_backend.h"

#include "core/device/defects.h"
#include "core/device/device_facts.h"
#include "core/device/launch.h"

#include <algorithm>

namespace tetrace {

IsolatedSession::IsolatedSession(const IsolatedBackend& backend, std::size_t device, const KernelId& kernel,
                                 const SceneData& scene, SessionOptions options)
    : backend_(&backend), device_(device), kernel_(kernel), scene_(scene), options_(std::move(options))
{
    if (scene.packed != nullptr) make_tally(kernel.task, scene.packed->tet_count);
    open();
}

IsolatedSession::~IsolatedSession()
{
    if (number_ == 0 || child_->is_lost()) return;
    try {
        call(Request::close, "closing " + name_of(kernel_), {}, {}, call_limit_s(0));
    } catch (const std::exception&) { // the next session starts another process
    }
}

ByteReader IsolatedSession::call(Request what, const std::string& doing, const ByteWriter& arguments,
                                 const SharedMemory& memory, double limit_s)
{
    ByteWriter request;
    request.put(what);
    request.put(number_);
    request.append(arguments);
    ByteReader answer = child_->call({doing, request, memory.file(), limit_s});
    facts_ = answer.get<SessionFacts>();
    return answer;
}

void IsolatedSession::open()
{
    number_ = 0;
    remote_scene_ = nullptr;
    child_ = backend_->child_of(device_);
    const void* const scene = scene_of(kernel_, scene_);
    auto remote = scene == nullptr ? nullptr : child_->find_scene(scene);
    const bool is_new = scene != nullptr && remote == nullptr;
    if (is_new) remote = child_->add_scene(scene);
    ByteWriter request;
    request.put(Request::open);
    request.put(std::uint64_t{device_});
    request.put(kernel_);
    put_options(request, options_);
    request.put(remote == nullptr ? std::uint64_t{0} : remote->number);
    request.put(is_new);
    const SharedMemory memory = is_new ? put_scene(request, kernel_, scene_) : SharedMemory();
    ByteReader answer = child_->call(
        {"opening " + name_of(kernel_), request, memory.file(), call_limit_s(0, memory.bytes().size()), true});
    number_ = answer.get<std::uint64_t>();
    remote_scene_ = std::move(remote);
    facts_ = answer.get<SessionFacts>();
}

bool IsolatedSession::is_still_open()
{
    if (number_ != 0 && !child_->is_lost()) return true;
    open();
    if (has_rays_) send_rays();
    return false;
}

void IsolatedSession::require_launched()
{
    if (is_still_open() || jobs_.empty()) return;
    send_jobs();
    static_cast<void>(await_jobs());
}

void IsolatedSession::set_rays(std::span<const Quad> quads)
{
    has_rays_ = false;
    if (quads.size_bytes() > rays_.bytes().size()) {
        rays_ = {}; // before there are two
        rays_ = SharedMemory(quads.size_bytes());
    }
    std::ranges::copy(std::as_bytes(quads), rays_.bytes().begin());
    quads_ = quads.size();
    static_cast<void>(is_still_open());
    send_rays();
    has_rays_ = true;
}

void IsolatedSession::send_rays()
{
    ByteWriter arguments;
    arguments.put(quads_);
    call(Request::set_rays, "copying the rays of " + name_of(kernel_), arguments, rays_,
         call_limit_s(0, quads_ * sizeof(Quad)));
}

void IsolatedSession::start(std::span<const TraceJob> jobs)
{
    static_cast<void>(is_still_open());
    jobs_.assign(jobs.begin(), jobs.end());
    send_jobs();
}

void IsolatedSession::send_jobs()
{
    ByteWriter arguments;
    arguments.put_all(std::span<const TraceJob>(jobs_));
    call(Request::launch, "launching " + name_of(kernel_), arguments, {}, call_limit_s(rays()));
}

double IsolatedSession::wait()
{
    if (!is_still_open() && !jobs_.empty()) send_jobs();
    return await_jobs();
}

double IsolatedSession::await_jobs()
{
    return call(Request::wait, "running " + name_of(kernel_), {}, {}, call_limit_s(rays())).get<double>();
}

std::uint64_t IsolatedSession::rays() const
{
    std::uint64_t rays = 0;
    for (const TraceJob& job : jobs_)
        rays += job.rays();
    return rays;
}

/// The other process has checked the guard words; here they are as they should be.
void IsolatedSession::read_output(std::span<std::uint32_t> words)
{
    require_launched();
    const bool are_faces = kernel_.task == Task::search;
    const OutputParts parts = output_parts(words_per_ray(kernel_.task));
    const std::uint64_t written = written_rays();
    const std::size_t bytes = written * words_per_ray(kernel_.task) * sizeof(words[0]) + tally_words().size_bytes();
    if (bytes > output_.bytes().size()) {
        output_ = {};
        output_ = SharedMemory(bytes);
    }
    ByteWriter arguments;
    arguments.put(written);
    download_s_ = call(are_faces ? Request::read_faces : Request::read_hits, "reading the hits of " + name_of(kernel_),
                       arguments, output_, call_limit_s(0, bytes))
                      .get<double>();
    std::ranges::fill(words, POISON);
    std::span<const std::byte> read = output_.bytes();
    for (std::size_t job = 0; job < written_parts(); ++job) {
        const auto results = std::as_writable_bytes(parts.results(words, job));
        std::ranges::copy(read.first(results.size()), results.begin());
        read = read.subspan(results.size());
    }
    if (const auto sums = std::as_writable_bytes(parts.tally(words, 0)); !sums.empty())
        std::ranges::copy(read.first(sums.size()), sums.begin());
}

namespace {

Device broken_device(const std::string& reason)
{
    Device device = unusable_device("none", reason);
    device.broken = true;
    return printable(device);
}

} // namespace

IsolatedBackend::IsolatedBackend(const Backend& inner, DriverProcesses processes)
    : inner_(&inner), processes_(std::move(processes))
{
}

const std::vector<Device>& IsolatedBackend::devices() const
{
    std::call_once(once_, [this] { find_devices(); });
    return devices_;
}

void IsolatedBackend::find_devices() const
{
    try {
        spare_ = std::make_shared<DriverChild>(processes_, name());
        devices_ = list(*spare_);
    } catch (const std::exception& error) {
        devices_ = {broken_device(error.what())};
    }
    children_.resize(devices_.size());
}

std::vector<Device> IsolatedBackend::list(DriverChild& child) const
{
    ByteWriter request;
    request.put(Request::devices);
    ByteReader answer = child.call({"listing its devices", request, -1, call_limit_s(0)});
    return get_devices(answer);
}

std::shared_ptr<DriverChild> IsolatedBackend::child_of(std::size_t device) const
{
    const Device& wanted = devices().at(device);
    if (!wanted.usable && !wanted.compile_only)
        throw Error(wanted.broken ? ErrorKind::driver : ErrorKind::missing, wanted.reason);
    std::shared_ptr<DriverChild>& child = children_[device];
    if (child == nullptr || child->is_lost()) child = start(device);
    return child;
}

std::shared_ptr<DriverChild> IsolatedBackend::start(std::size_t device) const
{
    std::shared_ptr<DriverChild> child = std::exchange(spare_, nullptr);
    if (child == nullptr || child->is_lost()) {
        child = std::make_shared<DriverChild>(processes_, name());
        const auto now = list(*child);
        if (device >= now.size() || !is_same_device(now[device], devices_[device]))
            throw Error(ErrorKind::driver, name() + ": " + devices_[device].name +
                                               " is no longer where the driver listed it: the device was lost");
    }
    child->set_driver(devices_[device].implementation + ", " + devices_[device].name);
    return child;
}

std::string IsolatedBackend::why_not(std::size_t device, const KernelId& kernel) const
{
    if (has_kernel(kernel) && !devices().at(device).usable) return devices_[device].reason;
    ByteWriter request;
    request.put(Request::why_not);
    request.put(std::uint64_t{device});
    request.put(kernel);
    try {
        return child_of(device)
            ->call({"saying whether it runs " + name_of(kernel), request, -1, call_limit_s(0)})
            .get_text();
    } catch (const std::exception& error) {
        return error.what();
    }
}

std::unique_ptr<Session> IsolatedBackend::open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                               const SessionOptions& options)
{
    return std::make_unique<IsolatedSession>(*this, device, kernel, scene, options);
}

std::vector<std::uint32_t> IsolatedBackend::probe(std::size_t device, MathMode math, std::span<const Quad> operations)
{
    ByteWriter request;
    request.put(Request::probe);
    request.put(std::uint64_t{device});
    request.put(math);
    request.put_all(operations);
    return child_of(device)
        ->call({"testing its arithmetic", request, -1, call_limit_s(operations.size())})
        .get_all<std::uint32_t>();
}

std::vector<std::uint32_t> IsolatedBackend::run_defect(std::size_t device, std::string_view name,
                                                       const DefectLaunch& launch)
{
    ByteWriter request;
    request.put(Request::run_defect);
    request.put(std::uint64_t{device});
    request.put(launch);
    request.put_text(name);
    const SharedMemory memory(output_words(name, launch) * sizeof(std::uint32_t));
    const auto bytes = child_of(device)
                           ->call({"running the reduced kernel " + std::string(name), request, memory.file(),
                                   call_limit_s(launch.items, memory.bytes().size())})
                           .get<std::uint64_t>();
    std::vector<std::uint32_t> words(bytes / sizeof(std::uint32_t));
    std::ranges::copy(memory.bytes().first(bytes), std::as_writable_bytes(std::span(words)).begin());
    return words;
}

CompiledCode IsolatedBackend::compiled(std::size_t device, const std::optional<KernelId>& kernel, bool starts_outside,
                                       const std::filesystem::path& program_file) const
{
    ByteWriter request;
    request.put(Request::compiled);
    request.put(std::uint64_t{device});
    request.put(kernel.has_value());
    request.put(kernel.value_or(KernelId{}));
    request.put(starts_outside);
    request.put_text(program_file.native());
    const std::string what = kernel ? name_of(*kernel) : "an empty kernel";
    const SharedMemory text(max_code_bytes);
    ByteReader answer = child_of(device)->call({"compiling " + what, request, text.file(), call_limit_s(0), true});
    return get_code(answer, text);
}

std::optional<Yardstick> IsolatedBackend::yardstick(std::size_t device, const SessionOptions& options)
{
    ByteWriter request;
    request.put(Request::yardstick);
    request.put(std::uint64_t{device});
    put_options(request, options);
    ByteReader answer =
        child_of(device)->call({"copying its memory and running empty kernels", request, -1, call_limit_s(0)});
    if (!answer.get<bool>()) return std::nullopt;
    return answer.get<Yardstick>();
}

} // namespace tetrace
