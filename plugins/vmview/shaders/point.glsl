// SPDX-License-Identifier: Apache-2.0
// A point of the surface: coordinates of its lit texture and of its material's, and how they change over a footprint.
uniform vec2 depth_range; // nearest and farthest depth of the mesh

struct Point
{
    vec2 st, st_across, st_down;
    vec2 uv, uv_across, uv_down;
    float density; // the square root of texture area over surface area
};
