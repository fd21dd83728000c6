# Which shared libraries a program needs, their licences, and the C library that they were linked for.

# What every Linux system brings itself, and what comes with a GPU's driver: never carried along.
set(left_to_the_system "^ld-linux" "^linux-vdso" "^lib(c|m|dl|rt|pthread|util|resolv)\\.so" "^libcuda" "^libnvidia")

# copy_libraries(<programs> <libraries loaded by name> <folder> <variable>): copies them and what they need under the
# names by which they are asked for; the variable gets the files that were copied from.
function(copy_libraries programs loaded folder variable)
  set(CMAKE_OBJDUMP ${OBJDUMP})
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${programs} LIBRARIES ${loaded} RESOLVED_DEPENDENCIES_VAR found
    UNRESOLVED_DEPENDENCIES_VAR missing PRE_EXCLUDE_REGEXES ${left_to_the_system})
  if(missing)
    message(FATAL_ERROR "Libraries that the bundle needs are not on this system: ${missing}")
  endif()
  foreach(library IN LISTS loaded)
    execute_process(COMMAND ${OBJDUMP} -p ${library} OUTPUT_VARIABLE headers COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCH "SONAME +([^\n ]+)" ignored "${headers}")
    get_filename_component(place ${library} DIRECTORY)
    list(APPEND found ${place}/${CMAKE_MATCH_1})
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(real_files "")
  foreach(library IN LISTS found)
    file(REAL_PATH ${library} real)
    get_filename_component(name ${library} NAME)
    configure_file(${real} ${folder}/${name} COPYONLY)
    list(APPEND real_files ${real})
    if(name STREQUAL "libstdc++.so.6")
      string(REGEX MATCH "[0-9]+$" patch ${real})
      file(WRITE ${folder}/libstdc++.version "${patch}\n") # run-all compares it with the host's
    endif()
  endforeach()
  list(REMOVE_DUPLICATES real_files)
  set(${variable} ${real_files} PARENT_SCOPE)
endfunction()

# Header-only or linked statically, so that no library shows them; and the package of the meshes.
set(compiled_in libarchive-dev libcli11-dev nlohmann-json3-dev libboost-dev libxxhash-dev librandom123-dev opencl-clhpp-headers
  libvulkan-dev libcgal-demo)

# copy_licences(<files> <folder> <variable>): the copyright files of the packages that the files are of, and of
# compiled_in, as far as these are installed; the variable gets a line "package version" each.
function(copy_licences files folder variable)
  set(names ${compiled_in})
  foreach(file IN LISTS files)
    # A package may still know a file below /usr by its place before the merge with /.
    string(REGEX REPLACE "^/usr" "" unmerged ${file})
    set(owner "")
    foreach(path ${file} ${unmerged} /usr${file})
      if(NOT owner)
        execute_process(COMMAND dpkg-query -S ${path} OUTPUT_VARIABLE owner ERROR_QUIET)
      endif()
    endforeach()
    if(owner MATCHES "^([^:,\n]+)")
      list(APPEND names ${CMAKE_MATCH_1})
    else()
      message(WARNING "No package of this system owns ${file}: add its licence to ${folder} before passing the bundle on")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES names)
  list(SORT names)
  set(lines "")
  foreach(name IN LISTS names)
    execute_process(COMMAND dpkg-query -W -f=\${Version} ${name} OUTPUT_VARIABLE version ERROR_QUIET)
    if(EXISTS /usr/share/doc/${name}/copyright)
      file(REAL_PATH /usr/share/doc/${name}/copyright licence)
      configure_file(${licence} ${folder}/${name} COPYONLY)
      list(APPEND lines "${name} ${version}")
    elseif(version)
      message(WARNING "${name} has no /usr/share/doc/${name}/copyright here: add its licence before passing the bundle on")
    endif()
  endforeach()
  set(${variable} ${lines} PARENT_SCOPE)
endfunction()

# glibc_needed(<files> <variable>): the newest version of the C library that they ask for, such as 2.34.
function(glibc_needed files variable)
  set(versions "")
  foreach(file IN LISTS files)
    execute_process(COMMAND ${OBJDUMP} -T ${file} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL "GLIBC_[0-9]+\\.[0-9]+" wanted "${symbols}")
    list(APPEND versions ${wanted})
  endforeach()
  list(REMOVE_DUPLICATES versions)
  list(SORT versions COMPARE NATURAL ORDER DESCENDING)
  list(GET versions 0 newest)
  string(REPLACE "GLIBC_" "" newest ${newest})
  set(${variable} ${newest} PARENT_SCOPE)
endfunction()
