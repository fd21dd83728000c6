#pragma once

#include "backends/cuda/driver.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tetrace::cuda {

/// A device's primary context, retained while this object lives; what is made in it must be destroyed before it.
/// Every call throws Error{driver} with the driver's name of the error. After some errors (CUDA calls them sticky)
/// the context is unusable for all sessions that share it. The driver destroys it with the last of them, so that the
/// next session gets a new one. It is not reset before that: sessions that are still open would free memory that
/// belongs to the new context.
class Context {
public:
    Context(const Driver& driver, Ordinal device);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    [[nodiscard]] const Driver& driver() const { return driver_; }
    [[nodiscard]] ContextHandle handle() const { return handle_; }
    /// Other sessions and libraries use other contexts: call this before any work in this context.
    void make_current();
    /// Throws if a call failed. doing: what the call does; the text puts "CUDA: " before it.
    void check(Result result, const std::string& doing);
    /// For a result that the caller checks itself: notes whether the context is still usable.
    void note(Result result);

private:
    const Driver& driver_;
    Ordinal device_;
    ContextHandle handle_ = nullptr;
    bool lost_ = false;
};

/// Bytes of a device's memory, for the life of this object.
class Memory {
public:
    Memory() = default;
    /// Throws Error{unsupported} with both numbers where fewer bytes are free. what: the content, for the error's text.
    Memory(Context& context, std::size_t bytes, const char* what);
    /// The same, filled with the content that `bytes` has when the stream reaches the copy.
    Memory(Context& context, std::span<const std::byte> bytes, const char* what, StreamHandle stream);
    Memory(Memory&& other) noexcept;
    Memory& operator=(Memory&& other) noexcept;
    ~Memory();

    [[nodiscard]] Address address() const { return address_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    Context* context_ = nullptr;
    Address address_ = 0;
    std::size_t bytes_ = 0;
};

/// A stream or an event, destroyed with the driver's own function.
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Result (*)(Handle)>;

[[nodiscard]] Owned<StreamHandle> make_stream(Context& context);

/// Streams for work that runs together with that of a main stream, from a fork to a join.
class SideStreams {
public:
    /// The main stream and those at its side: as many connections as NVIDIA's driver gives a context by default, so
    /// that no stream waits for another's work (CUDA C++ Programming Guide, CUDA_DEVICE_MAX_CONNECTIONS).
    static constexpr std::size_t max_streams = 8;

    SideStreams(Context& context, StreamHandle main) : context_(context), main_(main) {}
    /// Makes that many streams, the main one included, wait for what the main one has been given so far.
    void fork(std::size_t streams);
    /// Where the work of that number goes, until join() is called.
    [[nodiscard]] StreamHandle stream(std::size_t work) const;
    /// Makes the main stream wait for the others.
    void join();

private:
    struct Side {
        Owned<StreamHandle> stream;
        Owned<EventHandle> done;
    };
    void record(EventHandle event, StreamHandle stream);
    void wait(StreamHandle stream, EventHandle event);

    Context& context_;
    StreamHandle main_;
    Owned<EventHandle> forked_{nullptr, nullptr};
    std::vector<Side> sides_; ///< made when first needed
    std::size_t streams_ = 1; ///< between fork() and join()
};

/// Two events, for the time between them by the device's clock.
class EventTimer {
public:
    explicit EventTimer(Context& context);
    void start(StreamHandle stream);
    void stop(StreamHandle stream);
    /// Waits for stop(). Seconds, with a resolution of about half a microsecond.
    [[nodiscard]] double seconds();

private:
    Context& context_;
    Owned<EventHandle> start_, stop_;
};

/// A loaded module.
class Module {
public:
    /// Throws Error{unsupported} if the driver cannot use the image: it names the driver's error and its log.
    Module(Context& context, std::span<const std::byte> image, const std::string& name);
    /// Throws Error{driver} if the module lacks the entry.
    [[nodiscard]] FunctionHandle function(const std::string& name) const;

private:
    Context& context_;
    Owned<ModuleHandle> module_;
};

} // namespace tetrace::cuda
