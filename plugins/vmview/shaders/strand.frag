// SPDX-License-Identifier: Apache-2.0
// What a ribbon shows, looked up along its strand alone: StrandLayout::uv(). SHOW is that of mesh.frag, MODE that of
// strand.vert.
uniform sampler2D lit;
uniform int texels;
uniform vec3 strand_color;
uniform vec2 depth_range;

flat in ivec2 first_texel;
#if MODE == 0
uniform int sample_number;
in float share;
flat in uint piece;
in float coverage;
#else
flat in vec4 corner01;
flat in vec2 corner2;
flat in vec3 depths, shares;
#endif

#if HIGHLIGHTS
uniform sampler2DArray cones; // cfem/cone_levels.h
uniform sampler2DArray map; // layer 0: V
uniform float rotation[9]; // object space to environment space, row major
uniform float strength;
#if MODE == 0
in vec3 tangent;
#else
flat in vec3 first_tangent, middle_tangent, second_tangent;
vec3 tangent;
#endif
#endif

out vec4 color;

#if MODE == 0
// Source: M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020 (pcg3d).
float random(uvec3 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    return float(v.x >> 8u) / 16777216.0;
}

// A ribbon that was widened to a pixel is there in its share of the pixels, and in its share of each pixel's samples.
bool find_share(out float found)
{
    found = share;
    const float kGoldenRatio = 0.61803399;
    float start = random(uvec3(uvec2(gl_FragCoord.xy), piece));
    return fract(start + float(sample_number) * kGoldenRatio) < coverage;
}
#else
bool find_share(out float found)
{
    vec2 here = vec2(gl_FragCoord.x, size.y - gl_FragCoord.y) + offset;
    vec2 a = corner01.xy - here, b = corner01.zw - here, c = corner2 - here;
    precise float e0 = b.x * c.y - b.y * c.x;
    precise float e1 = c.x * a.y - c.y * a.x;
    precise float e2 = a.x * b.y - a.y * b.x;
    precise float sum = e0 + e1 + e2;
    vec3 e = vec3(e0, e1, e2);
    // Where a ribbon is folded over itself, its back is not there: rays pass it, too.
    if (!(sum < 0.0) || !all(lessThanEqual(e, vec3(0))))
        return false;
    vec3 weights = e / sum / (is_orthographic ? vec3(1) : depths);
    float total = weights.x + weights.y + weights.z;
    found = dot(weights, shares) / total;
#if HIGHLIGHTS
    // That of a cubic is a square of the parameter.
    float x = weights.y / total;
    tangent = first_tangent * ((1.0 - x) * (1.0 - 2.0 * x)) + middle_tangent * (4.0 * x * (1.0 - x))
        + second_tangent * (x * (2.0 * x - 1.0));
#endif
    float depth = is_orthographic ? dot(e / sum, depths) : 1.0 / total;
    float nearest = depth_range.x, farthest = depth_range.y;
    float linear = (depth - nearest) / (farthest - nearest);
#if MODE == 2
    gl_FragDepth = linear;
#else
    gl_FragDepth = is_orthographic ? linear : linear * farthest / depth; // as mesh.vert has it
#endif
    return true;
}
#endif

#if HIGHLIGHTS
// What an open strand mirrors: ConeLevels::look().
vec3 mirrored()
{
    const float kPi = 3.14159265;
    vec2 at = (gl_FragCoord.xy + vec2(offset.x, -offset.y)) / size * 2.0 - 1.0;
    vec3 ray = is_orthographic ? forward : forward + right * (at.x * half_size.x) + up * (at.y * half_size.y);
    vec3 t = normalize(tangent);
    float angle = atan(length(cross(t, ray)), abs(dot(t, ray))); // acos() is coarse
    t *= dot(t, ray) < 0.0 ? -1.0 : 1.0;
    float x = rotation[0] * t.x + rotation[1] * t.y + rotation[2] * t.z;
    float y = rotation[3] * t.x + rotation[4] * t.y + rotation[5] * t.z;
    float z = rotation[6] * t.x + rotation[7] * t.y + rotation[8] * t.z;
    vec2 st = vec2(atan(-x, z) / (2.0 * kPi) + 0.5, 0.5 - atan(y, length(vec2(x, z))) / kPi);
    int last = textureSize(cones, 0).z - 1;
    float level = angle / (0.5 * kPi) * float(last);
    float below = min(floor(level), float(last - 1));
    return strength
        * mix(textureLod(cones, vec3(st, below), 0.0).rgb, textureLod(cones, vec3(st, below + 1.0), 0.0).rgb,
              level - below);
}
#endif

void main()
{
    float along;
    if (!find_share(along))
        discard;
    float place = clamp(along * float(texels), 0.5, float(texels) - 0.5) - 0.5;
    int k = int(place);
    vec3 first = texelFetch(lit, first_texel + ivec2(k, 0), 0).rgb;
    vec3 second = texelFetch(lit, first_texel + ivec2(min(k + 1, texels - 1), 0), 0).rgb;
    vec3 rgb = mix(first, second, place - float(k));
#if SHOW == 1
    rgb = vec3((int(along * float(texels)) + first_texel.y) % 2 == 0 ? 0.7 : 0.25);
#elif SHOW == 2
    rgb = vec3(0.5); // texels of strands have no area
#elif SHOW == 0
    rgb *= strand_color;
#if HIGHLIGHTS
    float near_root = texelFetch(map, ivec3(first_texel + ivec2(k, 0), 0), 0).x;
    float near_tip = texelFetch(map, ivec3(first_texel + ivec2(min(k + 1, texels - 1), 0), 0), 0).x;
    rgb += mix(near_root, near_tip, place - float(k)) * mirrored();
#endif
#endif
    color = vec4(rgb, 1);
}
