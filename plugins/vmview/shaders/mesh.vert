// SPDX-License-Identifier: Apache-2.0
in vec3 position; // relative to the mesh's centre
in vec2 st; // v down, as images are stored
in vec2 material_st; // v up
uniform vec2 depth_range;

out vec3 seen; // to the right, up, and depth, from the eye
out vec2 texture_st;
out vec2 material_uv;

void main()
{
    vec3 from_eye = position - eye;
    seen = vec3(dot(from_eye, right), dot(from_eye, up), dot(from_eye, forward));
    texture_st = st;
    material_uv = material_st;
    float w = is_orthographic ? 1.0 : seen.z;
    vec2 shift = vec2(-2.0, 2.0) * offset / size;
    // Depth is 1 - near / z in perspective, so that floats resolve near and far alike; w times that is linear.
    float nearest = depth_range.x, farthest = depth_range.y;
    float z = is_orthographic ? 2.0 * (seen.z - nearest) / (farthest - nearest) - 1.0
                              : (seen.z * (farthest + nearest) - 2.0 * farthest * nearest) / (farthest - nearest);
    gl_Position = vec4(seen.xy / half_size + shift * w, z, w);
}
