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
# Only what differs, so that little is built again; by content, since a patch that was applied and taken back leaves a newer file.
git ls-files -z | while IFS= read -r -d '' file; do
    cmp -s "$file" "$place/source/$file" || cp --parents "$file" "$place/source"
done
# Several files as one: the first build takes most of the time.
options=(-S "$place/source" -B "$place/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DVMLIGHT_BENCH=OFF)
! command -v ccache >/dev/null || options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
cmake "${options[@]}" >"$place/log"

build() {
    cmake --build "$place/build" -j "$(nproc)" --target hard_tests makevismap makecfem makelightmap \
        vismap.imageio cfem.imageio lightmap.imageio >>"$place/log" 2>&1
}

# Whether the tests pass that these patches name: tests of hard_tests, or Machine, which is of Python too. Each suite runs in
# a process of its own, as under ctest: Machine forks, which it can only before there are threads.
pass() {
    local names suite filter count ran
    mapfile -t names < <(cat "$@" | sed -n 's/^Test: *//p' | tr ' ' '\n' | sort -u | grep .)
    for suite in $(printf '%s\n' "${names[@]%%.*}" | sort -u); do
        filter=$(printf '%s\n' "${names[@]/%Machine/Machine.*}" | grep "^${suite}[.]" | paste -sd:)
        (cd "$place/build" && OIIO_LIBRARY_PATH="$PWD/plugins" tests/hard/hard_tests --gtest_filter="$filter") >"$place/tests.log" 2>&1 || return
        cat "$place/tests.log" >>"$place/log"
        # A name that is no test's any more would pass.
        count=$(grep -o : <<<"$filter" | wc -l)
        ran=$(sed -n 's/.*Running \([0-9]*\) tests* from.*/\1/p' "$place/tests.log")
        ((ran > count)) || return
    done
    [[ " ${names[*]} " != *" Machine "* ]] ||
        ctest --test-dir "$place/build" --no-tests=error -R '^hard\.Machine$' >>"$place/log" 2>&1
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
