# Script of tetrace_embed(), see Kernels.cmake: -DOUTPUT -DNAMESPACE -DFILES=<name>=<file>;...
set(arrays "")
set(rows "")
set(number 0)
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${entry}")
  set(name "${CMAKE_MATCH_1}")
  file(READ "${CMAKE_MATCH_2}" hex HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")
  # Aligned for those who read words. The closing 0 makes a text a C string; it does not count.
  string(APPEND arrays "alignas(16) const unsigned char kernel_${number}[] = {\n${hex}0};\n")
  string(APPEND rows "        {\"${name}\", std::as_bytes(std::span(kernel_${number}).first(sizeof(kernel_${number}) - 1))},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Written by CMake, see cmake/Kernels.cmake.
#include \"backends/embedded.h\"

namespace ${NAMESPACE} {

namespace {
${arrays}
} // namespace

std::span<const tetrace::EmbeddedKernel> embedded_kernels()
{
    static const tetrace::EmbeddedKernel kernels[] = {
${rows}    };
    return kernels;
}

} // namespace ${NAMESPACE}
")
