// SPDX-License-Identifier: Apache-2.0
// The model sh: lightmap/model_sh.cpp.
uniform vec4 harmonics[64];
uniform int count; // of harmonics
uniform vec3 brightest;

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 seen = texelFetch(map, ivec3(texel, 0), 0);
    // The same two sums as there, four numbers of a texel at a time.
    precise vec3 even = vec3(0), odd = vec3(0);
    vec4 numbers = seen;
    for (int k = 0; k < count; k += 4) {
        if (k > 0)
            numbers = texelFetch(map, ivec3(texel, 1 + k / 4), 0);
        even = even + numbers.x * harmonics[k].rgb;
        if (k + 1 < count)
            odd = odd + numbers.y * harmonics[k + 1].rgb;
        if (k + 2 < count)
            even = even + numbers.z * harmonics[k + 2].rgb;
        if (k + 3 < count)
            odd = odd + numbers.w * harmonics[k + 3].rgb;
    }
    precise vec3 sum = gain * (even + odd);
    put(seen.x > 0.0 ? min(max(sum, 0.0), brightest) : vec3(0));
}
