# Assembles the small build anew, as a folder and an archive: cmake -DSOURCE= -DFOLDER= -DPROGRAM= -DOBJDUMP= -DVERSION=
# -P small.cmake. See README.small.in.
cmake_minimum_required(VERSION 3.25)
include(${SOURCE}/libraries.cmake)

file(REMOVE_RECURSE ${FOLDER} ${FOLDER}.tar.gz)
file(COPY ${PROGRAM} DESTINATION ${FOLDER}/bin)
list(APPEND left_to_the_system "^libstdc\\+\\+" "^libgcc_s") # drivers may need newer ones than a program carries along
copy_libraries("${PROGRAM}" "" ${FOLDER}/lib libraries)
list(REMOVE_ITEM compiled_in libcgal-demo) # the meshes' package
list(APPEND compiled_in libgomp1 liblzma-dev libre2-dev zlib1g-dev)
copy_licences("${libraries}" ${FOLDER}/licences packages)
file(COPY ${SOURCE}/../LICENSE DESTINATION ${FOLDER})
glibc_needed("${PROGRAM};${libraries}" GLIBC)
list(JOIN packages "\n    " PACKAGES)
configure_file(${SOURCE}/README.small.in ${FOLDER}/README @ONLY)

get_filename_component(place ${FOLDER} DIRECTORY)
get_filename_component(name ${FOLDER} NAME)
execute_process(COMMAND tar -C ${place} --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -czf ${FOLDER}.tar.gz ${name}
  COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${FOLDER}.tar.gz bytes)
math(EXPR kilobytes "${bytes} / 1024")
message(STATUS "${FOLDER}.tar.gz: ${kilobytes} KiB, needs glibc ${GLIBC}")
