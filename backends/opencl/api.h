#pragma once

// OpenCL 1.2 through its C++ bindings, which throw cl::Error; include this, never CL/opencl.hpp or CL/cl.h.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

// The bindings call functions of our own (loader.cpp), which open libOpenCL.so.1 at run time. A program that links it
// too still has its own.
#define OPENCL_FUNCTION(name, count) extern "C" decltype(name) name __asm__("tetrace_" #name);
#include "backends/opencl/functions.inc"
#undef OPENCL_FUNCTION

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
