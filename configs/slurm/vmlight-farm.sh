#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Bakes visibility maps in parts on a Slurm cluster: an array job with a task for each part, and a job that joins them.
# See docs/farm.md.
set -euo pipefail

usage() {
    cat <<'EOF'
Usage: vmlight-farm.sh PARTS [SBATCH OPTIONS] -- MESH -o OUTPUT.exr [OPTIONS OF makevismap]

Submits PARTS tasks, each of which bakes one part, and a job that joins them once all are done. If a task fails for
good, the joining job is cancelled; the same command then bakes only what is missing.

Example: vmlight-farm.sh 16 --partition=bake --cpus-per-task=8 -- hero.obj -o hero_vismap.exr --samples 1024
EOF
}

# Of a killed bake. Each begins with what was whole.
readonly ATTEMPTS=3

fail() {
    echo "vmlight-farm.sh ERROR: $1 (see vmlight-farm.sh --help)" >&2
    exit 2
}

# Split the flags of makevismap into what the parts need (FLAGS), and the output and how it is stored (FORMAT).
split_flags() {
    FLAGS=() OUTPUT="" FORMAT=()
    while (($# > 0)); do
        case $1 in
        -o | --output) OUTPUT=${2-} && shift $(($# > 1)) ;;
        -o=* | --output=*) OUTPUT=${1#*=} ;;
        --format | --compression) FORMAT+=("$1" "${2-}") && shift $(($# > 1)) ;;
        --format=* | --compression=*) FORMAT+=("$1") ;;
        --part | --part=* | --join | --resume) fail "$1 is set by this script" ;;
        *) FLAGS+=("$1") ;;
        esac
        shift
    done
    [[ $OUTPUT == *.exr ]] || fail "-o OUTPUT.exr is missing"
    JOINED=${OUTPUT%.exr}.joined # there while the parts of a whole map are removed
}

# One task of the array, run by Slurm.
bake() {
    local parts=$1 attempt code
    shift
    split_flags "$@"
    for ((attempt = 1; attempt <= ATTEMPTS; attempt++)); do
        code=0
        makevismap --threads "${SLURM_CPUS_ON_NODE:-0}" "${FLAGS[@]}" -o "$OUTPUT" \
            --part "$SLURM_ARRAY_TASK_ID/$parts" --resume || code=$?
        ((code > 128)) || exit "$code"
        echo "vmlight-farm.sh: part $SLURM_ARRAY_TASK_ID was killed (exit code $code)" >&2
    done
    exit "$code"
}

# The job after the array, run by Slurm.
join() {
    local parts=$1 stem pattern files
    shift
    split_flags "$@"
    stem=${OUTPUT%.exr}
    # shellcheck disable=SC2001
    pattern=$(sed 's/[][*?\\]/\\&/g' <<<"$stem")
    pattern=${pattern//<UDIM>/[0-9][0-9][0-9][0-9]}
    pattern=${pattern//<MATERIAL>/*}
    pattern=${pattern//<INSTANCE>/*}
    local IFS=
    # shellcheck disable=SC2206 # the pattern is to be expanded
    files=($pattern.part*of"$parts".exr)
    # A join that was requeued while it removed parts would miss them.
    [[ -e $JOINED ]] || makevismap --join "${files[@]}" -o "$OUTPUT" "${FORMAT[@]}" || exit
    : >"$JOINED"
    rm -f -- "${files[@]}"
    rm -f -- "$JOINED"
}

case ${1-} in
-h | --help)
    usage
    exit
    ;;
bake | join)
    "$@"
    exit
    ;;
esac
[[ ${1-} =~ ^[1-9][0-9]*$ ]] || fail "the number of parts is missing"
parts=$1 options=()
shift
while (($# > 0)) && [[ $1 != -- ]]; do
    options+=("$1")
    shift
done
[[ ${1-} == -- ]] || fail "-- and the options of makevismap are missing"
shift
split_flags "$@"
rm -f -- "$JOINED"

array=$(sbatch --parsable --job-name=vismap --array="1-$parts" --requeue "${options[@]}" "$0" bake "$parts" "$@")
joining=$(sbatch --parsable --job-name=vismap-join --dependency="afterok:$array" --kill-on-invalid-dep=yes --requeue \
    "${options[@]}" "$0" join "$parts" "$@")
echo "job $array bakes $parts parts, job $joining joins them to $OUTPUT"
