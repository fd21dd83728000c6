// Loaded before the OpenCL loader (LD_PRELOAD), makes its drivers misbehave: FAULTY_OPENCL is "<call> <how>",
// or "<call>:<n> <how>" for the n-th call of its kind. Only a process that loads drivers ever comes here.
#define CL_TARGET_OPENCL_VERSION 120
#include "tests/isolation/misbehaviour.h"

#include <CL/cl.h>

#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <string>

using tetrace::test::fault_at;
using tetrace::test::misbehave;

namespace {

template <class Function>
Function* real(Function*, const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
#define REAL(function) real(&function, #function)

std::string fault(const char* call, int number)
{
    return misbehave(fault_at("FAULTY_OPENCL", call, number));
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
    static_cast<void>(fault("build", ++calls));
    return REAL(clBuildProgram)(program, count, devices, options, notify, data);
}

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                         const size_t* offset, const size_t* global, const size_t* local, cl_uint waits,
                                         const cl_event* wait_list, cl_event* event)
{
    static int calls = 0;
    if (const cl_int code = code_of(fault("launch", ++calls)); code != CL_SUCCESS) return code;
    return REAL(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}

extern "C" cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool, size_t offset, size_t bytes,
                                      void* to, cl_uint waits, const cl_event* wait_list, cl_event* event)
{
    static int calls = 0;
    const std::string how = fault("read", ++calls);
    const cl_int code = REAL(clEnqueueReadBuffer)(queue, buffer, CL_TRUE, offset, bytes, to, waits, wait_list, event);
    if (how == "garbage") std::memset(static_cast<char*>(to) + bytes / 2, 0x5a, bytes / 16);
    if (how == "nan") std::memset(static_cast<char*>(to) + bytes / 2, 0xff, bytes / 16);
    return code;
}

extern "C" cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t bytes, void* to, size_t* needed)
{
    const std::string how = what == CL_DEVICE_VERSION ? fault("version", 1) : std::string();
    if (how.empty()) return REAL(clGetDeviceInfo)(device, what, bytes, to, needed);
    const std::string version = how == "future" ? "OpenCL 9.9 of a time to come" : "\x1b[2J\xff 1.";
    if (needed != nullptr) *needed = version.size() + 1;
    if (to != nullptr) std::memcpy(to, version.c_str(), std::min(bytes, version.size() + 1));
    return CL_SUCCESS;
}
