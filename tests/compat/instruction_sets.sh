#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Executables built for any x86-64 and executables built for AVX2 and FMA must write the same files, bit for bit:
#   tests/compat/instruction_sets.sh
# Compares build/release with build/avx2, which it builds, and which needs a processor with AVX2.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

cmake --preset release -B build/avx2 -DVMLIGHT_BENCH=OFF -DCMAKE_CXX_FLAGS=-march=x86-64-v3 >/dev/null
for build in release avx2; do
    cmake --build "build/$build" -j "$(nproc)" --target makevismap makecfem makelightmap >/dev/null
    out=build/avx2/images/$build
    mkdir -p "$out"
    for basis in vector sh mask cells; do
        "build/$build/bin/makevismap" tests/data/spot.obj --resolution 128 --samples 64 --basis $basis --quiet -o "$out/vm_$basis.exr"
    done
    "build/$build/bin/makecfem" tests/data/kloppenheim_05.hdr --stack --quiet -o "$out/stack.exr"
    "build/$build/bin/makecfem" tests/data/studio_small_03.hdr --filter sh --quiet -o "$out/sh.exr"
    for basis in vector sh mask cells; do # of the same maps
        "build/$build/bin/makelightmap" "build/avx2/images/release/vm_$basis.exr" build/avx2/images/release/stack.exr \
            --rotate 20,35,-50 --quiet -o "$out/lit_$basis.exr"
    done
done
differ=0
for file in build/avx2/images/release/*.exr; do
    name=$(basename "$file")
    if cmp -s "$file" "build/avx2/images/avx2/$name"; then
        echo "equal    $name"
    else
        echo "DIFFERS  $name"
        oiiotool "$file" "build/avx2/images/avx2/$name" --diff || true
        differ=1
    fi
done
exit $differ
