// SPDX-License-Identifier: Apache-2.0
// Ribbons that face the eye, as rays meet the flat curves of trace/curves.h: each span of a strand's B-spline is straight
// pieces, each of them two triangles. MODE: 0 is quick, 1 and 2 leave to strand.frag what is inside.
uniform samplerBuffer controls; // strand_buffers.h
uniform usamplerBuffer spans;
uniform int pieces; // of a span
uniform int texels, rows; // of a strand in its map, and of the map
uniform vec2 depth_range;

flat out ivec2 first_texel; // of the strand
#if HIGHLIGHTS && MODE == 0
out vec3 tangent; // in object space
#elif HIGHLIGHTS
flat out vec3 first_tangent, middle_tangent, second_tangent; // from the triangle's first corner to its second
#endif
#if MODE == 0
out float share; // of the strand's length
flat out uint piece;
out float coverage; // of a pixel's width
#else
flat out vec4 corner01; // in pixels from the upper left corner
flat out vec2 corner2;
flat out vec3 depths, shares; // at the corners
const float kBeyond = 0.03125, kLongest = 2.0; // as in exact.vert
#endif

struct End
{
    vec3 seen; // to the right, up, and depth
    vec3 side; // to the ribbon's right edge
    float share, coverage;
    vec3 tangent; // in object space
};

vec3 turned(vec3 v)
{
    return vec3(dot(v, right), dot(v, up), dot(v, forward));
}

vec2 on_screen(vec3 seen)
{
    float depth = is_orthographic ? 1.0 : seen.z;
    return (seen.xy / (depth * half_size) * vec2(1, -1) + 1.0) * 0.5 * size;
}

End end_of(vec4 a, vec4 b, vec4 c, vec4 d, vec2 knots, float u)
{
    float t = 1.0 - u;
    vec4 weights = vec4(t * t * t, (3.0 * u - 6.0) * u * u + 4.0, (3.0 * t - 6.0) * t * t + 4.0, u * u * u) / 6.0;
    vec4 slopes = vec4(-t * t, (3.0 * u - 4.0) * u, (4.0 - 3.0 * t) * t, u * u) / 2.0;
    vec4 place = a * weights.x + b * weights.y + c * weights.z + d * weights.w;
    End end;
    end.seen = turned(place.xyz - eye);
    end.tangent = a.xyz * slopes.x + b.xyz * slopes.y + c.xyz * slopes.z + d.xyz * slopes.w;
    vec3 along = turned(end.tangent);
    vec3 across = cross(along, is_orthographic ? vec3(0, 0, 1) : end.seen);
    float radius = place.w;
    end.coverage = 1.0;
#if MODE == 0
    float half_pixel = half_size.y / size.y * (is_orthographic ? 1.0 : end.seen.z);
    end.coverage = min(radius / half_pixel, 1.0);
    radius = max(radius, half_pixel);
#endif
    end.side = across * (radius / max(length(across), 1e-30));
    end.share = mix(knots.x, knots.y, u);
    return end;
}

#if MODE == 0
vec4 placed(vec3 seen)
{
    // As in mesh.vert.
    float w = is_orthographic ? 1.0 : seen.z;
    vec2 shift = vec2(-2.0, 2.0) * offset / size;
    float nearest = depth_range.x, farthest = depth_range.y;
    float z = is_orthographic ? 2.0 * (seen.z - nearest) / (farthest - nearest) - 1.0
                              : (seen.z * (farthest + nearest) - 2.0 * farthest * nearest) / (farthest - nearest);
    return vec4(seen.xy / half_size + shift * w, z, w);
}
#endif

void main()
{
    int number = gl_VertexID / 6, k = gl_VertexID % 6;
    uvec4 span = texelFetch(spans, number / pieces);
    int first = int(span.x), step = number % pieces;
    vec4 a = texelFetch(controls, first), b = texelFetch(controls, first + 1), c = texelFetch(controls, first + 2),
         d = texelFetch(controls, first + 3);
    vec2 knots = uintBitsToFloat(span.yz);
    int strand = int(span.w);
    first_texel = ivec2(texels * (strand / rows), strand % rows);
    // Of the first triangle the right edge, then the left of the first end; the second has the other three corners.
    bool is_second = k > 2;
    int corner = is_second ? k - 3 : k;
#if MODE == 0
    int at_tip = (corner == 1) != is_second ? 1 : 0;
    End end = end_of(a, b, c, d, knots, float(step + at_tip) / float(pieces));
    share = end.share;
    coverage = end.coverage;
    piece = uint(number);
#if HIGHLIGHTS
    tangent = end.tangent;
#endif
    gl_Position = placed((corner == 2) == is_second ? end.seen + end.side : end.seen - end.side);
#else
    End near_root = end_of(a, b, c, d, knots, float(step) / float(pieces));
    End near_tip = end_of(a, b, c, d, knots, float(step + 1) / float(pieces));
    End first_end = near_root, second_end = near_tip;
    float side = 1.0;
    if (is_second) {
        first_end = near_tip;
        second_end = near_root;
        side = -1.0;
    }
    vec2 p0 = on_screen(first_end.seen + side * first_end.side);
    vec2 p1 = on_screen(second_end.seen + side * second_end.side);
    vec2 p2 = on_screen(first_end.seen - side * first_end.side);
    corner01 = vec4(p0, p1);
    corner2 = p2;
    depths = vec3(first_end.seen.z, second_end.seen.z, first_end.seen.z);
    shares = vec3(first_end.share, second_end.share, first_end.share);
#if HIGHLIGHTS
    first_tangent = first_end.tangent;
    middle_tangent = end_of(a, b, c, d, knots, (float(step) + 0.5) / float(pieces)).tangent;
    second_tangent = second_end.tangent;
#endif
    // As in exact.vert: larger by kBeyond of a pixel on all sides.
    vec2 here = corner == 0 ? p0 : corner == 1 ? p1 : p2;
    vec2 along = here - (corner == 0 ? p2 : corner == 1 ? p0 : p1);
    vec2 onward = (corner == 0 ? p1 : corner == 1 ? p2 : p0) - here;
    float turn = along.x * onward.y - along.y * onward.x < 0.0 ? -1.0 : 1.0;
    vec2 n1 = vec2(along.y, -along.x) * (turn / max(length(along), 1e-20));
    vec2 n2 = vec2(onward.y, -onward.x) * (turn / max(length(onward), 1e-20));
    vec2 out_of = (n1 + n2) * (kBeyond / max(1.0 + dot(n1, n2), 1e-6));
    here += out_of * min(1.0, kLongest / max(length(out_of), 1e-20)) - offset;
    gl_Position = vec4(here.x / size.x * 2.0 - 1.0, 1.0 - here.y / size.y * 2.0, 0, 1);
    // What is partly behind the eye is left out: pieces are short.
    if (min(near_root.seen.z, near_tip.seen.z) < depth_range.x)
        gl_Position = vec4(2, 2, 2, 1);
#endif
}
