# What the bundle carries packed by xz: large libraries, and scenes for a machine that cannot build them.

# pack(<file> <name> <options of xz> <folder>): as <folder>/<name>.xz. Packed files are kept in PARTS by the content.
function(pack file name options folder)
  file(SHA1 ${file} content)
  set(kept ${PARTS}/${content}.xz)
  if(NOT EXISTS ${kept})
    execute_process(COMMAND ${XZ} ${options} --stdout ${file} OUTPUT_FILE ${kept}.part COMMAND_ERROR_IS_FATAL ANY)
    file(RENAME ${kept}.part ${kept})
  endif()
  configure_file(${kept} ${folder}/${name}.xz COPYONLY)
endfunction()

# pack_scenes(<names> <kinds> <folder> <variable>): builds each scene, or takes it from the cache, and packs it: of kind
# rays, with tets for rays, as <folder>/<name>-rays.tet.xz; of kind cdt, with TetGen's, which the paper's numbers need,
# as <folder>/<name>.tet.xz. The variable gets the names of those that could be had.
function(pack_scenes names kinds folder variable)
  set(packed "")
  foreach(name IN LISTS names)
    foreach(tets IN LISTS kinds)
      set(title ${name})
      if(tets STREQUAL rays)
        set(title ${name}-rays)
      endif()
      scene_file(${name} ${tets} file)
      if(file)
        # Everything in it is words of four bytes: 4 % smaller than by -9e alone.
        pack(${file} ${title}.tet --lzma2=preset=9e,lc=2,lp=2,pb=2 ${folder})
        list(APPEND packed ${title})
      endif()
    endforeach()
  endforeach()
  set(${variable} ${packed} PARENT_SCOPE)
endfunction()

# scene_file(<name> <tets> <variable>): the .tet file of a scene; empty, with the reason as a message, where it cannot be
# built.
function(scene_file name tets variable)
  set(${variable} "" PARENT_SCOPE)
  if(NOT BUILDER)
    return()
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env XDG_CACHE_HOME=${CACHE} TETRACE_BUILDER=${BUILDER}
      ${PROGRAM} build --scene ${name} --tets ${tets} --views 0 --size 64 --format json
    OUTPUT_VARIABLE result ERROR_VARIABLE messages RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(STATUS "The bundle goes without the scene ${name} (--tets ${tets}): ${messages}")
    return()
  endif()
  string(JSON file GET "${result}" tetrace builds 0 scene_record file)
  set(${variable} ${CACHE}/tetrace/${file} PARENT_SCOPE)
endfunction()
