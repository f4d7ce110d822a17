# SPDX-License-Identifier: Apache-2.0

# Makes a changelog of Debian of the releases in CHANGELOG.md. version: of the package: PROJECT_VERSION, and more where
# CHANGELOG.md lists changes since. date: in seconds, of the environment's SOURCE_DATE_EPOCH, else of the last commit, else of
# the last release.
function(vmlight_debian_changelog changelog contact output version_name date_name)
  file(READ ${changelog} text)
  string(REGEX MATCHALL "\n## \\[[0-9.]+\\] - [0-9-]+" releases "${text}")
  if(NOT releases)
    message(FATAL_ERROR "no release in ${changelog}")
  endif()

  set(entries "")
  set(newest "")
  foreach(release IN LISTS releases)
    string(REGEX MATCH "\\[([0-9.]+)\\] - ([0-9-]+)" release "${release}")
    set(release_version ${CMAKE_MATCH_1})
    execute_process(COMMAND date -u -d "${CMAKE_MATCH_2} 12:00:00" +%s
      OUTPUT_VARIABLE seconds OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    if(NOT newest)
      set(newest ${seconds})
    endif()
    vmlight_changelog_entry(entries ${release_version} "Release ${release_version}: see changelog.gz." ${seconds} "${contact}")
  endforeach()

  set(version ${PROJECT_VERSION})
  set(date "$ENV{SOURCE_DATE_EPOCH}")
  if(NOT date)
    execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
      OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
  if(NOT date)
    set(date ${newest})
  endif()
  if(text MATCHES "\n## \\[Unreleased\\]\n+###")
    string(APPEND version "+unreleased")
    set(older "${entries}")
    set(entries "")
    vmlight_changelog_entry(entries ${version} "Changes since the last release: see changelog.gz." ${date} "${contact}")
    string(APPEND entries "\n${older}")
  endif()
  file(WRITE ${output} "${entries}")
  set(${version_name} ${version} PARENT_SCOPE)
  set(${date_name} ${date} PARENT_SCOPE)
endfunction()

function(vmlight_changelog_entry entries_name version change seconds contact)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C date -u -R -d @${seconds}
    OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(entry "vmlight (${version}-1) unstable; urgency=medium\n\n  * ${change}\n\n -- ${contact}  ${date}\n")
  if(${entries_name})
    set(entry "${${entries_name}}\n${entry}")
  endif()
  set(${entries_name} "${entry}" PARENT_SCOPE)
endfunction()
