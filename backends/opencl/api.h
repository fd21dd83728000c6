#pragma once

// OpenCL 1.2 through its C++ bindings, which throw cl::Error; include this, never CL/opencl.hpp.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
