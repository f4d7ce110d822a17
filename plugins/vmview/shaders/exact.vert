// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen, each larger by kBeyond of a pixel on all sides; exact_point.glsl decides what is inside.
uniform samplerBuffer corners;
flat out int triangle;

const float kBeyond = 0.03125, kLongest = 2.0; // the latter for sharp corners

vec2 corner(int k)
{
    vec4 place = texelFetch(corners, 9 * triangle + 3 * k);
    return place.xy + place.zw;
}

void main()
{
    triangle = gl_VertexID / 3;
    int k = gl_VertexID % 3;
    vec2 here = corner(k), before = corner((k + 2) % 3), after = corner((k + 1) % 3);
    vec2 along = here - before, onward = after - here;
    float turn = along.x * onward.y - along.y * onward.x < 0.0 ? -1.0 : 1.0;
    vec2 n1 = vec2(along.y, -along.x) * (turn / max(length(along), 1e-20));
    vec2 n2 = vec2(onward.y, -onward.x) * (turn / max(length(onward), 1e-20));
    vec2 out_of = (n1 + n2) * (kBeyond / max(1.0 + dot(n1, n2), 1e-6));
    float reach = length(out_of);
    here += out_of * min(1.0, kLongest / max(reach, 1e-20)) - offset;
    gl_Position = vec4(here.x / size.x * 2.0 - 1.0, 1.0 - here.y / size.y * 2.0, 0, 1);
}
