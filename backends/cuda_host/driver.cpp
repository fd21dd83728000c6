#include "backends/cuda_host/driver.h"

#include "backends/cuda_host/kernels.h"
#include "core/base/control_groups.h"

#include <dlfcn.h>
#include <link.h>
#include <omp.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cfenv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <optional>
#include <string>

namespace tetrace::cuda {
struct ContextState {};
struct FunctionState {
    cuda_host::Entry entry;
};
struct ModuleState {
    void* library = nullptr; ///< of dlopen(); null: the kernels that the build compiled
    int file = -1;           ///< of the library: dlopen() takes what has the same name as an open one to be that
    std::deque<FunctionState> functions = {};
};
struct StreamState {};
struct EventState {
    std::chrono::steady_clock::time_point time;
};
} // namespace tetrace::cuda

namespace tetrace::cuda_host {

namespace {

using namespace cuda;

constexpr int emulated_version = 13000;
constexpr int emulated_capability = 90;
constexpr unsigned max_shared_bytes = 48 * 1024; // of a block, as CUDA has it without an attribute
constexpr std::size_t device_alignment = 256;    // as cuMemAlloc's
constexpr std::size_t copy_piece = std::size_t{1} << 20;

thread_local int host_threads = 0; // of this thread's next launches; 0: all

int team()
{
    return host_threads > 0 ? host_threads : omp_get_max_threads();
}

void* pointer(Address address)
{
    return reinterpret_cast<void*>(static_cast<std::uintptr_t>(address));
}

std::size_t bytes_of(int pages)
{
    return static_cast<std::size_t>(sysconf(pages)) * static_cast<std::size_t>(sysconf(_SC_PAGE_SIZE));
}

std::size_t memory_bytes()
{
    const std::size_t bytes = bytes_of(_SC_PHYS_PAGES);
    return std::min(bytes, ControlGroups().memory_bytes().value_or(bytes));
}

// The driver itself and its device

Result init(unsigned flags)
{
    return flags == 0 ? success : error_invalid_value;
}

Result driver_version(int* version)
{
    *version = emulated_version;
    return success;
}

Result error_name(Result error, const char** name)
{
    switch (error) {
    case success: *name = "CUDA_SUCCESS"; return success;
    case error_invalid_value: *name = "CUDA_ERROR_INVALID_VALUE"; return success;
    case error_out_of_memory: *name = "CUDA_ERROR_OUT_OF_MEMORY"; return success;
    case error_invalid_image: *name = "CUDA_ERROR_INVALID_IMAGE"; return success;
    case error_unsupported_ptx: *name = "CUDA_ERROR_UNSUPPORTED_PTX_VERSION"; return success;
    case error_launch_resources: *name = "CUDA_ERROR_LAUNCH_OUT_OF_RESOURCES"; return success;
    case error_not_found: *name = "CUDA_ERROR_NOT_FOUND"; return success;
    case error_launch_failed: *name = "CUDA_ERROR_LAUNCH_FAILED"; return success;
    case error_not_supported: *name = "CUDA_ERROR_NOT_SUPPORTED"; return success;
    default: *name = nullptr; return error_invalid_value;
    }
}

Result error_text(Result, const char** text)
{
    *text = "as the host emulation of CUDA reports it";
    return success;
}

Result device_count(int* count)
{
    *count = 1;
    return success;
}

Result device_get(Ordinal* device, int index)
{
    *device = 0;
    return index == 0 ? success : error_invalid_value;
}

Result device_name(char* name, int size, Ordinal)
{
    std::strncpy(name, "host emulation of CUDA", static_cast<std::size_t>(size));
    return success;
}

Result device_attribute(int* value, int attribute, Ordinal)
{
    switch (attribute) {
    case attribute_block_threads: *value = max_block_threads; return success;
    case attribute_warp_size: *value = warp_size; return success;
    case attribute_multiprocessors: *value = omp_get_num_procs(); return success;
    case attribute_capability_major: *value = emulated_capability / 10; return success;
    case attribute_capability_minor: *value = emulated_capability % 10; return success;
    default: return error_invalid_value;
    }
}

Result device_memory(std::size_t* bytes, Ordinal)
{
    *bytes = memory_bytes();
    return success;
}

Result device_uuid(unsigned char*, Ordinal)
{
    return error_not_supported;
}

Result device_pci(char*, int, Ordinal)
{
    return error_not_supported;
}

// Contexts and modules

Result context_retain(ContextHandle* context, Ordinal)
{
    static ContextState primary;
    *context = &primary;
    return success;
}

Result context_release(Ordinal)
{
    return success;
}

Result context_set_current(ContextHandle)
{
    return success;
}

/// The header of a shared object; empty for any other image, such as NVIDIA's machine code, which is ELF, too.
std::optional<ElfW(Ehdr)> library_header(const void* image)
{
    if (std::strncmp(static_cast<const char*>(image), ELFMAG, SELFMAG) != 0) return std::nullopt;
    ElfW(Ehdr) header;
    std::memcpy(&header, image, sizeof header);
    return header.e_machine == EM_CUDA ? std::nullopt : std::optional(header);
}

/// image: the object's bytes, which end with its table of sections, as compilers write it. False if it cannot be
/// loaded.
bool open_library(ModuleState& module, const ElfW(Ehdr) & header, const void* image)
{
    const std::size_t bytes = header.e_shoff + std::size_t{header.e_shnum} * header.e_shentsize;
    module.file = ::memfd_create("kernel", MFD_CLOEXEC);
    if (module.file < 0 || ::write(module.file, image, bytes) != static_cast<ssize_t>(bytes)) return false;
    module.library = ::dlopen(("/proc/self/fd/" + std::to_string(module.file)).c_str(), RTLD_NOW | RTLD_LOCAL);
    return module.library != nullptr;
}

Result module_unload(ModuleHandle module)
{
    if (module->library != nullptr) ::dlclose(module->library);
    if (module->file >= 0) ::close(module->file);
    delete module;
    return success;
}

Result module_load(ModuleHandle* module, const void* image, unsigned, int*, void**)
{
    auto* const made = new ModuleState;
    const auto header = library_header(image);
    if (header && !open_library(*made, *header, image)) {
        module_unload(made);
        return error_invalid_image;
    }
    *module = made;
    return success;
}

/// Null if the module lacks it.
Entry entry_of(const ModuleState& module, const char* name)
{
    if (module.library != nullptr)
        return reinterpret_cast<Entry>(::dlsym(module.library, (std::string("run_") + name).c_str()));
    const auto& entries = compiled_entries();
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const CompiledEntry& compiled) {
        return std::strcmp(compiled.name, name) == 0;
    });
    return found == entries.end() ? nullptr : found->entry;
}

Result module_function(FunctionHandle* function, ModuleHandle module, const char* name)
{
    const Entry entry = entry_of(*module, name);
    if (entry == nullptr) return error_not_found;
    *function = &module->functions.emplace_back(FunctionState{entry});
    return success;
}

Result blocks_per_multiprocessor(int* blocks, FunctionHandle, int, std::size_t)
{
    *blocks = 1;
    return success;
}

Result function_attribute(int*, int, FunctionHandle)
{
    return error_not_supported; // the host's compiler reports nothing
}

// Memory

Result memory_info(std::size_t* free, std::size_t* total)
{
    *total = memory_bytes();
    *free = bytes_of(_SC_AVPHYS_PAGES);
    *free = std::min(*free, ControlGroups().free_memory_bytes().value_or(*free));
    return success;
}

Result memory_allocate(Address* address, std::size_t bytes)
{
    if (bytes == 0) return error_invalid_value;
    if (bytes > memory_bytes() || !fits_in_memory(bytes)) return error_out_of_memory;
    const std::size_t whole = (bytes + device_alignment - 1) / device_alignment * device_alignment;
    void* memory = std::aligned_alloc(device_alignment, whole);
    if (memory == nullptr) return error_out_of_memory;
    *address = reinterpret_cast<std::uintptr_t>(memory);
    return success;
}

Result memory_free(Address address)
{
    std::free(pointer(address));
    return success;
}

Result copy_to_device(Address to, const void* from, std::size_t bytes, StreamHandle)
{
    std::memcpy(pointer(to), from, bytes);
    return success;
}

Result copy_to_host(void* to, Address from, std::size_t bytes, StreamHandle)
{
    std::memcpy(to, pointer(from), bytes);
    return success;
}

Result copy_on_device(Address to, Address from, std::size_t bytes, StreamHandle)
{
    auto* target = static_cast<std::byte*>(pointer(to));
    const auto* source = static_cast<const std::byte*>(pointer(from));
#pragma omp parallel for schedule(static) num_threads(team())
    for (std::size_t begin = 0; begin < bytes; begin += copy_piece)
        std::memcpy(target + begin, source + begin, std::min(copy_piece, bytes - begin));
    return success;
}

Result fill_words(Address to, unsigned word, std::size_t words, StreamHandle)
{
    std::fill_n(static_cast<unsigned*>(pointer(to)), words, word);
    return success;
}

// Streams and events: all work is done when a call returns

Result stream_create(StreamHandle* stream, unsigned)
{
    static StreamState only;
    *stream = &only;
    return success;
}

Result stream_destroy(StreamHandle)
{
    return success;
}

Result stream_synchronize(StreamHandle)
{
    return success;
}

Result stream_wait_event(StreamHandle, EventHandle, unsigned)
{
    return success;
}

Result event_create(EventHandle* event, unsigned)
{
    *event = new EventState;
    return success;
}

Result event_destroy(EventHandle event)
{
    delete event;
    return success;
}

Result event_record(EventHandle event, StreamHandle)
{
    event->time = std::chrono::steady_clock::now();
    return success;
}

Result event_synchronize(EventHandle)
{
    return success;
}

Result event_elapsed(float* milliseconds, EventHandle start, EventHandle end)
{
    *milliseconds = std::chrono::duration<float, std::milli>(end->time - start->time).count();
    return success;
}

// Launches

void run_block(Entry entry, std::uint32_t index, Dimensions block, void** arguments)
{
    Place place{{}, {index, 0, 0}, block};
    for (place.thread.z = 0; place.thread.z < block.z; ++place.thread.z)
        for (place.thread.y = 0; place.thread.y < block.y; ++place.thread.y)
            for (place.thread.x = 0; place.thread.x < block.x; ++place.thread.x)
                entry(place, arguments);
}

void run_grid(Entry entry, std::uint32_t blocks, Dimensions block, void** arguments)
{
#pragma omp parallel num_threads(team())
    {
        std::fenv_t environment;
        std::fegetenv(&environment);
        std::fesetenv(FE_DFL_ENV); // other libraries leave their threads flushing denormals
#pragma omp for schedule(dynamic)
        for (std::uint32_t index = 0; index < blocks; ++index)
            run_block(entry, index, block, arguments);
        std::fesetenv(&environment);
    }
}

/// Grids are one-dimensional: the backend launches no others.
Result launch(FunctionHandle function, unsigned grid_x, unsigned grid_y, unsigned grid_z, unsigned block_x,
              unsigned block_y, unsigned block_z, unsigned shared_bytes, StreamHandle, void** parameters, void**)
{
    const std::uint64_t threads = std::uint64_t{block_x} * block_y * block_z;
    if (grid_x == 0 || threads == 0 || threads > max_block_threads || shared_bytes > max_shared_bytes)
        return error_invalid_value;
    if (grid_y != 1 || grid_z != 1) return error_not_supported;
    run_grid(function->entry, grid_x, {block_x, block_y, block_z}, parameters);
    return success;
}

void use_threads(unsigned threads)
{
    host_threads = static_cast<int>(threads);
}

} // namespace

const Driver& emulated_driver()
{
    static const Driver driver = {
#define DRIVER_FUNCTION(member, symbol, parameters, arguments) .member = member,
#include "backends/cuda/driver_functions.inc"
#undef DRIVER_FUNCTION
        .use_threads = use_threads,
    };
    return driver;
}

} // namespace tetrace::cuda_host
