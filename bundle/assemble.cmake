# Assembles the bundle anew: cmake -DSOURCE= -DBUNDLE= -DPARTS= -DPROGRAM= -DXZ= -DLOADERS= -DBUILDER= -DCACHE= -DOBJDUMP=
#                                -DVERSION= -DCUDA_CODE= -P assemble.cmake
# BUNDLE is the folder to make, PARTS keeps packed scenes between calls, PROGRAM is the relocatable tetrace, BUILDER
# tetrace-builder or empty, CACHE where scenes are built, CUDA_CODE the compiler of the CUDA kernels that are in it, or
# empty. The environment's TETRACE_BUNDLE_SCENES, names with ; between, keeps all other scenes out: for tests.
cmake_minimum_required(VERSION 3.25)
include(${SOURCE}/libraries.cmake)
include(${SOURCE}/packed.cmake)

set(max_bytes 67108864) # 64 MiB: what is carried to a machine, and what such machines' transfers accept

file(REMOVE_RECURSE ${BUNDLE})
file(COPY ${PROGRAM} DESTINATION ${BUNDLE}/bin)
file(COPY ${XZ} DESTINATION ${BUNDLE}/bin FOLLOW_SYMLINK_CHAIN)
file(COPY ${SOURCE}/run-all ${SOURCE}/icd DESTINATION ${BUNDLE})
copy_libraries("${PROGRAM};${XZ}" "${LOADERS}" ${BUNDLE}/lib libraries)
copy_licences("${libraries};${XZ}" ${BUNDLE}/licences packages)
file(COPY ${SOURCE}/../LICENSE DESTINATION ${BUNDLE})
file(GLOB embree ${BUNDLE}/lib/libembree*)
foreach(library IN LISTS embree) # larger than all others together
  get_filename_component(name ${library} NAME)
  pack(${library} ${name} -6 ${BUNDLE}/lib)
  file(REMOVE ${library})
endforeach()
set(both_kinds bunny armadillo banana)
set(losing atrium terrain city) # where BVHs win
if(DEFINED ENV{TETRACE_BUNDLE_SCENES})
  set(wanted "^($ENV{TETRACE_BUNDLE_SCENES})$")
  string(REPLACE ";" "|" wanted "${wanted}")
  list(FILTER both_kinds INCLUDE REGEX ${wanted})
  list(FILTER losing INCLUDE REGEX ${wanted})
endif()
pack_scenes("${both_kinds}" "cdt;rays" ${BUNDLE}/scenes scenes)
pack_scenes("${losing}" rays ${BUNDLE}/scenes losing)
list(APPEND scenes ${losing})

glibc_needed("${PROGRAM};${XZ};${libraries}" GLIBC)
list(JOIN packages "\n    " PACKAGES)
list(JOIN scenes ", " SCENES)
if(NOT scenes)
  set(SCENES "none (tetrace-builder or Debian's libcgal-demo was missing); the embedded scene cubes runs")
endif()
if(CUDA_CODE)
  set(CUDA "its kernels are in it, compiled by ${CUDA_CODE} for each generation that this knows, and as assembly (PTX) for newer ones")
else()
  string(CONCAT CUDA "its kernels are in it as source alone, since no nvcc was there when it was built: the machine needs "
    "NVRTC (libnvrtc.so.13, .12 or .11.2, of CUDA's toolkit or the package libnvrtc12), or else CUDA is left out. "
    "libnvrtc.so.* and libnvrtc-builtins.so.* copied into lib/ serve too")
  message(STATUS "The bundle lacks compiled CUDA kernels (no nvcc): ${CUDA}")
endif()
configure_file(${SOURCE}/README.in ${BUNDLE}/README @ONLY)

file(GLOB_RECURSE files ${BUNDLE}/*)
set(bytes 0)
foreach(file IN LISTS files)
  file(SIZE ${file} size)
  math(EXPR bytes "${bytes} + ${size}")
endforeach()
math(EXPR tenths "${bytes} * 10 / 1048576")
math(EXPR whole "${tenths} / 10")
math(EXPR tenth "${tenths} % 10")
message(STATUS "${BUNDLE}: ${whole}.${tenth} MiB (${bytes} bytes), scenes: ${SCENES}, needs glibc ${GLIBC}")
if(bytes GREATER max_bytes)
  message(FATAL_ERROR "The bundle has ${bytes} bytes, more than the ${max_bytes} (64 MiB) that it may have; its "
                      "largest parts: du -a ${BUNDLE} | sort -n | tail")
endif()
