// Loaded before the OpenCL loader (LD_PRELOAD), makes the drivers behind it misbehave: FAULTY_OPENCL is "<call> <how>",
// or "<call>:<n> <how>" for the n-th call of its kind. Only a process that loads drivers ever comes here.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <string>
#include <unistd.h>

namespace {

template <class Function>
Function* real(Function*, const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
#define REAL(function) real(&function, #function)

/// How the call is to go wrong; empty: not at all.
std::string fault_at(const std::string& call, int number)
{
    const char* const asked = std::getenv("FAULTY_OPENCL");
    if (asked == nullptr) return {};
    const std::string text = asked;
    for (const std::string& name : {call + " ", call + ":" + std::to_string(number) + " "})
        if (text.rfind(name, 0) == 0) return text.substr(name.size());
    return {};
}

std::string misbehave(const std::string& how)
{
    if (how == "abort") std::abort();
    if (how == "segv") std::signal(SIGSEGV, SIG_DFL), std::raise(SIGSEGV); // PoCL catches it
    if (how == "kill") std::raise(SIGKILL);
    if (how == "exit") ::_exit(7);
    while (how == "hang")
        ::pause();
    return how;
}

/// The codes that an API has for what may happen.
cl_int code_of(const std::string& how)
{
    if (how == "out-of-memory") return CL_OUT_OF_HOST_MEMORY;
    if (how == "lost") return CL_OUT_OF_RESOURCES;
    return CL_SUCCESS;
}

} // namespace

extern "C" cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                                 void(CL_CALLBACK* notify)(cl_program, void*), void* data)
{
    static int calls = 0;
    misbehave(fault_at("build", ++calls));
    return REAL(clBuildProgram)(program, count, devices, options, notify, data);
}

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                         const size_t* offset, const size_t* global, const size_t* local, cl_uint waits,
                                         const cl_event* wait_list, cl_event* event)
{
    static int calls = 0;
    if (const cl_int code = code_of(misbehave(fault_at("launch", ++calls))); code != CL_SUCCESS) return code;
    return REAL(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}

extern "C" cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool, size_t offset, size_t bytes,
                                      void* to, cl_uint waits, const cl_event* wait_list, cl_event* event)
{
    static int calls = 0;
    const std::string how = misbehave(fault_at("read", ++calls));
    const cl_int code = REAL(clEnqueueReadBuffer)(queue, buffer, CL_TRUE, offset, bytes, to, waits, wait_list, event);
    if (how == "garbage") std::memset(static_cast<char*>(to) + bytes / 2, 0x5a, bytes / 16);
    if (how == "nan") std::memset(static_cast<char*>(to) + bytes / 2, 0xff, bytes / 16);
    return code;
}
