#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Times whole processes: makevismap against Cycles' ambient occlusion bake, makecfem against exrenvmap -b. Programs that are not
# installed are skipped.
#     bench/peers.sh MESH.obj ENVIRONMENT [RESOLUTION] [THREADS]      (executables in $VMLIGHT_BIN or build/release/bin)
set -euo pipefail
if [ $# -lt 2 ]; then
    echo "usage: bench/peers.sh MESH.obj ENVIRONMENT [RESOLUTION] [THREADS]" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
bin=${VMLIGHT_BIN:-$here/../build/release/bin}
mesh=$1 environment=$2 resolution=${3:-1024} threads=${4:-2}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# seconds COMMAND...: wall time of a whole process
seconds() {
    local start end
    start=$(date +%s.%N)
    "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; return 1; }
    end=$(date +%s.%N)
    awk -v a="$start" -v b="$end" 'BEGIN { printf "%.2f", b - a }'
}
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.1f", a / b }'; }
bake() { seconds "$bin/makevismap" "$mesh" -o "$work/vm.exr" --resolution "$resolution" --samples "$1" --margin 0 --threads "$threads" --quiet; }
cycles() {
    seconds blender --background --factory-startup --python "$here/cycles_bake.py" -- \
        "$(realpath "$mesh")" "$resolution" "$1" "$threads" "$work/ao.exr"
}
# rms A B: root mean square difference of two one-channel images
rms() { { idiff "$1" "$2" || true; } | awk '/RMS error/ { print $4 }'; } # idiff prints errors of images that differ only
visibility() { oiiotool "$1" --ch "$2" --chnames Y -d float -o "$3"; }

echo "$(basename "$mesh"), ${resolution}x$resolution, $threads threads"
printf '%-34s %10s %10s %8s\n' "bake" "Cycles s" "vmlight s" "ratio"
for samples in 16 64 256; do
    ours=$(bake "$samples")
    if command -v blender >/dev/null; then
        theirs=$(cycles "$samples")
        printf '%-34s %10s %10s %8s\n' "$samples samples, equal rays" "$theirs" "$ours" "$(ratio "$theirs" "$ours")"
    else
        printf '%-34s %10s %10s\n' "$samples samples" "-" "$ours"
    fi
done

# Equal error: each against its own bake with many rays; the least of our counts that is no worse than theirs.
if command -v blender >/dev/null && [ -n "${VMLIGHT_REFERENCE_SAMPLES:-}" ]; then
    bake "$VMLIGHT_REFERENCE_SAMPLES" >/dev/null
    visibility "$work/vm.exr" visibility "$work/our_reference.exr"
    cycles "$VMLIGHT_REFERENCE_SAMPLES" >/dev/null
    visibility "$work/ao.exr" R "$work/their_reference.exr"
    for samples in 16 64 256; do
        theirs=$(cycles "$samples")
        visibility "$work/ao.exr" R "$work/a.exr"
        their_error=$(rms "$work/a.exr" "$work/their_reference.exr")
        for ours_samples in 8 12 16 24 32 48 64 96 128 192 256 384 512; do
            ours=$(bake "$ours_samples")
            visibility "$work/vm.exr" visibility "$work/b.exr"
            our_error=$(rms "$work/b.exr" "$work/our_reference.exr")
            if awk -v a="$our_error" -v b="$their_error" 'BEGIN { exit !(a <= b) }'; then
                printf '%-34s %10s %10s %8s   RMS %s and %s\n' "Cycles $samples, vmlight $ours_samples, equal error" \
                    "$theirs" "$ours" "$(ratio "$theirs" "$ours")" "$their_error" "$our_error"
                break
            fi
        done
    done
fi

echo
echo "$(basename "$environment")"
printf '%-34s %10s %10s %8s\n' "cosine filter" "peer s" "vmlight s" "ratio"
ours=$(seconds "$bin/makecfem" "$environment" -o "$work/cfem.exr" --sanitize --quiet)
if command -v exrenvmap >/dev/null; then
    oiiotool "$environment" --ch R,G,B -d half -o "$work/environment.exr"
    theirs=$(seconds exrenvmap -b -l "$work/environment.exr" "$work/blurred.exr")
    printf '%-34s %10s %10s %8s\n' "exrenvmap -b" "$theirs" "$ours" "$(ratio "$theirs" "$ours")"
else
    printf '%-34s %10s %10s\n' "exrenvmap -b" "-" "$ours"
fi
