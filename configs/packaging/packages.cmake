# SPDX-License-Identifier: Apache-2.0
# What each package says of itself. A description's first line is the short one; the lines after it are the long one.
set(about "vmlight bakes how much each texel of an object sees of its
surroundings, and in which direction. From that it relights the object
under any environment, at any rotation, in milliseconds.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "vmlight-doc, openimageio-tools, gnuplot-nox | gnuplot, blender")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "image-based lighting by visibility maps
${about}
.
This package contains the command-line tools, which bake, filter, light,
render and export, readers with which OpenImageIO opens recipes as images,
an OpenColorIO config, an add-on for Blender, and scripts for render farms.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "image-based lighting by visibility maps - shared library
${about}
.
This package contains the shared library.")
# The SONAME has the major version; before 1.0, a minor version may change the interface too.
math(EXPR next_minor "${PROJECT_VERSION_MINOR} + 1")
set(soname "${PROJECT_VERSION_MAJOR}")
set(package "libvmlight${soname}")
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/shlibs CONTENT
  "libvmlight @soname@ @package@ (>= @PROJECT_VERSION@), @package@ (<< @PROJECT_VERSION_MAJOR@.@next_minor@~)\n" @ONLY)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/triggers CONTENT "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/shlibs ${CMAKE_CURRENT_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS OFF) # finish.cmake does it: CPack would add scripts that run ldconfig

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS # vmlight has the OpenColorIO config, which the CMake package names
  "${package} (= ${full_version}), vmlight (= ${full_version}), libopenimageio-dev, libimath-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "image-based lighting by visibility maps - development files
${about}
.
This package contains the headers of the C++ library, and a CMake package
for find_package(vmlight).")

set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION "image-based lighting by visibility maps - documentation
${about}
.
This package contains the manual, as Markdown with pictures.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
if(python IN_LIST CPACK_COMPONENTS_ALL)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS # the module is of one version of Python
    "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_python}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-openimageio")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    ${CMAKE_CURRENT_SOURCE_DIR}/python/postinst ${CMAKE_CURRENT_SOURCE_DIR}/python/prerm)
endif()
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "image-based lighting by visibility maps - Python module
${about}
.
This package contains the module vmlight for Python 3, on NumPy arrays.")
