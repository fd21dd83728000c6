#include "core/pack/traits.h"

#include "core/base/error.h"
#include "kernels/layouts/layout.h"

namespace tetrace {

const MethodTraits& traits_of(Method method)
{
    switch (method) {
#define METHOD(name, ...)                                                                                              \
    case Method::name: {                                                                                               \
        static constexpr MethodTraits traits{#name, __VA_ARGS__};                                                      \
        return traits;                                                                                                 \
    }
#include "kernels/kernel_list.inc"
    }
    throw Error(ErrorKind::internal, "traits_of: no such method");
}

const LayoutTraits& traits_of(Layout layout)
{
    constexpr std::uint64_t indices = std::uint64_t{1} << 32;
    switch (layout) {
#define LAYOUT(name, family, ...)                                                                                      \
    case Layout::name: {                                                                                               \
        static constexpr LayoutTraits traits{#name, Family::family, __VA_ARGS__, pack_##name};                         \
        return traits;                                                                                                 \
    }
#define FOREIGN_LAYOUT(name)                                                                                           \
    case Layout::name: {                                                                                               \
        static constexpr LayoutTraits traits{#name, Family::foreign, 0, 0, 0, {}};                                     \
        return traits;                                                                                                 \
    }
#include "kernels/kernel_list.inc"
    }
    throw Error(ErrorKind::internal, "traits_of: no such layout");
}

} // namespace tetrace
