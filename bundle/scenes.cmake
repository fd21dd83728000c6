# Packs scenes for a machine that cannot build them.

# pack_scenes(<names> <folder> <variable>): builds each scene, or takes it from the cache, and packs it as
# <folder>/<name>.tet.xz; the variable gets the names of those that could be had. Packed ones are kept in PARTS.
function(pack_scenes names folder variable)
  set(packed "")
  foreach(name IN LISTS names)
    scene_file(${name} file)
    if(file)
      get_filename_component(key ${file} NAME)
      if(NOT EXISTS ${PARTS}/${key}.xz)
        # Everything in it is words of four bytes: 4 % smaller than by -9e alone.
        execute_process(COMMAND ${XZ} --lzma2=preset=9e,lc=2,lp=2,pb=2 --stdout ${file} OUTPUT_FILE ${PARTS}/${key}.part
          COMMAND_ERROR_IS_FATAL ANY)
        file(RENAME ${PARTS}/${key}.part ${PARTS}/${key}.xz)
      endif()
      configure_file(${PARTS}/${key}.xz ${folder}/${name}.tet.xz COPYONLY)
      list(APPEND packed ${name})
    endif()
  endforeach()
  set(${variable} ${packed} PARENT_SCOPE)
endfunction()

# scene_file(<name> <variable>): the .tet file of a scene; empty, with the reason as a message, where it cannot be built.
# CDTs, since the bundle also reproduces the paper.
function(scene_file name variable)
  set(${variable} "" PARENT_SCOPE)
  if(NOT BUILDER)
    return()
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env XDG_CACHE_HOME=${CACHE} TETRACE_BUILDER=${BUILDER}
      ${PROGRAM} build --scene ${name} --tets cdt --views 0 --size 64 --format json
    OUTPUT_VARIABLE result ERROR_VARIABLE messages RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(STATUS "The bundle goes without the scene ${name}: ${messages}")
    return()
  endif()
  string(JSON file GET "${result}" tetrace builds 0 scene_record file)
  set(${variable} ${CACHE}/tetrace/${file} PARENT_SCOPE)
endfunction()
