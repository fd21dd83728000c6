#include "core/isolation/messages.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <tuple>

namespace tetrace {

namespace {

constexpr std::size_t max_text_bytes = 64 * 1024; ///< of an exception: a compiler's log may be longer

enum class Ended : std::uint32_t { well, error, bad_alloc, other };

/// All members by name, so that a new one does not compile before it is sent too.
template <class Visit>
void each_text(Device& device, const Visit& visit)
{
    auto& [name, kind, driver, implementation, id, uuid, pci, library, memory_bytes, max_buffer_bytes, max_group_items,
           group_width, max_steps, timer_period_s, threads, usable, compile_only, broken, reason, reports_code,
           cache_bytes] = device;
    static_cast<void>(std::tie(kind, memory_bytes, max_buffer_bytes, max_group_items, group_width, max_steps,
                               timer_period_s, threads, usable, compile_only, broken, reports_code,
                               cache_bytes)); // see each_number()
    for (std::string* text : {&name, &driver, &implementation, &id, &uuid, &pci, &library, &reason})
        visit(*text);
}

template <class Visit>
void each_number(Device& device, const Visit& visit)
{
    visit(device.kind);
    visit(device.memory_bytes);
    visit(device.max_buffer_bytes);
    visit(device.max_group_items);
    visit(device.group_width);
    visit(device.max_steps);
    visit(device.timer_period_s);
    visit(device.threads);
    visit(device.usable);
    visit(device.compile_only);
    visit(device.broken);
    visit(device.reports_code);
    visit(device.cache_bytes);
}

/// The arrays of a packed scene that a device gets; all members by name, for the same reason.
template <class Visit>
void each_array(PackedScene& scene, const Visit& visit)
{
    auto& [layout, tet_count, divisions, stack_entries, tets, triangles, lines, entry_ranges, entry_half_faces,
           vertices, entry_faces, occlusive_faces, nodes, leaf_triangles, packed_of_mesh, number_of_vertex,
           last_neighbours, fall_back] = scene;
    static_cast<void>(std::tie(layout, tet_count, divisions, stack_entries, packed_of_mesh, number_of_vertex,
                               last_neighbours, fall_back));
    for (std::vector<Quad>* array : {&tets, &triangles, &vertices, &entry_faces, &nodes, &leaf_triangles})
        visit(*array);
    for (std::vector<std::uint32_t>* array : {&lines, &entry_ranges, &entry_half_faces, &occlusive_faces})
        visit(*array);
}

template <class Visit>
void each_array(TriangleMesh& mesh, const Visit& visit)
{
    auto& [vertices, triangles] = mesh;
    visit(vertices);
    visit(triangles);
}

template <class Scene>
SharedMemory put_arrays(ByteWriter& to, const Scene& scene)
{
    auto& arrays = const_cast<Scene&>(scene); // visited for reading only
    std::size_t bytes = 0;
    each_array(arrays, [&](const auto& array) {
        to.put(std::uint64_t{array.size()});
        bytes += std::as_bytes(std::span(array)).size();
    });
    SharedMemory memory(bytes);
    auto place = memory.bytes();
    each_array(arrays, [&](const auto& array) {
        const auto from = std::as_bytes(std::span(array));
        std::ranges::copy(from, place.begin());
        place = place.subspan(from.size());
    });
    return memory;
}

template <class Scene>
void get_arrays(ByteReader& from, Descriptor file, Scene& scene)
{
    std::size_t bytes = 0;
    each_array(scene, [&](auto& array) {
        array.resize(from.get<std::uint64_t>());
        bytes += std::as_bytes(std::span(array)).size();
    });
    const SharedMemory memory(std::move(file), bytes);
    std::span<const std::byte> place = memory.bytes();
    each_array(scene, [&](auto& array) {
        const auto to = std::as_writable_bytes(std::span(array));
        std::ranges::copy(place.first(to.size()), to.begin());
        place = place.subspan(to.size());
    });
}

void put_failure(ByteWriter& to, Ended how, ErrorKind kind, std::string_view text)
{
    to.put(how);
    to.put(kind);
    to.put_text(text.substr(0, max_text_bytes));
}

} // namespace

void put_devices(ByteWriter& to, const std::vector<Device>& devices)
{
    to.put(std::uint64_t{devices.size()});
    for (Device device : devices) {
        each_text(device, [&](const std::string& text) { to.put_text(text); });
        each_number(device, [&](const auto& number) { to.put(number); });
    }
}

std::vector<Device> get_devices(ByteReader& from)
{
    std::vector<Device> devices;
    for (auto left = from.get<std::uint64_t>(); left > 0; --left) {
        Device& device = devices.emplace_back();
        each_text(device, [&](std::string& text) { text = from.get_text(); });
        each_number(device, [&](auto& number) { number = from.get<std::remove_reference_t<decltype(number)>>(); });
        if (static_cast<std::size_t>(device.kind) >= enum_names<DeviceKind>.size())
            throw Error(ErrorKind::driver,
                        "a message from a driver's process is damaged: its kind of device is unknown");
    }
    return devices;
}

void put_code(ByteWriter& to, const CompiledCode& code, const SharedMemory& text)
{
    if (code.text.size() > text.bytes().size())
        throw Error(ErrorKind::unsupported, "the code has " + std::to_string(code.text.size()) +
                                                " bytes of text, at most " + std::to_string(text.bytes().size()) +
                                                " are possible");
    to.put_text(code.compiler);
    to.put(code.lanes);
    to.put(std::uint64_t{code.statistics.size()});
    for (const auto& [name, value] : code.statistics) {
        to.put_text(name);
        to.put(value);
    }
    std::ranges::copy(std::as_bytes(std::span(code.text)), text.bytes().begin());
    to.put(std::uint64_t{code.text.size()});
    to.put_text(code.messages);
}

CompiledCode get_code(ByteReader& from, const SharedMemory& text)
{
    CompiledCode code;
    code.compiler = from.get_text();
    code.lanes = from.get<unsigned>();
    for (auto left = from.get<std::uint64_t>(); left > 0; --left) {
        const std::string name = from.get_text();
        code.statistics[name] = from.get<double>();
    }
    const auto length = std::min<std::uint64_t>(from.get<std::uint64_t>(), text.bytes().size());
    code.text.assign(reinterpret_cast<const char*>(text.bytes().data()), length);
    code.messages = from.get_text();
    return code;
}

void put_options(ByteWriter& to, const SessionOptions& options)
{
    const auto& [threads, tile_height, packet_lanes, max_buffer_bytes, program_cache, program_file] = options;
    to.put(threads);
    to.put(tile_height);
    to.put(packet_lanes);
    to.put(max_buffer_bytes);
    to.put_text(program_cache.native());
    to.put_text(program_file.native());
}

SessionOptions get_options(ByteReader& from)
{
    SessionOptions options;
    options.threads = from.get<unsigned>();
    options.tile_height = from.get<unsigned>();
    options.packet_lanes = from.get<unsigned>();
    options.max_buffer_bytes = from.get<std::uint64_t>();
    options.program_cache = from.get_text();
    options.program_file = from.get_text();
    return options;
}

const void* scene_of(const KernelId& kernel, const SceneData& scene)
{
    if (is_portable(kernel)) return scene.packed;
    return scene.mesh;
}

SharedMemory put_scene(ByteWriter& to, const KernelId& kernel, const SceneData& scene)
{
    const bool is_packed = is_portable(kernel);
    to.put(is_packed);
    if (!is_packed) return put_arrays(to, *scene.mesh);
    to.put(scene.packed->layout);
    to.put(scene.packed->tet_count);
    to.put(scene.packed->divisions);
    to.put(scene.packed->stack_entries);
    return put_arrays(to, *scene.packed);
}

SentScene get_scene(ByteReader& from, Descriptor memory)
{
    SentScene scene;
    scene.is_packed = from.get<bool>();
    if (!scene.is_packed) {
        get_arrays(from, std::move(memory), scene.mesh);
        return scene;
    }
    scene.packed.layout = from.get<Layout>();
    scene.packed.tet_count = from.get<std::uint32_t>();
    scene.packed.divisions = from.get<std::uint32_t>();
    scene.packed.stack_entries = from.get<std::uint32_t>();
    get_arrays(from, std::move(memory), scene.packed);
    return scene;
}

void put_exception(ByteWriter& to)
{
    try {
        throw;
    } catch (const Error& error) {
        put_failure(to, Ended::error, error.kind(), error.what());
    } catch (const std::bad_alloc&) {
        put_failure(to, Ended::bad_alloc, ErrorKind::unsupported, {});
    } catch (const std::logic_error& error) { // ours
        put_failure(to, Ended::other, ErrorKind::internal, error.what());
    } catch (const std::exception& error) {
        put_failure(to, Ended::other, ErrorKind::driver, error.what());
    } catch (...) {
        put_failure(to, Ended::other, ErrorKind::driver, "an exception of unknown type");
    }
}

void put_success(ByteWriter& to)
{
    to.put(Ended::well);
}

void get_outcome(ByteReader& from)
{
    const auto how = from.get<Ended>();
    if (how == Ended::well) return;
    const auto kind = from.get<ErrorKind>();
    const std::string text = from.get_text();
    if (how == Ended::error) throw Error(kind, text);
    if (how == Ended::bad_alloc) throw std::bad_alloc();
    throw Error(ErrorKind::driver, text);
}

} // namespace tetrace
