# SPDX-License-Identifier: Apache-2.0
# CPack runs this once the files of each package are in a folder of their own, before it packs them.
set(root ${CPACK_TEMPORARY_DIRECTORY})

# Debian's manual: man pages and changelogs are compressed, without the date.
file(GLOB_RECURSE pages ${root}/*/usr/share/man/*.1 ${root}/*/changelog ${root}/*/changelog.Debian)
foreach(page IN LISTS pages)
  execute_process(COMMAND gzip -9 -n -f ${page} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# What stripping leaves, and nobody reads.
file(GLOB_RECURSE binaries ${root}/*/usr/bin/* ${root}/*/usr/libexec/* ${root}/*/usr/lib/*.so*)
foreach(binary IN LISTS binaries)
  if(NOT IS_SYMLINK ${binary})
    execute_process(COMMAND strip --strip-unneeded --remove-section=.comment --remove-section=.note ${binary}
      COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()

# dpkg-shlibdeps asks for a source tree.
file(GLOB_RECURSE libraries ${root}/library/usr/lib/*.so.*)
set(source ${CPACK_TOPLEVEL_DIRECTORY}/shlibdeps)
file(MAKE_DIRECTORY ${source}/debian)
file(WRITE ${source}/debian/control "Source: vmlight\n\nPackage: vmlight\nArchitecture: any\n")
execute_process(COMMAND dpkg-shlibdeps -O ${libraries} WORKING_DIRECTORY ${source}
  OUTPUT_VARIABLE depends OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "^shlibs:Depends=" "" CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "${depends}")
