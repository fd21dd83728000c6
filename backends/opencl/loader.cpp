#include "backends/opencl/loader.h"

#include "backends/opencl/api.h"

#include <boost/preprocessor/repetition/enum.hpp>
#include <boost/preprocessor/repetition/enum_params.hpp>
#include <dlfcn.h>

#include <tuple>

namespace tetrace::opencl {

namespace {

template <class Function>
struct Signature;
template <class Result_, class... Parameters>
struct Signature<Result_(Parameters...)> {
    using Result = Result_;
    template <std::size_t Index>
    using Parameter = std::tuple_element_t<Index, std::tuple<Parameters...>>;
};

struct Loader {
#define OPENCL_FUNCTION(name, count) decltype(&::name) name = nullptr;
#include "backends/opencl/functions.inc"
#undef OPENCL_FUNCTION
    std::string reason;

    /// Libraries that were loaded before it (LD_PRELOAD) replace its functions, as they do if it is linked; so its
    /// names are global, and the first of each is taken.
    Loader()
    {
        constexpr const char* remedy = "; install ocl-icd-libopencl1 and the OpenCL part of the GPU's driver, or "
                                       "pocl-opencl-icd, which runs on the processor";
        if (::dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_GLOBAL) == nullptr) {
            reason = "the OpenCL loader cannot be opened: " + std::string(::dlerror()) + remedy;
            return;
        }
        std::string missing;
        const auto find = [&](auto& function, const char* symbol) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(RTLD_DEFAULT, symbol));
            if (function == nullptr) missing.append(" ").append(symbol);
        };
#define OPENCL_FUNCTION(name, count) find(name, #name);
#include "backends/opencl/functions.inc"
#undef OPENCL_FUNCTION
        if (!missing.empty()) reason = "the OpenCL loader libOpenCL.so.1 lacks" + missing + remedy;
    }
};

const Loader& loader()
{
    static const Loader opened;
    return opened;
}

} // namespace

const std::string& why_no_loader()
{
    return loader().reason;
}

} // namespace tetrace::opencl

#define PARAMETER(z, index, name) tetrace::opencl::Signature<decltype(::name)>::Parameter<index> p##index
#define OPENCL_FUNCTION(name, count)                                                                                   \
    extern "C" tetrace::opencl::Signature<decltype(::name)>::Result name(BOOST_PP_ENUM(count, PARAMETER, name))        \
    {                                                                                                                  \
        return tetrace::opencl::loader().name(BOOST_PP_ENUM_PARAMS(count, p));                                         \
    }
#include "backends/opencl/functions.inc"
