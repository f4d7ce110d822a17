// SPDX-License-Identifier: Apache-2.0
// The point of the surface at a sample, to float's precision. A rasterizer rounds corners to 1/256 of a pixel, and so
// gives some samples near an edge to the wrong side of it. Here it draws triangles a little too large, and this decides.
uniform samplerBuffer corners; // exact_mesh.h
flat in int triangle;

bool find_point(out Point point)
{
    vec4 place[3], first[3], second[3];
    vec2 to[3]; // from the sample to the corners, in pixels
    vec2 pixel = floor(vec2(gl_FragCoord.x, size.y - gl_FragCoord.y));
    for (int k = 0; k < 3; ++k) {
        int at = 9 * triangle + 3 * k;
        place[k] = texelFetch(corners, at);
        first[k] = texelFetch(corners, at + 1);
        second[k] = texelFetch(corners, at + 2);
        precise vec2 from = (place[k].xy - pixel) + (place[k].zw - (vec2(0.5) + offset));
        to[k] = from;
    }
    // The same numbers but for the sign for both triangles of an edge: no sample falls between them.
    precise float e0 = to[1].x * to[2].y - to[1].y * to[2].x;
    precise float e1 = to[2].x * to[0].y - to[2].y * to[0].x;
    precise float e2 = to[0].x * to[1].y - to[0].y * to[1].x;
    precise float sum = e0 + e1 + e2;
    vec3 e = vec3(e0, e1, e2);
    if (sum == 0.0 || !(all(greaterThanEqual(e, vec3(0))) || all(lessThanEqual(e, vec3(0)))))
        return false;
    // Weights over depth, and how they change from pixel to pixel.
    vec3 inverse = vec3(first[0].x, first[1].x, first[2].x) / sum;
    vec3 w = e * inverse;
    vec3 w_x = vec3(to[1].y - to[2].y, to[2].y - to[0].y, to[0].y - to[1].y) * inverse * footprint;
    vec3 w_y = vec3(to[2].x - to[1].x, to[0].x - to[2].x, to[1].x - to[0].x) * inverse * footprint;
    float total = w.x + w.y + w.z, total_x = w_x.x + w_x.y + w_x.z, total_y = w_y.x + w_y.y + w_y.z;
    mat3x2 st = mat3x2(first[0].yz, first[1].yz, first[2].yz), uv = mat3x2(second[0].xy, second[1].xy, second[2].xy);
    point.st = st * w / total;
    point.uv = uv * w / total;
    point.st_across = (st * w_x - point.st * total_x) / total;
    point.st_down = (st * w_y - point.st * total_y) / total;
    point.uv_across = (uv * w_x - point.uv * total_x) / total;
    point.uv_down = (uv * w_y - point.uv * total_y) / total;
    point.density = second[0].z;
    vec3 share = e / sum;
    float depth = is_orthographic ? dot(share, vec3(first[0].w, first[1].w, first[2].w)) : 1.0 / total;
    gl_FragDepth = (depth - depth_range.x) / (depth_range.y - depth_range.x);
    return true;
}
