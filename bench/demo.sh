#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Lights a bundled mesh with a bundled studio, using the executables, and makes pictures of the results.
#   bench/demo.sh BUILD_FOLDER OUTPUT_FOLDER
set -euo pipefail
[[ $# == 2 ]] || { echo "usage: $0 BUILD_FOLDER OUTPUT_FOLDER" >&2; exit 2; }
data=$(cd "$(dirname "${BASH_SOURCE[0]}")/../tests/data" && pwd)
config=$(cd "$(dirname "${BASH_SOURCE[0]}")/../configs/ocio" && pwd)/config.ocio
bin=$(cd "$1/bin" && pwd)
mkdir -p "$2"
out=$(cd "$2" && pwd)
unset OCIO # use vmlight's own config

mesh=spot environment=studio_small_03 resolution=512
angles=(0 90 180 270)
stops=-2.2      # exposure of the diffuse light: the brightest side of the cow is just below white
studio_stops=1.5 # exposure of the studio, whose lamps are a thousand times as bright as its walls

command -v oiiotool >/dev/null || { echo "demo: oiiotool is missing: install openimageio-tools" >&2; exit 1; }

# Runs a stage and prints its time.
stage() {
    local name=$1 start=$EPOCHREALTIME
    shift
    "$@"
    awk -v name="$name" -v from="$start" -v to="$EPOCHREALTIME" 'BEGIN { printf "  %-46s %6.2f s\n", name, to - from }'
}

echo "Stages"
stage "visibility map, $resolution x $resolution" \
    "$bin/makevismap" "$data/$mesh.obj" -o "$out/${mesh}_vismap.exr" --resolution $resolution --quiet
stage "cosine-filtered environment, a stack" \
    "$bin/makecfem" "$data/$environment.hdr" --stack --colorconfig "$config" -o "$out/studio_cfem.exr" --quiet
for angle in "${angles[@]}"; do
    stage "lightmap, turned $angle degrees" \
        "$bin/makelightmap" "$out/${mesh}_vismap.exr" "$out/studio_cfem.exr" --colorconfig "$config" \
        --rotate "0,$angle,0" -o "$out/${mesh}_lit_$angle.exr" --quiet
done

# Light is shown through the ACES view of an sRGB display, all lit textures at one exposure. Visibility maps are data and are not
# converted: visibility as grey, directions mapped from [-1,1] to colours.
gain=$(awk -v stops=$stops 'BEGIN { print 2 ^ stops }')
studio_gain=$(awk -v stops=$studio_stops 'BEGIN { print 2 ^ stops }')
tool=(oiiotool --colorconfig "$config" --nosoftwareattrib)
show=(--ociodisplay:from=ACEScg "sRGB - Display" "ACES 1.0 - SDR Video" --ch R,G,B -d uint8)
tagged=(--attrib oiio:ColorSpace sRGB -d uint8)
square=(--create ${resolution}x${resolution} 3) # canvas to centre lat-long maps in
middle=+0+$((resolution / 4))

make_pictures() {
    "${tool[@]}" "$out/${mesh}_vismap.exr" --ch visibility,visibility,visibility --chnames R,G,B "${tagged[@]}" \
        -o "$out/${mesh}_visibility.png"
    "${tool[@]}" "$out/${mesh}_vismap.exr" --ch direction.x,direction.y,direction.z --chnames R,G,B --mulc 0.5 --addc 0.5 \
        "${tagged[@]}" -o "$out/${mesh}_direction.png"
    "${tool[@]}" "$data/$environment.hdr" --tocolorspace ACEScg --mulc "$studio_gain" "${show[@]}" -o "$out/studio.png"
    "${tool[@]}" "$out/studio_cfem.exr" --subimage 0 --ch R,G,B --mulc "$gain" "${show[@]}" -o "$out/studio_cfem.png"
    for angle in "${angles[@]}"; do
        "${tool[@]}" "$out/${mesh}_lit_$angle.exr" --ch R,G,B --mulc "$gain" "${show[@]}" -o "$out/${mesh}_lit_$angle.png"
    done
    local lit=("${angles[@]/#/$out/${mesh}_lit_}") name
    for name in studio studio_cfem; do
        "${tool[@]}" "$out/$name.png" --resize ${resolution}x$((resolution / 2)) "${square[@]}" --paste $middle \
            -d uint8 -o "$out/$name.tile.png"
    done
    "${tool[@]}" "$out/${mesh}_visibility.png" "$out/${mesh}_direction.png" "$out/studio.tile.png" \
        "$out/studio_cfem.tile.png" "${lit[@]/%/.png}" --mosaic:pad=8 4x2 "${tagged[@]}" -o "$out/contact_sheet.png"
    rm "$out/studio.tile.png" "$out/studio_cfem.tile.png"
}
stage "pictures" make_pictures

# The lit object itself: a turntable, and the models beside the traced truth.
frames() {
    "$bin/vmframes" "$data/$mesh.obj" "$data/$environment.hdr" --colorconfig "$config" --view "ACES 1.0 - SDR Video" --quiet \
        --resolution $resolution --exposure $stops "$@"
}
stage "12 frames of a turntable" frames -o "$out/turntable.####.png" --frames 1-12 --turntable --azimuth 215 --ground white --size 384 \
    --contact-sheet "$out/turntable.png" --keep "$out/kept"
stage "ao, paper, lobe, cells and the traced truth" frames -o "$out/comparison.png" \
    --side-by-side ao,paper,lobe,cells,reference --size 384 --azimuth 215 --reference-samples 256

cat <<END
Pictures in $out
  turntable.png           the lit object from all sides, on a white ground; turntable.*.png are the frames
  comparison.png          from left to right: ambient occlusion, the paper's model, lobe, cells, the traced truth
  contact_sheet.png       all of them. Top: visibility, directions, studio, filtered studio.
                          Bottom: the texture of the mesh, lit at ${angles[*]} degrees
  ${mesh}_lit_*.exr          the lit textures, scene-linear ACEScg
END
