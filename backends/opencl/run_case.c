/* Runs the launch that case.txt describes on an OpenCL device, and compares its output. `tetrace dump` wrote both.
 * Build and run:  cc -O1 -o run_case run_case.c -l:libOpenCL.so.1 && ./run_case [TEXT]
 * TEXT: a part of the name of the platform or of the device. Without it, the first device.
 * Exit code: 0, the output is the expected one; 1, it differs; 2, the case cannot run here.
 * Lines of case.txt:  program FILE   options TEXT   entry NAME   groups N   items N (of a group)   value INDEX FILE
 * buffer INDEX FILE   output INDEX BYTES WORD (its first contents)   expect FILE   tolerance FILE (for each word). */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char* what, long code)
{
    fprintf(stderr, "run_case: %s: %ld\n", what, code);
    exit(2);
}

static void check(cl_int code, const char* what)
{
    if (code != CL_SUCCESS) fail(what, code);
}

/* A 0 follows the bytes. */
static char* read_file(const char* name, size_t* bytes)
{
    FILE* file = fopen(name, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) fail(name, 0);
    *bytes = (size_t)ftell(file);
    rewind(file);
    char* text = calloc(*bytes + 1, 1);
    if (text == NULL || fread(text, 1, *bytes, file) != *bytes) fail(name, (long)*bytes);
    fclose(file);
    return text;
}

static cl_device_id find_device(const char* text)
{
    cl_platform_id platforms[64];
    cl_uint platform_count = 0;
    check(clGetPlatformIDs(64, platforms, &platform_count), "clGetPlatformIDs");
    for (cl_uint p = 0; p < platform_count && p < 64; ++p) {
        cl_device_id devices[64];
        cl_uint device_count = 0;
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
    fail("no device has this text in its name", (long)platform_count);
    return NULL;
}

static int compare(const char* found, const char* wanted, const char* tolerances, size_t bytes)
{
    size_t wrong = 0;
    for (size_t at = 0; at < bytes; at += 4) {
        cl_uint a, b, allowed = 0;
        memcpy(&a, found + at, 4);
        memcpy(&b, wanted + at, 4);
        if (tolerances != NULL) memcpy(&allowed, tolerances + at, 4);
        if ((a > b ? a - b : b - a) <= allowed) continue;
        if (wrong++ == 0) printf("word %zu is %u (0x%08x) instead of %u (0x%08x)\n", at / 4, a, a, b, b);
    }
    printf("%zu of %zu words differ\n", wrong, bytes / 4);
    return wrong != 0;
}

int main(int argc, char** argv)
{
    cl_int code = 0;
    cl_device_id device = find_device(argc > 1 ? argv[1] : "");
    cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    check(code, "clCreateContext");
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, &code);
    check(code, "clCreateCommandQueue");
    cl_kernel kernel = NULL;
    cl_mem output = NULL;
    cl_program program = NULL;
    char *expected = NULL, *tolerances = NULL, *manifest, *next = NULL, options[4096] = "";
    size_t groups = 1, items = 1, bytes = 0, output_bytes = 0;
    manifest = read_file("case.txt", &bytes);
    for (char* line = strtok_r(manifest, "\n", &next); line != NULL; line = strtok_r(NULL, "\n", &next)) {
        char key[32] = "", text[4096] = "", file[4096] = "";
        unsigned index = 0;
        if (line[0] == '#' || sscanf(line, "%31s %4095[^\n]", key, text) < 1) continue;
        sscanf(text, "%u %4095s", &index, file);
        if (strcmp(key, "options") == 0) {
            strcpy(options, text);
        } else if (strcmp(key, "program") == 0) {
            const char* source = read_file(text, &bytes);
            program = clCreateProgramWithSource(context, 1, &source, &bytes, &code);
            check(code, "clCreateProgramWithSource");
        } else if (strcmp(key, "entry") == 0) {
            static char log[65536];
            code = clBuildProgram(program, 1, &device, options, NULL, NULL);
            if (code != CL_SUCCESS)
                clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, sizeof(log) - 1, log, NULL);
            fputs(log, stderr);
            check(code, "clBuildProgram");
            kernel = clCreateKernel(program, text, &code);
            check(code, "clCreateKernel");
        } else if (strcmp(key, "groups") == 0) {
            groups = index;
        } else if (strcmp(key, "items") == 0) {
            items = index;
        } else if (strcmp(key, "value") == 0) {
            const char* value = read_file(file, &bytes);
            check(clSetKernelArg(kernel, index, bytes, value), line);
        } else if (strcmp(key, "buffer") == 0 || strcmp(key, "output") == 0) {
            cl_uint word = 0;
            char* contents = NULL;
            if (key[0] == 'b') contents = read_file(file, &bytes);
            if (key[0] == 'o' && sscanf(text, "%*u %zu %u", &bytes, &word) != 2) fail(line, 0);
            cl_mem buffer = clCreateBuffer(context, CL_MEM_READ_WRITE, bytes < 16 ? 16 : bytes, NULL, &code);
            check(code, line);
            if (contents != NULL && bytes != 0)
                check(clEnqueueWriteBuffer(queue, buffer, CL_TRUE, 0, bytes, contents, 0, NULL, NULL), line);
            if (contents == NULL) {
                check(clEnqueueFillBuffer(queue, buffer, &word, 4, 0, bytes, 0, NULL, NULL), line);
                output = buffer;
                output_bytes = bytes;
            }
            check(clSetKernelArg(kernel, index, sizeof(buffer), &buffer), line);
        } else if (strcmp(key, "expect") == 0 || strcmp(key, "tolerance") == 0) {
            *(key[0] == 'e' ? &expected : &tolerances) = read_file(text, &bytes);
            if (bytes != output_bytes) fail(line, (long)bytes);
        } else
            fail(line, 0);
    }
    if (kernel == NULL || output == NULL || expected == NULL) fail("case.txt lacks a program, output or expect", 0);
    size_t all = groups * items;
    check(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &all, &items, 0, NULL, NULL), "clEnqueueNDRangeKernel");
    char* found = malloc(output_bytes);
    if (found == NULL) fail("malloc", (long)output_bytes);
    check(clEnqueueReadBuffer(queue, output, CL_TRUE, 0, output_bytes, found, 0, NULL, NULL), "clEnqueueReadBuffer");
    return compare(found, expected, tolerances, output_bytes);
}
