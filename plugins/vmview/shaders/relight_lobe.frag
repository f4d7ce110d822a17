// SPDX-License-Identifier: Apache-2.0
// The model lobe: lightmap/model_lobe.cpp and lobe_lookup.h; of strands model_strand_lobe.cpp.
uniform sampler2DArray lobes; // a layer for each knot
uniform bool is_of_strands;
uniform sampler2D around; // the light around the tangents of strands
uniform vec3 brightest;

const int kKnots = 10, kCfemKnot = 2;
const float kLargestLobe = 0.98482115, kCfemSpread = 0.57735027, kKnotStep = 0.064878256;

float lobe_position(float r)
{
    r = r > 0.0 ? min(r, kLargestLobe) : 0.0;
    precise float wide = max(r * 2.0, r * 6.0 - 2.0);
    if (!(r > 2.0 / 3.0))
        return wide;
    precise float inside = 1.0 - r;
    float spread = sqrt(inside);
    precise float steps = (kCfemSpread - spread) * (1.0 / kKnotStep);
    int knot = min(int(steps), kKnots - 2 - kCfemKnot);
    precise float left = kCfemSpread - float(knot) * kKnotStep;
    precise float share = (left - spread) * (left + spread) / (kKnotStep * (left + left - kKnotStep));
    return float(knot + kCfemKnot) + min(max(share, 0.0), 1.0);
}

vec3 lobe(Lookup at, int knot)
{
    return bilinear(at, texelFetch(lobes, ivec3(at.texel, knot), 0).rgb,
                    texelFetch(lobes, ivec3(at.texel + ivec2(1, 0), knot), 0).rgb,
                    texelFetch(lobes, ivec3(at.texel + ivec2(0, 1), knot), 0).rgb,
                    texelFetch(lobes, ivec3(at.texel + ivec2(1, 1), knot), 0).rgb);
}

// The light around the tangent that is `part` of 1 visible.
vec3 along_strand(float part)
{
    precise float total = max(part * gain, 0.0);
    Lookup at = look(texelFetch(map, ivec3(ivec2(gl_FragCoord.xy), 1), 0).xyz, total);
    return bilinear(at, texelFetch(around, at.texel, 0).rgb, texelFetch(around, at.texel + ivec2(1, 0), 0).rgb,
                    texelFetch(around, at.texel + ivec2(0, 1), 0).rgb,
                    texelFetch(around, at.texel + ivec2(1, 1), 0).rgb);
}

void main()
{
    vec4 seen = texelFetch(map, ivec3(ivec2(gl_FragCoord.xy), 0), 0);
    precise float rest = 0.0;
    if (is_of_strands) {
        precise float part = min(seen.x, 2.0 * look(seen.yzw, 0.0).length);
        rest = seen.x - part;
        seen.x = part;
    }
    precise float total = max(seen.x * gain, 0.0);
    Lookup at = look(seen.yzw, total);
    float position = lobe_position(at.length / max(seen.x, kSmallest));
    int knot = min(int(position), kKnots - 2);
    precise float share = position - float(knot);
    vec3 wide = lobe(at, knot), narrow = lobe(at, knot + 1);
    precise vec3 light = wide + share * (narrow - wide);
    light = min(light, brightest);
    if (is_of_strands) {
        precise vec3 all = light + along_strand(rest);
        light = min(all, brightest);
    }
    put(light);
}
