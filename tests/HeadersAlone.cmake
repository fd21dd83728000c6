# Each header of ours compiles by itself. If a source of the same name includes its header first, building that
# shows it; the rest get a translation unit each, built with the tests. Of kernels/ that is layouts/layout.h; the others are parts
# of a kernel's source in several languages, which every backend compiles, as those of backends/openmp/packet/ are parts of
# one source for vectors of several widths.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/core/*.h ${PROJECT_SOURCE_DIR}/kernels/layouts/layout.h ${PROJECT_SOURCE_DIR}/backends/*.h
  ${PROJECT_SOURCE_DIR}/scenes/*.h ${PROJECT_SOURCE_DIR}/embed/*.h
  ${PROJECT_SOURCE_DIR}/bench/*.h)
list(FILTER headers EXCLUDE REGEX "^backends/openmp/packet/")
if(NOT TARGET tetrace_builder_lib)
  list(FILTER headers EXCLUDE REGEX "^scenes/builder/")
endif()

set(sources "")
foreach(header IN LISTS headers)
  string(REGEX REPLACE "h$" "cpp" own_source ${PROJECT_SOURCE_DIR}/${header})
  if(EXISTS ${own_source})
    file(STRINGS ${own_source} first_include REGEX "^#include" LIMIT_COUNT 1)
    if(first_include STREQUAL "#include \"${header}\"")
      continue()
    endif()
  endif()
  string(MAKE_C_IDENTIFIER ${header} name)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n#include \"${header}\" // guarded\n")
  list(APPEND sources ${source})
endforeach()
add_library(headers_alone OBJECT ${sources})
target_link_libraries(headers_alone PRIVATE tetrace_bench)
