/* Runs the launch of case.h on an OpenCL device, and compares its output. `tetrace dump` wrote both.
 * Build and run:  cc -O1 -o run_case run_case.c -l:libOpenCL.so.1 && ./run_case [TEXT]
 * TEXT: a part of the name of the platform or of the device. Without it, the first device.
 * Exit code: 0, the output is the expected one; 1, it differs; 2, the case cannot run here. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case.h"

static const struct {
    enum { value, buffer } kind;
    cl_uint argument;
    const char* file;
} inputs[] = {INPUTS};

static void check(cl_int code, const char* what)
{
    if (code == CL_SUCCESS) return;
    fprintf(stderr, "run_case: %s: %d\n", what, code);
    exit(2);
}

static void require(int holds, const char* problem, const char* of)
{
    if (holds) return;
    fprintf(stderr, "run_case: %s %s\n", problem, of);
    exit(2);
}

/* 16 bytes of 0 follow the file's. */
static void* read_file(const char* name, size_t* bytes)
{
    FILE* file = fopen(name, "rb");
    require(file != NULL && fseek(file, 0, SEEK_END) == 0, "cannot read", name);
    *bytes = (size_t)ftell(file);
    rewind(file);
    char* contents = calloc(*bytes + 16, 1);
    require(contents != NULL && fread(contents, 1, *bytes, file) == *bytes, "cannot read", name);
    fclose(file);
    return contents;
}

static cl_device_id find_device(const char* text)
{
    cl_platform_id platforms[64];
    cl_uint platform_count = 0, device_count = 0;
    check(clGetPlatformIDs(64, platforms, &platform_count), "clGetPlatformIDs");
    for (cl_uint p = 0; p < platform_count && p < 64; ++p) {
        cl_device_id devices[64];
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 64, devices, &device_count) != CL_SUCCESS) continue;
        for (cl_uint d = 0; d < device_count && d < 64; ++d) {
            char platform[1024] = "", device[1024] = "", driver[1024] = "";
            clGetPlatformInfo(platforms[p], CL_PLATFORM_NAME, sizeof(platform) - 1, platform, NULL);
            clGetDeviceInfo(devices[d], CL_DEVICE_NAME, sizeof(device) - 1, device, NULL);
            clGetDeviceInfo(devices[d], CL_DRIVER_VERSION, sizeof(driver) - 1, driver, NULL);
            if (strstr(platform, text) == NULL && strstr(device, text) == NULL) continue;
            printf("%s, %s %s\n", device, platform, driver);
            return devices[d];
        }
    }
    require(0, "no device or platform has in its name:", text);
    return NULL;
}

static int compare(const cl_uint* found)
{
    size_t bytes = 0, more = 0, wrong = 0;
    const cl_uint* wanted = read_file("expected.bin", &bytes);
    const cl_uint* tolerances = read_file("tolerance.bin", &more);
    require(bytes == 4 * OUTPUT_WORDS && more == bytes, "wrong size of", "expected.bin or tolerance.bin");
    for (size_t i = 0; i < OUTPUT_WORDS; ++i) {
        const cl_uint a = found[i], b = wanted[i];
        if ((a > b ? a - b : b - a) <= tolerances[i]) continue;
        if (wrong++ == 0) printf("word %zu is %u (0x%08x) instead of %u (0x%08x)\n", i, a, a, b, b);
    }
    printf("%zu of %d words differ\n", wrong, OUTPUT_WORDS);
    return wrong != 0;
}

int main(int argc, char** argv)
{
    cl_int code = 0;
    size_t bytes = 0;
    cl_device_id device = find_device(argc > 1 ? argv[1] : "");
    cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    check(code, "clCreateContext");
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, &code);
    check(code, "clCreateCommandQueue");

    static char log[65536];
    const char* source = read_file(PROGRAM, &bytes);
    cl_program program = clCreateProgramWithSource(context, 1, &source, &bytes, &code);
    check(code, "clCreateProgramWithSource");
    code = clBuildProgram(program, 1, &device, OPTIONS, NULL, NULL);
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, sizeof(log) - 1, log, NULL);
    fputs(log, stderr);
    check(code, "clBuildProgram");
    cl_kernel kernel = clCreateKernel(program, ENTRY, &code);
    check(code, "clCreateKernel");

    for (size_t i = 0; i < sizeof(inputs) / sizeof(inputs[0]); ++i) {
        void* contents = read_file(inputs[i].file, &bytes);
        if (inputs[i].kind == value) {
            check(clSetKernelArg(kernel, inputs[i].argument, bytes, contents), inputs[i].file);
            continue;
        }
        cl_mem memory = clCreateBuffer(context, CL_MEM_COPY_HOST_PTR, bytes < 16 ? 16 : bytes, contents, &code);
        check(code, inputs[i].file);
        check(clSetKernelArg(kernel, inputs[i].argument, sizeof(memory), &memory), inputs[i].file);
    }
#ifdef LARGE_BYTES /* a buffer that only the kernel sees */
    cl_mem large = clCreateBuffer(context, CL_MEM_READ_WRITE, LARGE_BYTES, NULL, &code);
    check(code, "the large buffer");
    check(clSetKernelArg(kernel, 3, sizeof(large), &large), "the large buffer");
#endif
    static cl_uint found[OUTPUT_WORDS];
    for (size_t i = 0; i < OUTPUT_WORDS; ++i)
        found[i] = OUTPUT_BEFORE;
    cl_mem output = clCreateBuffer(context, CL_MEM_COPY_HOST_PTR, sizeof(found), found, &code);
    check(code, "output");
    check(clSetKernelArg(kernel, OUTPUT, sizeof(output), &output), "output");
    const size_t group = GROUP, items = group * GROUPS;
    check(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &items, &group, 0, NULL, NULL), "clEnqueueNDRangeKernel");
    check(clEnqueueReadBuffer(queue, output, CL_TRUE, 0, sizeof(found), found, 0, NULL, NULL), "clEnqueueReadBuffer");
    return compare(found);
}
