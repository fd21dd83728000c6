# Oclgrind, a device that checks every access, looks at the OpenCL kernels and at how they are called: no race, no access
# outside a buffer, no wrong call. Its exit code does not tell, its messages do.
find_program(OCLGRIND oclgrind)
mark_as_advanced(OCLGRIND)

# Ask a device of Oclgrind's own, tiny scenes and images: it interprets some million instructions a second.
set(check check --scene cubes --resolution 3 --size 12 --views 0)
set(asked_tiles ${check} --schedule tiles)
set(asked_persistent ${check} --schedule persistent)
set(asked_given ${check} --schedule persistent --rays random)
set(asked_search reproduce table5 --searches 5x16 --method maria --samples 3)
foreach(asked tiles persistent given search)
  set(name oclgrind_${asked})
  if(OCLGRIND)
    add_test(NAME ${name} COMMAND ${OCLGRIND} --check-api --data-races $<TARGET_FILE:tetrace> ${asked_${asked}}
      --backend opencl --device oclgrind)
    set_tests_properties(${name} PROPERTIES
      FAIL_REGULAR_EXPRESSION "Oclgrind - |OCLGRIND|data race at|Invalid (read|write)")
  else()
    add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: oclgrind is not installed (package oclgrind)")
    set_tests_properties(${name} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped")
  endif()
  set_tests_properties(${name} PROPERTIES LABELS large TIMEOUT 120)
endforeach()

# The same messages for a kernel with a race and a write past the end of its buffer.
if(OCLGRIND)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/oclgrind_twin.cl
    "__kernel void twin(__global uint* a) { a[0] = (uint)get_global_id(0); a[get_global_id(0) + 1] = a[0]; }\n")
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/oclgrind_twin.sim "oclgrind_twin.cl\ntwin\n8 1 1\n4 1 1\n<size=16 fill=0>\n")
  foreach(finding "data race at" "Invalid write")
    string(REPLACE " " "_" name ${finding})
    add_test(NAME oclgrind_finds_${name} COMMAND ${OCLGRIND}-kernel --data-races oclgrind_twin.sim
      WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
    set_tests_properties(oclgrind_finds_${name} PROPERTIES PASS_REGULAR_EXPRESSION ${finding} LABELS large TIMEOUT 60)
  endforeach()
endif()
