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

# tetrace_room(<target> <sources>...): adds a folder's sources; a unity build, of mode GROUP, compiles them with those of
# the other rooms of TETRACE_WING: what all of them include takes longer than what each has of its own. A wing takes
# gcc 12 less than 30 s.
function(tetrace_room target)
  target_sources(${target} PRIVATE ${ARGN})
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${TETRACE_WING})
endfunction()

# tetrace_wing(<name> <room>...): adds the rooms of one wing.
macro(tetrace_wing name)
  set(TETRACE_WING ${name})
  foreach(room ${ARGN})
    add_subdirectory(${room})
  endforeach()
endmacro()
