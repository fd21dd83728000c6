# Vulkan: its devices, and the code that they get.
find_path(TETRACE_SPIRV_HEADERS spirv/unified1/spirv.hpp)
mark_as_advanced(TETRACE_SPIRV_HEADERS)

tetrace_test(vulkan tetrace_vulkan tetrace_openmp tetrace_embree tetrace_scenes)
tetrace_test(vulkan_rt tetrace_vulkan tetrace_bench tetrace_scenes)

set(here ${CMAKE_CURRENT_BINARY_DIR}/vulkan)
file(MAKE_DIRECTORY ${here})
if(TETRACE_SPIRV_HEADERS)
  tetrace_spirv(${here}/vectors.spv ${CMAKE_CURRENT_SOURCE_DIR}/spirv/vectors.comp)
  tetrace_embed(${here}/twins.cpp tetrace::twins vectors=${here}/vectors.spv)
  tetrace_test(spirv tetrace_vulkan)
  target_sources(spirv_test PRIVATE ${here}/twins.cpp)
  target_include_directories(spirv_test SYSTEM PRIVATE ${TETRACE_SPIRV_HEADERS})
else()
  message(STATUS "The tests of the Vulkan kernels' SPIR-V are left out: spirv/unified1/spirv.hpp was not found; install spirv-headers")
endif()
