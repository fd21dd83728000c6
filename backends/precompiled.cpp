// The object that compiles the precompiled headers of host kernels (cmake/Kernels.cmake).
