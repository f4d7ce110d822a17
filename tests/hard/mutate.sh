#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Take guards out of the library, one at a time, and see the test of each fail:
#   tests/hard/mutate.sh [PATCH ...]      all of tests/hard/mutations unless some are named
# Each patch begins with "Test: " and the names of tests that must fail with it. Works on a copy in build/mutate. Exits
# with 1 if a test fails before its guard is out, or passes after.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

place=build/mutate
patches=("$@")
((${#patches[@]})) || patches=(tests/hard/mutations/*.patch)

mkdir -p "$place/source"
git ls-files -z | xargs -0 cp --parents --preserve=timestamps --update --target-directory="$place/source"
options=(-S "$place/source" -B "$place/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DVMLIGHT_BENCH=OFF)
! command -v ccache >/dev/null || options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
cmake "${options[@]}" >"$place/log"

build() {
    cmake --build "$place/build" -j "$(nproc)" --target hard_tests makevismap makecfem makelightmap \
        vismap.imageio cfem.imageio lightmap.imageio >>"$place/log" 2>&1
}

# Whether the tests pass that these patches name.
pass() {
    local names
    names=$(cat "$@" | sed -n 's/^Test: *//p' | tr ' \n' '||')
    ctest --test-dir "$place/build" --no-tests=error -R "^hard\.(${names%|})\$" >>"$place/log" 2>&1
}

echo "building (output in $place/log)"
build || { echo "the build failed" >&2; exit 1; }
pass "${patches[@]}" || { echo "tests fail with all guards in place" >&2; exit 1; }
survivors=0
for patch in "${patches[@]}"; do
    result="caught"
    if ! patch --quiet -p1 -d "$place/source" <"$patch"; then
        result="DOES NOT APPLY"
    else
        if ! build; then
            result="DOES NOT BUILD"
        elif pass "$patch"; then
            result="SURVIVES"
        fi
        patch --quiet -R -p1 -d "$place/source" <"$patch"
    fi
    [[ $result == caught ]] || survivors=$((survivors + 1))
    printf '%-14s %-44s %s\n' "$result" "$(basename "$patch" .patch)" "$(sed -n 's/^Test: *//p' "$patch")"
done
exit $((survivors > 0))
