# Script of tetrace_embed(), see Kernels.cmake: -DOUTPUT -DNAMESPACE -DXZ -DFILES=<name>=<file>;...
# One stream for all: kernels are similar, and separate streams would be five times as long in total. The assembler reads
# it; its symbol is local, as there are several such sources.
set(files "")
set(rows "")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${entry}")
  list(APPEND files ${CMAKE_MATCH_2})
  file(SIZE "${CMAKE_MATCH_2}" length)
  string(APPEND rows "        {\"${CMAKE_MATCH_1}\", ${length}},\n")
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E cat ${files} COMMAND ${XZ} -6 --stdout
  OUTPUT_FILE ${OUTPUT}.xz COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${OUTPUT}.xz length)
file(WRITE ${OUTPUT} "// Written by CMake, see cmake/Kernels.cmake.
#include \"backends/embedded.h\"

asm(\".pushsection .rodata\\nembedded_stream: .incbin \\\"${OUTPUT}.xz\\\"\\n.popsection\");
extern \"C\" __attribute__((visibility(\"hidden\"))) const unsigned char embedded_stream[${length}];

namespace ${NAMESPACE} {

std::span<const tetrace::EmbeddedKernel> embedded_kernels()
{
    static constexpr tetrace::PackedKernel packed[] = {
${rows}    };
    static const tetrace::UnpackedKernels kernels(packed, embedded_stream);
    return kernels.list();
}

} // namespace ${NAMESPACE}
")
