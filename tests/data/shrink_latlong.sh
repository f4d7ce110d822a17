#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Reduces a lat-long map by a whole factor and keeps its light: pixels are averaged with the solid angle that they cover (a plain
# box filter weights the row at a pole three times too much). Needs oiiotool.
#   shrink_latlong.sh IN.hdr OUT.hdr WIDTH
set -euo pipefail
[[ $# == 3 ]] || { echo "usage: $0 IN.hdr OUT.hdr WIDTH" >&2; exit 2; }
in=$1 out=$2 width=$3

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
size=$(oiiotool "$in" --echo '{TOP.width} {TOP.height}')
read -r w h <<<"$size"

# Each row's solid angle, as a grey image.
awk -v w="$w" -v h="$h" 'BEGIN {
    print "P2", w, h, 65535
    for (y = 0; y < h; ++y) for (x = 0; x < w; ++x) print int(65535 * sin(3.14159265358979 * (y + 0.5) / h) + 0.5)
}' >"$work/weight.pgm"
small="${width}x$((h * width / w))"
oiiotool "$work/weight.pgm" --ch 0,0,0 --chnames R,G,B -d float -o "$work/weight.exr"
oiiotool "$in" "$work/weight.exr" --mul --resize:filter=box "$small" \
         "$work/weight.exr" --resize:filter=box "$small" --div --eraseattrib '.*' -o "$out"
