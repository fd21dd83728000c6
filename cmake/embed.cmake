# Script of tetrace_embed(), see Kernels.cmake: -DOUTPUT -DNAMESPACE -DXZ -DFILES=<name>=<file>;...
# One stream for all: kernels are similar, and separate streams would be five times as long in total.
set(files "")
set(rows "")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${entry}")
  list(APPEND files ${CMAKE_MATCH_2})
  file(SIZE "${CMAKE_MATCH_2}" length)
  string(APPEND rows "        {\"${CMAKE_MATCH_1}\", ${length}},\n")
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E cat ${files} OUTPUT_FILE ${OUTPUT}.all COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${XZ} --lzma2=preset=9e,dict=8MiB --stdout ${OUTPUT}.all OUTPUT_FILE ${OUTPUT}.xz COMMAND_ERROR_IS_FATAL ANY)
file(READ ${OUTPUT}.xz hex HEX)
string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")
file(REMOVE ${OUTPUT}.all ${OUTPUT}.xz)
file(WRITE ${OUTPUT} "// Written by CMake, see cmake/Kernels.cmake.
#include \"backends/embedded.h\"

namespace ${NAMESPACE} {

namespace {
constexpr unsigned char stream[] = {
${hex}};
} // namespace

std::span<const tetrace::EmbeddedKernel> embedded_kernels()
{
    static constexpr tetrace::PackedKernel packed[] = {
${rows}    };
    static const tetrace::UnpackedKernels kernels(packed, stream);
    return kernels.list();
}

} // namespace ${NAMESPACE}
")
