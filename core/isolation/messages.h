#pragma once

#include "core/device/backend.h"
#include "core/isolation/bytes.h"
#include "core/isolation/shared_memory.h"

#include <exception>

namespace tetrace {

/// The requests to a driver's process: the calls of Backend, up to open, and of Session.
enum class Request : std::uint32_t {
    devices,
    why_not,
    probe,
    yardstick,
    run_defect,
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
/// std::runtime_error with the text of any other exception.
void get_outcome(ByteReader& from);

} // namespace tetrace
