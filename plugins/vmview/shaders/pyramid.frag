// SPDX-License-Identifier: Apache-2.0
// One level of frame/texture_pyramid.h from the one before: the mean by area of the two or three texels along each axis
// that a texel covers. Texels are colour times weight, and the weight.
uniform sampler2D finer; // with that level as its first
uniform ivec2 fine_size, coarse_size;

out vec4 coarse;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    // In units of 1 / coarse_size texels, so that borders are whole numbers.
    ivec2 begin = at * fine_size, end = begin + fine_size;
    ivec2 first = begin / coarse_size, last = (end - 1) / coarse_size;
    vec4 sum = vec4(0);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            ivec2 low = ivec2(x, y) * coarse_size;
            vec2 share = vec2(min(end, low + coarse_size) - max(begin, low)) / vec2(fine_size);
            sum += texelFetch(finer, ivec2(x, y), 0) * (share.y * share.x);
        }
    coarse = sum;
}
