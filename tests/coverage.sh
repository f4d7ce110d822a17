#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Print the share of lines of lib/ and plugins/ that the tests run, in percent, by gcov:
#   tests/coverage.sh [SOURCE [BUILD]]    SOURCE is this repository unless given, BUILD is SOURCE/build/coverage
# Takes a build and a run of all tests. BUILD/lines.txt then lists each file's share. Works on older versions of the
# repository too.
set -euo pipefail

source=$(realpath "${1:-$(dirname "${BASH_SOURCE[0]}")/..}")
build=${2:-$source/build/coverage}
mkdir -p "$build"
build=$(realpath "$build")

# -O1: without any optimisation the tests of ten million triangles take minutes.
options=(-S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DVMLIGHT_BENCH=OFF
    "-DCMAKE_CXX_FLAGS=--coverage -fprofile-update=atomic" -DCMAKE_CXX_FLAGS_DEBUG=-O1)
# Where a version builds several files as one, this takes a third of the time.
! grep -q UNITY_BUILD "$source/CMakePresets.json" || options+=(-DCMAKE_UNITY_BUILD=ON)
cmake "${options[@]}" >"$build/log"
cmake --build "$build" -j "$(nproc)" >>"$build/log"
find "$build" -name '*.gcda' -delete
# A failed test still covers what it ran.
ctest --test-dir "$build" -j "$(nproc)" >>"$build/log" 2>&1 || tail -n 20 "$build/log" >&2

# A file's line is covered if any of the objects that it was compiled into has run it.
cd "$build"
find . -name '*.gcno' -print0 | xargs -0 -n 16 gcov --json-format --stdout 2>/dev/null | python3 -c '
import json, os, sys

source, out = sys.argv[1:]
rooms = [os.path.join(source, room, "") for room in ("lib", "plugins")]
lines = {}  # {file: {line: count}}
for text in sys.stdin:
    report = json.loads(text)
    for file in report["files"]:
        path = os.path.realpath(os.path.join(report["current_working_directory"], file["file"]))
        if path.startswith(tuple(rooms)):
            counts = lines.setdefault(os.path.relpath(path, source), {})
            for line in file["lines"]:
                counts[line["line_number"]] = max(counts.get(line["line_number"], 0), line["count"])
with open(out, "w") as file:
    for path, counts in sorted(lines.items()):
        if not counts:
            continue
        covered = sum(count > 0 for count in counts.values())
        missed = " ".join(str(line) for line, count in sorted(counts.items()) if count == 0)
        file.write(f"{100 * covered / len(counts):6.2f} % of {len(counts):4}  {path}  {missed}\n")
for room in rooms:
    name = os.path.relpath(room, source) + os.sep
    counts = [count for path, file in lines.items() if path.startswith(name) for count in file.values()]
    if counts:
        print(f"{name:10} {100 * sum(count > 0 for count in counts) / len(counts):.2f} % of {len(counts)} lines")
' "$source" "$build/lines.txt"
