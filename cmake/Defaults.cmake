# The settings that all our targets share, as an interface target: nothing is directory-wide.
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

add_library(tetrace_options INTERFACE)
target_compile_features(tetrace_options INTERFACE cxx_std_20)
target_include_directories(tetrace_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(tetrace_options INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # it looks for garbage less often: a tenth less time for a sixth more memory
  target_compile_options(tetrace_options INTERFACE "SHELL:--param ggc-min-heapsize=4000000")
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # it takes a source that another one includes for a header
  target_compile_options(tetrace_options INTERFACE -Wno-subobject-linkage)
endif()

# For everything except the kernels of math mode fast: cameras, packed data and answers are the same bits on every
# machine.
add_library(tetrace_exact INTERFACE)
target_link_libraries(tetrace_exact INTERFACE tetrace_options)
target_compile_options(tetrace_exact INTERFACE -ffp-contract=off)

option(TETRACE_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
if(TETRACE_SANITIZE)
  target_compile_options(tetrace_options INTERFACE -fsanitize=address,undefined -fno-sanitize=null,object-size,vptr -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(tetrace_options INTERFACE -fsanitize=address,undefined)
endif()
option(TETRACE_FUZZ "With TETRACE_SANITIZE and clang: build libFuzzer's programs, the target 'fuzzers'" OFF)
if(TETRACE_FUZZ)
  target_compile_options(tetrace_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
option(TETRACE_SANITIZE_THREADS "With clang: build with ThreadSanitizer" OFF)
if(TETRACE_SANITIZE_THREADS)
  target_compile_options(tetrace_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(tetrace_options INTERFACE -fsanitize=thread)
endif()

# tetrace_folders(<target> <folder>... [WITHOUT <source>...]): adds the sources of these folders. A unity build compiles a
# folder, with its subfolders, at once: what all of them include takes longer than what each has of its own.
function(tetrace_folders target)
  cmake_parse_arguments(PARSE_ARGV 1 given "" "" WITHOUT)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  foreach(folder IN LISTS given_UNPARSED_ARGUMENTS)
    file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${folder}/*.cpp)
    list(REMOVE_ITEM sources ${given_WITHOUT})
    string(REGEX REPLACE "/.*" "" group ${folder})
    target_sources(${target} PRIVATE ${sources})
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()
