# Kernels that devices get as text or code: what there is, flattened into one text each, embedded into the program.

# The kernels that every backend compiles in both math modes, as structure/method/layout: structure_<family>.h with
# <method>.h and <layout>.h. Structure bvh has no methods of its own, nor have compact layouts.
set(TETRACE_KERNELS "")
foreach(method plane plucker stp ms06 maria project)
  foreach(layout tet80 tet96)
    list(APPEND TETRACE_KERNELS cdt/${method}/${layout})
  endforeach()
endforeach()
list(APPEND TETRACE_KERNELS cdt/project/half32 cdt/project/tet20 cdt/project/tet16 bvh/single/bvh2 bvh/single/cwbvh)
set(TETRACE_COMPACT_LAYOUTS tet20 tet16)

# tetrace_kernel_parts(<kernel>): sets structure, method, layout, family, which is cdt, bvh, or compact of tets that share
# their vertices, name, as embedded_name() has it without its math mode, tasks, those of core/pack/kernel_id.h that the
# kernel's text has, headers, the parts of the text, and definitions, which name them to C++.
macro(tetrace_kernel_parts kernel)
  string(REPLACE "/" ";" parts ${kernel})
  list(GET parts 0 structure)
  list(GET parts 1 method)
  list(GET parts 2 layout)
  set(name ${method}_${layout})
  set(family ${structure})
  if(layout IN_LIST TETRACE_COMPACT_LAYOUTS)
    set(family compact)
  endif()
  set(tasks trace)
  if(family STREQUAL cdt AND NOT layout STREQUAL half32)
    list(APPEND tasks search)
  endif()
  if(method MATCHES "^(maria|project|single)$" AND NOT family STREQUAL compact)
    list(APPEND tasks rays)
  endif()
  set(headers METHOD=kernels/methods/${method}.h)
  if(structure STREQUAL bvh)
    list(APPEND headers STRUCTURE=kernels/bvh/structure_bvh.h ARRAYS=kernels/bvh/bvh_arrays.h LAYOUT=kernels/bvh/${layout}.h)
  else()
    list(APPEND headers STRUCTURE=kernels/walks/structure_${family}.h ARRAYS=kernels/layouts/${family}_arrays.h
      LAYOUT=kernels/layouts/${layout}.h)
  endif()
  list(TRANSFORM headers REPLACE "(.*)=(.*)" "KERNEL_\\1_HEADER=\"\\2\"" OUTPUT_VARIABLE definitions)
endmacro()

# How kernels are compiled as host C++ in each math mode.
set(TETRACE_HOST_FLAGS_exact -ffp-contract=off)
set(TETRACE_HOST_FLAGS_fast -ffp-contract=fast -ffast-math)
if(CMAKE_BUILD_TYPE STREQUAL Debug)
  list(APPEND TETRACE_HOST_FLAGS_fast -O2) # gcc contracts from there on
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND TETRACE_HOST_FLAGS_fast -march=x86-64-v3) # contraction needs fused instructions; why_not() asks the processor
endif()

find_program(TETRACE_XZ xz REQUIRED DOC "Packs the kernels that the program carries, and the bundle's scenes")
set(tetrace_kernels_scripts ${CMAKE_CURRENT_LIST_DIR})
file(GLOB_RECURSE TETRACE_KERNEL_HEADERS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/*.h)

# tetrace_flatten(<output> <entry> [<kernel>]): a text in which every #include "..." of the entry file is replaced by what
# it names (once more wherever it stands: there are no guards but one), and every #include KERNEL_..._HEADER by the
# kernel's.
function(tetrace_flatten output entry)
  if(ARGC GREATER 2)
    tetrace_kernel_parts(${ARGV2})
  endif()
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DENTRY=${entry} -DOUTPUT=${output} -DROOT=${PROJECT_SOURCE_DIR} "-DHEADERS=${headers}"
            -P ${tetrace_kernels_scripts}/flatten.cmake
    DEPENDS ${entry} ${TETRACE_KERNEL_HEADERS} ${tetrace_kernels_scripts}/flatten.cmake
    COMMENT "Flattening ${output}" VERBATIM)
endfunction()

# tetrace_embed(<output.cpp> <namespace> <name>=<file>...): defines <namespace>::embedded_kernels() of
# backends/embedded.h with the bytes of the files, packed; what has it needs tetrace_embedded.
function(tetrace_embed output namespace)
  set(files ${ARGN})
  list(TRANSFORM files REPLACE "^[^=]*=" "")
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DNAMESPACE=${namespace} -DXZ=${TETRACE_XZ} "-DFILES=${ARGN}"
            -P ${tetrace_kernels_scripts}/embed.cmake
    DEPENDS ${files} ${tetrace_kernels_scripts}/embed.cmake
    COMMENT "Embedding kernels of ${namespace}" VERBATIM)
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON) # tests/mutants puts others in its place
endfunction()
