#include "bench/verbs/commands.h"
#include "core/base/control_groups.h"

#include <cstdlib>
#include <new>

/// As the library's; but what exceeds a container's memory limit is refused, and rows and scenes say so. Otherwise the
/// kernel kills the process at the first touch.
void* operator new(std::size_t bytes)
{
    for (;;) {
        if (!tetrace::fits_in_memory(bytes)) throw std::bad_alloc();
        if (void* const memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}

int main(int argc, char** argv)
{
    return tetrace::run_program({argv + 1, argv + argc});
}
