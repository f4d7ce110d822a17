// SPDX-License-Identifier: Apache-2.0
// The models paper and ao: lightmap/model_paper.cpp.
uniform sampler2D cfem;
uniform bool uses_normal; // ao; of strands it is the tangent

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 seen = texelFetch(map, ivec3(texel, 0), 0);
    vec3 direction = uses_normal ? texelFetch(map, ivec3(texel, 1), 0).xyz : seen.yzw;
    precise float total = max(seen.x * gain, 0.0);
    Lookup at = look(direction, total);
    precise float least = seen.x * 1e-6;
    ivec2 place = at.largest < least ? ivec2(0, light_size.y + 2) : at.texel; // no direction: the mean of the sphere
    put(bilinear(at, texelFetch(cfem, place, 0).rgb, texelFetch(cfem, place + ivec2(1, 0), 0).rgb,
                 texelFetch(cfem, place + ivec2(0, 1), 0).rgb, texelFetch(cfem, place + ivec2(1, 1), 0).rgb));
}
