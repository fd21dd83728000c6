#include "backends/cuda/driver.h"

#include "core/device/device_facts.h"

#include <dlfcn.h>

namespace tetrace::cuda {

namespace {

constexpr const char* remedy = "; install NVIDIA's driver (Debian: package nvidia-driver, or only libcuda1)";

/// Adds the names of functions that the library lacks to `missing`.
Driver functions_of(void* library, std::string& missing)
{
    Driver driver;
    const auto find = [&](auto& function, const char* symbol) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, symbol));
        if (function == nullptr) missing.append(" ").append(symbol);
    };
#define DRIVER_FUNCTION(member, symbol, parameters, arguments) find(driver.member, #symbol);
#include "backends/cuda/driver_functions.inc"
#undef DRIVER_FUNCTION
    driver.use_threads = reinterpret_cast<decltype(driver.use_threads)>(dlsym(library, use_threads_symbol));
    return driver;
}

} // namespace

LoadedDriver load_driver(const char* name)
{
    void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        const char* why = dlerror();
        return {{}, std::string("no NVIDIA driver: ") + (why != nullptr ? why : name) + remedy};
    }
    std::string missing;
    const Driver driver = functions_of(library, missing);
    if (!missing.empty())
        return {{}, std::string(name) + " is too old for this program, CUDA 11 is needed: it lacks" + missing + remedy};
    if (const Result result = driver.init(0); result != success)
        return {{}, "starting the NVIDIA driver (" + std::string(name) + "): " + text_of(driver, result)};
    return {driver, {}, library_holding(reinterpret_cast<const void*>(driver.init))};
}

std::string text_of(const Driver& driver, Result result)
{
    const char *name = nullptr, *text = nullptr;
    driver.error_name(result, &name);
    driver.error_text(result, &text);
    if (name == nullptr) return "CUDA error " + std::to_string(result);
    return std::string(name) + (text != nullptr ? " (" + std::string(text) + ")" : "");
}

std::string version_text(int version)
{
    return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

} // namespace tetrace::cuda
