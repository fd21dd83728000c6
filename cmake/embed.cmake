# Script of tetrace_embed(), see Kernels.cmake: -DOUTPUT -DNAMESPACE -DGZIP -DFILES=<name>=<file>;...
set(arrays "")
set(rows "")
set(number 0)
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${entry}")
  set(name "${CMAKE_MATCH_1}")
  set(file "${CMAKE_MATCH_2}")
  file(SIZE "${file}" length)
  execute_process(COMMAND ${GZIP} -9nc ${file} OUTPUT_FILE ${OUTPUT}.gz COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUTPUT}.gz hex HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")
  string(APPEND arrays "constexpr unsigned char kernel_${number}[] = {\n${hex}};\n")
  string(APPEND rows "        {\"${name}\", kernel_${number}, ${length}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(REMOVE ${OUTPUT}.gz)
file(WRITE ${OUTPUT} "// Written by CMake, see cmake/Kernels.cmake.
#include \"backends/embedded.h\"

namespace ${NAMESPACE} {

namespace {
${arrays}
} // namespace

std::span<const tetrace::EmbeddedKernel> embedded_kernels()
{
    static constexpr tetrace::PackedKernel packed[] = {
${rows}    };
    static const tetrace::UnpackedKernels kernels(packed);
    return kernels.list();
}

} // namespace ${NAMESPACE}
")
