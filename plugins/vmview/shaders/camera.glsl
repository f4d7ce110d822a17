// SPDX-License-Identifier: Apache-2.0
// frame/camera.h: the picture of `size` pixels, sampled at `offset` from pixel centres (x to the right, y down).
uniform vec3 eye, right, up, forward; // the eye relative to the mesh's centre
uniform vec2 half_size; // half width and height at depth 1, or anywhere if orthographic
uniform bool is_orthographic;
uniform vec2 size, offset;
uniform float footprint; // of a texture lookup, in pixels
