# TETRACE_NVCC: nvcc, if one works here (-DTETRACE_NVCC= disables it). Sets TETRACE_NVCC_VERSION ("13.0"), empty without
# nvcc; TETRACE_NVCC_ARCHITECTURES, for which machine code is made; TETRACE_NVCC_TARGETS, the options that compile for
# them. Assembly of the newest of them goes with it: any later device's driver compiles that.
find_program(TETRACE_NVCC nvcc HINTS ENV CUDA_PATH ENV CUDA_HOME PATH_SUFFIXES bin PATHS /usr/local/cuda/bin /opt/cuda/bin
  DOC "NVIDIA's compiler; empty: kernels are compiled by NVRTC at run time")
set(TETRACE_CUDA_CODE here CACHE STRING "What nvcc compiles kernels for: 'here', the GPUs of this machine, or the oldest \
architecture if it has none; 'all', one architecture a generation; or numbers, as 80;90")

# One architecture a generation: code for sm_80 also runs on sm_86 and sm_89; code for these too would double a kernel's
# compile time and its bytes in the program.
set(generations 75 80 90)
if(TETRACE_CUDA_CODE STREQUAL "all")
  set(wanted ${generations})
elseif(TETRACE_CUDA_CODE STREQUAL "here")
  execute_process(COMMAND nvidia-smi --query-gpu=compute_cap --format=csv,noheader RESULT_VARIABLE failed
    OUTPUT_VARIABLE gpus ERROR_QUIET)
  string(REGEX MATCHALL "[0-9]+\\.[0-9]" wanted "${gpus}")
  string(REPLACE "." "" wanted "${wanted}")
  list(REMOVE_DUPLICATES wanted)
  if((failed OR NOT wanted) AND NOT TETRACE_COMPILES STREQUAL "all") # no row would run it
    set(TETRACE_NVCC_VERSION "")
    return()
  elseif(failed OR NOT wanted)
    list(GET generations 0 wanted)
  endif()
else()
  set(wanted ${TETRACE_CUDA_CODE})
endif()
list(SORT wanted COMPARE NATURAL)

# An nvcc that does not know the host's compiler fails on any file.
if(TETRACE_NVCC AND NOT "${TETRACE_NVCC} for ${wanted}" STREQUAL "${TETRACE_NVCC_TRIED}")
  set(TETRACE_NVCC_TRIED "${TETRACE_NVCC} for ${wanted}" CACHE INTERNAL "what the other entries are of")
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/try.cu "__global__ void nothing() {}\n")
  execute_process(COMMAND ${TETRACE_NVCC} --ptx -std=c++17 -o ${CMAKE_CURRENT_BINARY_DIR}/try.ptx ${CMAKE_CURRENT_BINARY_DIR}/try.cu
    RESULT_VARIABLE failed ERROR_VARIABLE errors OUTPUT_QUIET)
  execute_process(COMMAND ${TETRACE_NVCC} --version OUTPUT_VARIABLE version ERROR_QUIET)
  execute_process(COMMAND ${TETRACE_NVCC} --list-gpu-code OUTPUT_VARIABLE known ERROR_QUIET)
  string(REGEX MATCH "release ([0-9.]+)" version "${version}")
  set(TETRACE_NVCC_FOUND_VERSION "${CMAKE_MATCH_1}" CACHE INTERNAL "")
  if(failed)
    message(STATUS "${TETRACE_NVCC} does not work, CUDA kernels are left to NVRTC: ${errors}")
    set(TETRACE_NVCC_FOUND_VERSION "" CACHE INTERNAL "")
  endif()
  set(architectures "")
  foreach(number IN LISTS wanted)
    if(known MATCHES "sm_${number}[ \n]")
      list(APPEND architectures ${number})
    endif()
  endforeach()
  if(NOT architectures) # this nvcc is too new or too old for all of them: the next one that it knows, or its newest
    string(REGEX MATCHALL "sm_[0-9]+" known "${known}")
    string(REPLACE "sm_" "" known "${known}")
    list(SORT known COMPARE NATURAL)
    list(GET wanted 0 least)
    foreach(number IN LISTS known)
      if(NOT architectures OR architectures LESS least)
        set(architectures ${number})
      endif()
    endforeach()
  endif()
  set(TETRACE_NVCC_ARCHITECTURES "${architectures}" CACHE INTERNAL "")
endif()

set(TETRACE_NVCC_VERSION "")
set(TETRACE_NVCC_TARGETS "")
if(TETRACE_NVCC AND TETRACE_NVCC_ARCHITECTURES)
  set(TETRACE_NVCC_VERSION "${TETRACE_NVCC_FOUND_VERSION}")
  foreach(number IN LISTS TETRACE_NVCC_ARCHITECTURES)
    list(APPEND TETRACE_NVCC_TARGETS --generate-code=arch=compute_${number},code=sm_${number})
    set(newest ${number})
  endforeach()
  list(APPEND TETRACE_NVCC_TARGETS --generate-code=arch=compute_${newest},code=compute_${newest})
endif()
if(NOT TETRACE_NVCC_VERSION)
  message(STATUS "CUDA kernels are compiled at run time, by NVRTC: no nvcc (package nvidia-cuda-toolkit)")
endif()
