# Kernels that devices get as text or code: the list of them, each flattened into one text, and embedded into the
# program.

set(TETRACE_COMPILES all CACHE STRING "Which kernels are compiled: 'all', or, for a first table soon, layouts with commas: \
only their default kernels, in exact mode; tetrace says what is missing")
set_property(CACHE TETRACE_COMPILES PROPERTY STRINGS all half32,bvh2)
set(TETRACE_MATH_MODES exact fast)
if(NOT TETRACE_COMPILES STREQUAL "all")
  message(STATUS "Kernels: only the default ones of ${TETRACE_COMPILES} (TETRACE_COMPILES)")
  set(TETRACE_MATH_MODES exact)
endif()

# TETRACE_LAYOUTS and TETRACE_KERNELS, as structure/method/layout, are those of ours in kernels/kernel_list.inc, in its
# order; every backend compiles them in each of TETRACE_MATH_MODES. TETRACE_DOUBLE_KERNELS compute in double precision:
# openmp alone compiles them, in exact mode. Also set: TETRACE_FAMILY_<layout> and TETRACE_TASKS_<method>_<layout>;
# TETRACE_NATIVE_KERNELS are those with schedule native. TETRACE_TASKS, all in their order; TETRACE_CROSSING_TASKS.
set(tetrace_kernel_list ${PROJECT_SOURCE_DIR}/kernels/kernel_list.inc)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${tetrace_kernel_list})
set(TETRACE_LAYOUTS "")
set(TETRACE_KERNELS "")
set(TETRACE_NATIVE_KERNELS "")
set(TETRACE_DOUBLE_KERNELS "")
file(STRINGS ${tetrace_kernel_list} rows REGEX "^[A-Z_]*TASK[(][a-z]+, ")
set(TETRACE_TASKS "")
set(TETRACE_CROSSING_TASKS "")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^([A-Z_]*)TASK.([a-z]+)," ignored "${row}")
  list(APPEND TETRACE_TASKS ${CMAKE_MATCH_2})
  if(CMAKE_MATCH_1 STREQUAL "CROSSING_")
    list(APPEND TETRACE_CROSSING_TASKS ${CMAKE_MATCH_2})
  endif()
endforeach()
file(STRINGS ${tetrace_kernel_list} rows REGEX "^METHOD.*, doubles[)]")
set(double_methods "")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^METHOD.([a-z0-9]+)," ignored ${row})
  list(APPEND double_methods ${CMAKE_MATCH_1})
endforeach()
file(STRINGS ${tetrace_kernel_list} rows REGEX "^LAYOUT")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^LAYOUT.([a-z0-9]+), ([a-z]+)," ignored ${row})
  list(APPEND TETRACE_LAYOUTS ${CMAKE_MATCH_1})
  set(TETRACE_FAMILY_${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
endforeach()
set(compiled ${TETRACE_LAYOUTS})
if(NOT TETRACE_COMPILES STREQUAL "all")
  string(REPLACE "," ";" compiled "${TETRACE_COMPILES}")
  foreach(layout IN LISTS compiled)
    if(NOT layout IN_LIST TETRACE_LAYOUTS)
      message(FATAL_ERROR "TETRACE_COMPILES names '${layout}'; accepted are all, or of ${TETRACE_LAYOUTS} those wanted, with commas")
    endif()
  endforeach()
endif()
file(STRINGS ${tetrace_kernel_list} rows REGEX "^KERNEL")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^KERNEL.([a-z0-9]+), ([a-z0-9_]+), ([a-z |]+)," ignored ${row})
  set(method ${CMAKE_MATCH_1})
  set(layout ${CMAKE_MATCH_2})
  string(REPLACE " | " ";" tasks "${CMAKE_MATCH_3}")
  if(layout IN_LIST compiled AND (TETRACE_COMPILES STREQUAL "all" OR row MATCHES "by_default"))
    set(TETRACE_TASKS_${method}_${layout} ${tasks})
    string(REPLACE compact cdt structure ${TETRACE_FAMILY_${layout}}) # compact layouts are the CDT's too
    if(method IN_LIST double_methods)
      list(APPEND TETRACE_DOUBLE_KERNELS ${structure}/${method}/${layout})
      continue()
    endif()
    list(APPEND TETRACE_KERNELS ${structure}/${method}/${layout})
    if(row MATCHES "native")
      list(APPEND TETRACE_NATIVE_KERNELS ${structure}/${method}/${layout})
    endif()
  endif()
endforeach()

# TETRACE_DEFECTS: the reduced kernels of kernels/defects/defects.h; TETRACE_DEFECT_OPTIONS_<name>: how its text is
# compiled alone.
set(TETRACE_DEFECTS "")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/defects/defect_list.inc)
file(STRINGS ${PROJECT_SOURCE_DIR}/kernels/defects/defect_list.inc rows REGEX "^[A-Z_]*DEFECT[(]")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^([A-Z_]*DEFECT).([a-z0-9_]+)" ignored ${row})
  list(APPEND TETRACE_DEFECTS ${CMAKE_MATCH_2})
  string(REPLACE LANE_DEFECT "LANES;-DGROUP_DEFECT" option ${CMAKE_MATCH_1})
  string(REPLACE FAR_DEFECT "LARGE;-DGROUP_DEFECT" option "${option}")
  set(TETRACE_DEFECT_OPTIONS_${CMAKE_MATCH_2} -D${option}=${CMAKE_MATCH_2})
endforeach()

# tetrace_kernel_parts(<kernel>): sets structure, method, layout, family, name (that of embedded_name() without math
# mode), tasks, headers (the parts of the text) and definitions (which name these headers to C++).
macro(tetrace_kernel_parts kernel)
  string(REPLACE "/" ";" parts ${kernel})
  list(GET parts 0 structure)
  list(GET parts 1 method)
  list(GET parts 2 layout)
  set(name ${method}_${layout})
  set(family ${TETRACE_FAMILY_${layout}})
  set(tasks ${TETRACE_TASKS_${name}})
  set(walks kernels/walks)
  set(layouts kernels/layouts)
  if(structure STREQUAL bvh)
    set(walks kernels/bvh)
    set(layouts kernels/bvh)
  endif()
  set(headers METHOD=kernels/methods/${method}.h STRUCTURE=${walks}/structure_${family}.h
    ARRAYS=${layouts}/${family}_arrays.h LAYOUT=${layouts}/${layout}.h)
  if(structure STREQUAL bvh)
    set(loop ${layouts}/${layout}_together_cuda.h)
    if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${loop})
      set(loop ${layouts}/${layout}_loop.h)
    endif()
    list(APPEND headers LOOP=${loop})
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

# Schedule native: the decisions of exact mode, by instructions of AVX2. Elsewhere it is what every processor has.
set(TETRACE_HOST_FLAGS_native ${TETRACE_HOST_FLAGS_exact})
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND TETRACE_HOST_FLAGS_native -march=x86-64-v3)
endif()

# tetrace_host_kernel_headers(<target> <math> <header>...): precompiles what each kernel reads besides itself, which took
# longer than compiling the kernel. It and the kernels that reuse it have the same flags.
function(tetrace_host_kernel_headers target math)
  add_library(${target} OBJECT ${PROJECT_SOURCE_DIR}/backends/precompiled.cpp)
  target_link_libraries(${target} PRIVATE tetrace_options OpenMP::OpenMP_CXX)
  target_compile_options(${target} PRIVATE ${TETRACE_HOST_FLAGS_${math}})
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()

# Packets of rays: the widths that are compiled, from 4 lanes up. The program checks at run time which of them the
# processor can run.
set(TETRACE_PACKET_LANES 16 CACHE STRING "Most lanes of a packet: 16 (AVX-512), 8 (AVX2) or 4; other processors than x86-64 have 4")
set_property(CACHE TETRACE_PACKET_LANES PROPERTY STRINGS 16 8 4)
if(NOT TETRACE_PACKET_LANES MATCHES "^(4|8|16)$")
  message(FATAL_ERROR "TETRACE_PACKET_LANES is '${TETRACE_PACKET_LANES}'; accepted are 4, 8 and 16")
endif()
set(TETRACE_PACKET_WIDTHS 4)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  foreach(lanes 8 16)
    if(lanes LESS_EQUAL TETRACE_PACKET_LANES)
      list(APPEND TETRACE_PACKET_WIDTHS ${lanes})
    endif()
  endforeach()
endif()
set(tetrace_packet_flags_8 -mavx2)
set(tetrace_packet_flags_16 -mavx512f -mavx512bw -mavx512dq -mavx512vl -mprefer-vector-width=512)

# tetrace_compile_packets(<target> <lanes>): sets how a target with packets of that width is compiled.
function(tetrace_compile_packets target lanes)
  target_compile_definitions(${target} PRIVATE LANES=${lanes})
  target_link_libraries(${target} PRIVATE tetrace_options)
  target_compile_options(${target} PRIVATE ${TETRACE_HOST_FLAGS_exact} -Wno-psabi ${tetrace_packet_flags_${lanes}})
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
endfunction()

find_program(TETRACE_XZ xz REQUIRED DOC "Packs the kernels that the program carries, and the bundle's scenes")
set(tetrace_kernels_scripts ${CMAKE_CURRENT_LIST_DIR})
file(GLOB_RECURSE TETRACE_KERNEL_HEADERS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/*.h)
list(APPEND TETRACE_KERNEL_HEADERS ${PROJECT_SOURCE_DIR}/kernels/defects/defect_list.inc)

# tetrace_flatten(<output> <entry> [<kernel>]): a text in which every #include "..." of the entry file is replaced by
# the named file (once, if that has a guard), and every #include KERNEL_..._HEADER by
# the kernel's file.
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
# backends/embedded.h with the packed bytes of the files; a target with this source links tetrace_embedded.
function(tetrace_embed output namespace)
  set(files ${ARGN})
  list(TRANSFORM files REPLACE "^[^=]*=" "")
  add_custom_command(OUTPUT ${output} BYPRODUCTS ${output}.xz
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DNAMESPACE=${namespace} -DXZ=${TETRACE_XZ} "-DFILES=${ARGN}"
            -P ${tetrace_kernels_scripts}/embed.cmake
    DEPENDS ${files} ${tetrace_kernels_scripts}/embed.cmake
    COMMENT "Embedding kernels of ${namespace}" VERBATIM)
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON) # tests/mutants puts others in its place
endfunction()
