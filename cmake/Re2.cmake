# tetrace_re2: RE2, regular expressions whose matching takes linear time. Its package has CMake's files in newer
# releases of Debian (its headers need Abseil's there), and none in Debian 12.
find_package(re2 CONFIG QUIET)
add_library(tetrace_re2 INTERFACE)
if(TARGET re2::re2)
  target_link_libraries(tetrace_re2 INTERFACE re2::re2)
else()
  find_path(RE2_INCLUDE_DIR re2/re2.h REQUIRED)
  find_library(RE2_LIBRARY re2 REQUIRED)
  target_include_directories(tetrace_re2 SYSTEM INTERFACE ${RE2_INCLUDE_DIR})
  target_link_libraries(tetrace_re2 INTERFACE ${RE2_LIBRARY})
endif()
