// SPDX-License-Identifier: Apache-2.0
// One triangle over the viewport, without attributes.
void main()
{
    gl_Position = vec4((gl_VertexID & 1) * 4 - 1, (gl_VertexID >> 1) * 4 - 1, 0, 1);
}
