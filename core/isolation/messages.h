#pragma once

#include "core/base/error.h"
#include "core/device/backend.h"
#include "core/isolation/channel.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tetrace {

/// Values as the bytes of a message. Both ends are the same program on the same machine: values are copied as they lie.
class ByteWriter {
public:
    template <class T>
    void put(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        append(&value, sizeof value);
    }
    void put_text(std::string_view text)
    {
        put(std::uint64_t{text.size()});
        append(text.data(), text.size());
    }
    template <class T>
    void put_all(std::span<const T> values)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        put(std::uint64_t{values.size()});
        append(values.data(), values.size_bytes());
    }
    void append(const ByteWriter& other) { bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end()); }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

private:
    void append(const void* from, std::size_t count)
    {
        const auto* const first = static_cast<const std::byte*>(from);
        bytes_.insert(bytes_.end(), first, first + count);
    }

    std::vector<std::byte> bytes_;
};

/// Reads what a ByteWriter wrote, in the same order. Throws Error{driver} if fewer bytes are left than are asked
/// for.
class ByteReader {
public:
    explicit ByteReader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    template <class T>
    [[nodiscard]] T get()
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        if constexpr (std::is_same_v<T, bool>) return get<unsigned char>() != 0; // no other bits are a bool's
        T value{};
        take(&value, sizeof value);
        return value;
    }
    [[nodiscard]] std::string get_text()
    {
        std::string text(count_of(1), '\0');
        take(text.data(), text.size());
        return text;
    }
    template <class T>
    [[nodiscard]] std::vector<T> get_all()
    {
        std::vector<T> values(count_of(sizeof(T)));
        take(values.data(), values.size() * sizeof(T));
        return values;
    }

private:
    /// A number of elements that the rest of the message can hold.
    [[nodiscard]] std::size_t count_of(std::size_t element_bytes)
    {
        const auto count = get<std::uint64_t>();
        if (count > (bytes_.size() - next_) / element_bytes) reject();
        return static_cast<std::size_t>(count);
    }
    void take(void* to, std::size_t count)
    {
        if (count > bytes_.size() - next_) reject();
        if (count > 0) std::memcpy(to, bytes_.data() + next_, count);
        next_ += count;
    }
    [[noreturn]] static void reject()
    {
        throw Error(ErrorKind::driver, "a message from or to a driver's process is damaged: it is too short");
    }

    std::vector<std::byte> bytes_;
    std::size_t next_ = 0;
};

/// The requests to a driver's process: the calls of Backend, up to open, and of Session.
enum class Request : std::uint32_t {
    devices,
    why_not,
    probe,
    yardstick,
    run_defect,
    compiled,
    open,
    set_rays,
    launch,
    wait,
    read_hits,
    read_faces,
    close,
};

void put_devices(ByteWriter& to, const std::vector<Device>& devices);
[[nodiscard]] std::vector<Device> get_devices(ByteReader& from);

/// The code's text, which is too long for a message, goes to memory that both processes see.
inline constexpr std::size_t max_code_bytes = std::size_t{16} << 20;
/// Throws Error{unsupported} with both numbers if the memory is too small.
void put_code(ByteWriter& to, const CompiledCode& code, const SharedMemory& text);
[[nodiscard]] CompiledCode get_code(ByteReader& from, const SharedMemory& text);

void put_options(ByteWriter& to, const SessionOptions& options);
[[nodiscard]] SessionOptions get_options(ByteReader& from);

/// What a session has to say at any time; it comes with the answer to each of its calls.
struct SessionFacts {
    SetupTimes setup;
    std::uint64_t bytes = 0;
};

/// A packed scene or a mesh that has crossed to another process: what a kernel reads of it.
struct SentScene {
    PackedScene packed;
    TriangleMesh mesh;
    bool is_packed = false;

    [[nodiscard]] SceneData data() const { return {is_packed ? nullptr : &mesh, is_packed ? &packed : nullptr}; }
};

/// What a session of the kernel reads: its packed scene, or its mesh. Null if the caller gave none.
[[nodiscard]] const void* scene_of(const KernelId& kernel, const SceneData& scene);
/// Writes its counts to the message and its arrays to memory that is to be sent with it. What stays on the host of a
/// packed scene (PackedScene::packed_of_mesh and so on) stays here.
[[nodiscard]] SharedMemory put_scene(ByteWriter& to, const KernelId& kernel, const SceneData& scene);
[[nodiscard]] SentScene get_scene(ByteReader& from, Descriptor memory);

/// How an exception crosses: call it in a handler.
void put_exception(ByteWriter& to);
/// The first part of an answer: that all went well.
void put_success(ByteWriter& to);
/// Reads either; throws what the other process threw: Error of the same kind and text, std::bad_alloc, or
/// Error{driver} with the text of any other exception.
void get_outcome(ByteReader& from);

} // namespace tetrace
