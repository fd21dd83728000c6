#include "backends/cuda/handles.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tetrace::cuda {

namespace {

/// CUresult values after which every call in the context fails in the same way: faults of the kernel, of memory, of the
/// device.
bool is_sticky(Result result)
{
    constexpr std::array sticky{46, 214, 220, 226, 700, 702, 709, 710, 714, 715, 716, 717, 718, 719, 999};
    return std::find(sticky.begin(), sticky.end(), result) != sticky.end();
}

constexpr int jit_error_log_buffer = 5;       // CU_JIT_ERROR_LOG_BUFFER
constexpr int jit_error_log_buffer_bytes = 6; // CU_JIT_ERROR_LOG_BUFFER_SIZE_BYTES

} // namespace

Context::Context(const Driver& driver, Ordinal device) : driver_(driver), device_(device)
{
    check(driver.context_retain(&handle_, device), "opening the device");
    const Result result = driver.context_set_current(handle_);
    if (result != success) driver.context_release(device);
    check(result, "making its context current");
}

Context::~Context()
{
    driver_.context_set_current(nullptr);
    driver_.context_release(device_);
}

void Context::make_current()
{
    check(driver_.context_set_current(handle_), "making its context current");
}

void Context::note(Result result)
{
    lost_ = lost_ || is_sticky(result);
}

void Context::check(Result result, const std::string& doing)
{
    if (result == success) return;
    note(result);
    throw Error(ErrorKind::driver,
                "CUDA: " + doing + ": " + text_of(driver_, result) +
                    (lost_ ? "; the device's context is lost to all sessions that are open on it" : ""));
}

Memory::Memory(Context& context, std::size_t bytes, const char* what) : context_(&context), bytes_(bytes)
{
    const Driver& driver = context.driver();
    // An empty array gets an address too.
    const Result result = driver.memory_allocate(&address_, std::max<std::size_t>(bytes, 16));
    if (result == error_out_of_memory) {
        std::size_t free = 0, total = 0;
        driver.memory_info(&free, &total);
        throw Error(ErrorKind::unsupported, "CUDA: allocating " + std::to_string(bytes) + " bytes for " + what +
                                                ": the device has " + std::to_string(free) + " bytes of memory free");
    }
    context.check(result, "allocating " + std::to_string(bytes) + " bytes for " + what);
}

Memory::Memory(Context& context, std::span<const std::byte> bytes, const char* what, StreamHandle stream)
    : Memory(context, bytes.size(), what)
{
    if (bytes.empty()) return;
    context.check(context.driver().copy_to_device(address_, bytes.data(), bytes.size(), stream),
                  "copying " + std::string(what) + " to the device");
}

Memory::Memory(Memory&& other) noexcept
    : context_(std::exchange(other.context_, nullptr)), address_(std::exchange(other.address_, 0)),
      bytes_(std::exchange(other.bytes_, 0))
{
}

Memory& Memory::operator=(Memory&& other) noexcept
{
    std::swap(context_, other.context_);
    std::swap(address_, other.address_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

Memory::~Memory()
{
    if (address_ != 0) context_->driver().memory_free(address_);
}

Owned<StreamHandle> make_stream(Context& context)
{
    StreamHandle stream = nullptr;
    context.check(context.driver().stream_create(&stream, 0), "making a stream");
    return {stream, context.driver().stream_destroy};
}

namespace {

constexpr unsigned without_timing = 2; // CU_EVENT_DISABLE_TIMING

Owned<EventHandle> make_event(Context& context, unsigned flags = 0)
{
    EventHandle event = nullptr;
    context.check(context.driver().event_create(&event, flags), "making an event");
    return {event, context.driver().event_destroy};
}

} // namespace

void SideStreams::fork(std::size_t streams)
{
    if (streams < 2) return;
    if (forked_ == nullptr) forked_ = make_event(context_, without_timing);
    while (sides_.size() < streams - 1)
        sides_.push_back({make_stream(context_), make_event(context_, without_timing)});
    record(forked_.get(), main_);
    for (std::size_t i = 0; i + 1 < streams; ++i)
        wait(sides_[i].stream.get(), forked_.get());
    streams_ = streams; // only now: join() is called after a failure, too
}

StreamHandle SideStreams::stream(std::size_t work) const
{
    const std::size_t number = work % streams_;
    return number == 0 ? main_ : sides_[number - 1].stream.get();
}

void SideStreams::join()
{
    for (std::size_t i = 0; i + 1 < streams_; ++i) {
        record(sides_[i].done.get(), sides_[i].stream.get());
        wait(main_, sides_[i].done.get());
    }
    streams_ = 1;
}

void SideStreams::record(EventHandle event, StreamHandle stream)
{
    context_.check(context_.driver().event_record(event, stream), "recording an event");
}

void SideStreams::wait(StreamHandle stream, EventHandle event)
{
    context_.check(context_.driver().stream_wait_event(stream, event, 0), "making a stream wait");
}

EventTimer::EventTimer(Context& context) : context_(context), start_(make_event(context)), stop_(make_event(context)) {}

void EventTimer::start(StreamHandle stream)
{
    context_.check(context_.driver().event_record(start_.get(), stream), "recording an event");
}

void EventTimer::stop(StreamHandle stream)
{
    context_.check(context_.driver().event_record(stop_.get(), stream), "recording an event");
}

double EventTimer::seconds()
{
    context_.check(context_.driver().event_synchronize(stop_.get()), "waiting for the device");
    float milliseconds = 0;
    context_.check(context_.driver().event_elapsed(&milliseconds, start_.get(), stop_.get()), "reading its clock");
    return 1e-3 * static_cast<double>(milliseconds);
}

Module::Module(Context& context, std::span<const std::byte> image, const std::string& name)
    : context_(context), module_(nullptr, context.driver().module_unload)
{
    std::array<char, 2048> log{};
    std::array names{jit_error_log_buffer, jit_error_log_buffer_bytes};
    // The size is passed as a pointer: the API's convention.
    std::array<void*, 2> values{log.data(), reinterpret_cast<void*>(log.size() - 1)};
    ModuleHandle module = nullptr;
    const Result result = context.driver().module_load(&module, image.data(), 2, names.data(), values.data());
    if (result == success) {
        module_.reset(module);
        return;
    }
    context.note(result);
    throw Error(ErrorKind::unsupported, "CUDA: loading kernel " + name + ": " + text_of(context.driver(), result) +
                                            (log[0] != '\0' ? ": " + std::string(log.data()) : ""));
}

FunctionHandle Module::function(const std::string& name) const
{
    FunctionHandle function = nullptr;
    context_.check(context_.driver().module_function(&function, module_.get(), name.c_str()),
                   "looking for the kernel's entry " + name);
    return function;
}

} // namespace tetrace::cuda
