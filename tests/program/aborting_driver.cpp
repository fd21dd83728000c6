// A driver that ends the process as soon as it is loaded, as broken ones do.
#include <cstdlib>

__attribute__((constructor)) static void end()
{
    std::abort();
}
