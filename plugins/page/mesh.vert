// SPDX-License-Identifier: Apache-2.0
in vec3 position;
in vec2 uv;
uniform mat4 to_clip;
out vec2 place;

void main()
{
    place = vec2(uv.x, 1.0 - uv.y); // row 0 of the textures is the top
    gl_Position = to_clip * vec4(position, 1.0);
}
