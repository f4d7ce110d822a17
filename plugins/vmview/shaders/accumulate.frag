// SPDX-License-Identifier: Apache-2.0
// One sample of every pixel, to be added to the others.
uniform sampler2D picture;
uniform float share;

out vec4 color;

void main()
{
    color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0) * share;
}
