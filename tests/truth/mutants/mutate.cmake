# Script of tetrace_mutate(): -DINPUT -DOUTPUT -DFROM -DTO. The input must contain the text exactly once.
file(READ ${INPUT} text)
string(FIND "${text}" "${FROM}" first)
string(FIND "${text}" "${FROM}" last REVERSE)
if(first EQUAL -1 OR NOT first EQUAL last)
  message(FATAL_ERROR "Mutating ${INPUT}: it does not contain '${FROM}' exactly once; the kernels have changed:  "
                      "change tests/truth/mutants/CMakeLists.txt too")
endif()
string(REPLACE "${FROM}" "${TO}" text "${text}")
file(WRITE ${OUTPUT} "${text}")
