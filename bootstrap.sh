#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and tests vmlight on a bare Debian 12 (bookworm). Installs missing packages with apt-get (through sudo unless root);
# everything else stays in build/ and demo-out/ of this folder.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() {
    cat <<'END'
usage: ./bootstrap.sh demo|test|package [CMAKE_ARGUMENT...]
  demo      build the executables, light and render the bundled mesh with them, write pictures to demo-out/
  test      build everything and run the test suite
  package   make Debian packages in build/package/packages/
Further arguments are passed to cmake: -DVMLIGHT_WERROR=ON
END
}

# For the library, its tests and its pictures. (zlib is needed by assimp's CMake files, but not a dependency of its package.)
packages=(
    ca-certificates cmake g++ ninja-build
    libopenimageio-dev libimath-dev libembree-dev libassimp-dev zlib1g-dev libhwy-dev libtomlplusplus-dev nlohmann-json3-dev
    libpugixml-dev libeigen3-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev
    libglfw3-dev libepoxy-dev libimgui-dev libopencolorio-dev libegl1 libgl1-mesa-dri xvfb xdotool
    libgmock-dev libgtest-dev libbenchmark-dev
    pybind11-dev python3-dev
    python3 python3-numpy python3-openimageio openimageio-tools opencolorio-tools gnuplot-nox
)

package_tools=(dpkg-dev file)

# Used where the suite has them.
optional_packages=(libalembic-graphics-dev)

is_installed() { dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q 'ok installed'; }

apt_get() {
    local as_root=()
    if ((EUID != 0)); then
        command -v sudo >/dev/null || { echo "bootstrap: need root or sudo to install packages" >&2; exit 1; }
        as_root=(sudo)
    fi
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq "$@" >/dev/null
}

install_packages() {
    if ! command -v apt-get >/dev/null; then
        echo "bootstrap: no apt-get; building with the installed libraries. Required Debian packages: ${packages[*]}"
        return
    fi
    local missing=() package
    for package in "${packages[@]}"; do
        is_installed "$package" || missing+=("$package")
    done
    ((${#missing[@]} == 0)) || apt_get update
    for package in "${optional_packages[@]}"; do
        if ! is_installed "$package" && apt-cache show "$package" >/dev/null 2>&1; then missing+=("$package"); fi
    done
    ((${#missing[@]})) || return 0
    echo "bootstrap: installing ${missing[*]}"
    apt_get install -y --no-install-recommends "${missing[@]}"
}

say() { echo "bootstrap: $* (${SECONDS} s)"; }

mode=${1:-}
case $mode in
demo | test) shift ;;
package)
    shift
    packages+=("${package_tools[@]}")
    umask 022 # CPack gives it to the members of packages
    ;;
-h | --help)
    usage
    exit 0
    ;;
*)
    usage >&2
    exit 2
    ;;
esac

jobs=$(nproc)
install_packages
preset=release
[[ $mode != package ]] || preset=package
say "configuring"
# The Python for which Debian's modules are, whichever comes first in PATH.
if [[ -x /usr/bin/python3 ]]; then set -- -DPython3_EXECUTABLE=/usr/bin/python3 "$@"; fi
configured=$(cmake --preset $preset "$@" 2>&1) || { echo "$configured" >&2; exit 1; }
case $mode in
demo)
    say "building"
    cmake --build --preset release -j "$jobs" --target makevismap makecfem makelightmap vmframes
    say "running the demo"
    bench/demo.sh build/release demo-out
    ;;
test)
    say "building"
    cmake --build --preset release -j "$jobs"
    say "testing"
    ctest --preset release -j $((jobs + 1)) # some wait for windows, browsers and clusters
    ;;
package)
    say "building"
    cmake --build --preset package -j "$jobs"
    say "packing"
    cpack --preset package
    ;;
esac
say "done"
