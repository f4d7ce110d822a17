// SPDX-License-Identifier: Apache-2.0
// Lights the map in a pass over its texels, then draws the mesh with it: what vmview does, by the same shaders.

const kModels = ["ao", "paper", "lobe"];
const kShaderHead = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2DArray;\n"
  + "precision highp sampler2D;\n#define precise\n";
const kWhole = "const vec2 corners[3] = vec2[3](vec2(-1.0), vec2(3.0, -1.0), vec2(-1.0, 3.0));\n"
  + "void main() { gl_Position = vec4(corners[gl_VertexID], 0.0, 1.0); }\n";

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

class Viewer {
  constructor(canvas, scene) {
    this.scene = scene;
    const gl = this.gl = canvas.getContext("webgl2", { antialias: true });
    if (!gl) throw new Error("This browser has no WebGL 2.");
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("This browser cannot render to floats (EXT_color_buffer_float).");
    this.programs = {
      cfem: this.program(kWhole, scene.shaders.lookup + scene.shaders.cfem),
      lobe: this.program(kWhole, scene.shaders.lookup + scene.shaders.lobe),
      mesh: this.program(scene.shaders.vertex, scene.shaders.fragment, ["position", "uv"]),
    };
    this.map = this.loadMap(scene.map);
    this.lights = scene.environments.map(environment => this.loadLight(environment));
    this.mesh = this.loadMesh(scene.mesh);
    this.none = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.none);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.targets = [this.target(gl.RGBA16F), this.target(gl.RGBA16F)];
  }

  program(vertex, fragment, attributes = []) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, kShaderHead + text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    attributes.forEach((name, index) => gl.bindAttribLocation(program, index, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  // RGBA of floats in layers, for texelFetch().
  layers(width, height, images) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA32F, width, height, images.length);
    images.forEach((image, layer) => gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, layer, width, height, 1, gl.RGBA, gl.FLOAT, image));
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  loadMap(map) {
    const whole = new Uint16Array(bytesOf(map.texels)), facing = new Uint16Array(bytesOf(map.normals));
    const seen = Float32Array.from(whole, (v, i) => i % 4 ? v / 32767.5 - 1 : v / 65535);
    // 32767.5 is between two steps: what is exactly 0 is stored as 0.
    for (let i = 0; i < seen.length; ++i) if (i % 4 && whole[i] === 32768) seen[i] = 0;
    const normal = Float32Array.from(facing, (v, i) => i % 4 < 3 ? v / 32767.5 - 1 : 1);
    return this.layers(map.width, map.height, [seen, normal]);
  }

  loadLight(environment) {
    const gl = this.gl, { width, height } = environment, pitch = width + 2;
    const rgba = (rgb, texels) => {
      const image = new Float32Array(4 * texels);
      for (let i = 0; i < texels; ++i) image.set(rgb.subarray(3 * i, 3 * i + 3), 4 * i);
      return image;
    };
    const cfem = gl.createTexture(), texels = pitch * (height + 2);
    gl.bindTexture(gl.TEXTURE_2D, cfem);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, pitch, height + 4, 0, gl.RGBA, gl.FLOAT,
      rgba(new Float32Array(bytesOf(environment.cfem)), pitch * (height + 4)));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    const lobes = new Float32Array(bytesOf(environment.lobes)), images = [];
    for (let knot = 0; knot < environment.knots; ++knot) images.push(rgba(lobes.subarray(3 * texels * knot), texels));
    return { cfem, lobes: this.layers(pitch, height + 2, images), width, height, brightest: environment.brightest };
  }

  loadMesh(mesh) {
    const gl = this.gl, vertices = gl.createVertexArray();
    gl.bindVertexArray(vertices);
    [[mesh.positions, 3], [mesh.uvs, 2]].forEach(([base64, size], index) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, bytesOf(base64), gl.STATIC_DRAW);
      gl.enableVertexAttribArray(index);
      gl.vertexAttribPointer(index, size, gl.FLOAT, false, 0, 0);
    });
    const corners = bytesOf(mesh.corners);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return { vertices, count: corners.byteLength / 4 };
  }

  target(format) {
    const gl = this.gl, { width, height } = this.scene.map, texture = gl.createTexture(), buffer = gl.createFramebuffer();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, name, format === gl.RGBA16F ? gl.LINEAR : gl.NEAREST);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) throw new Error("This browser cannot render to floats.");
    return { texture, buffer };
  }

  // Light all texels: `degrees` is what makelightmap's --env-rotate 0,degrees,0 turns by.
  relight(target, environment, model, degrees) {
    const gl = this.gl, light = this.lights[environment], program = this.programs[model === "lobe" ? "lobe" : "cfem"];
    const at = name => gl.getUniformLocation(program, name);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.buffer);
    gl.viewport(0, 0, this.scene.map.width, this.scene.map.height);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(program);
    const bind = (unit, kind, texture, name) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(kind, texture);
      gl.uniform1i(at(name), unit);
    };
    bind(0, gl.TEXTURE_2D_ARRAY, this.map, "map");
    bind(2, gl.TEXTURE_2D, this.none, "added");
    const angle = -degrees * Math.PI / 180, c = Math.cos(angle), s = Math.sin(angle);
    gl.uniform1fv(at("rotation"), [c, 0, s, 0, 1, 0, -s, 0, c]);
    gl.uniform1f(at("gain"), 1);
    gl.uniform2i(at("light_size"), light.width, light.height);
    if (model === "lobe") {
      bind(1, gl.TEXTURE_2D_ARRAY, light.lobes, "lobes");
      gl.uniform3fv(at("brightest"), light.brightest);
      bind(2, gl.TEXTURE_2D, this.none, "around"); // of strands, which pages do not show
    } else {
      bind(1, gl.TEXTURE_2D, light.cfem, "cfem");
      gl.uniform1i(at("uses_normal"), model === "ao" ? 1 : 0);
    }
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // R, G, B, A of each texel in linear light, row by row: for checks.
  texels(environment, model, degrees) {
    const gl = this.gl, { width, height } = this.scene.map, values = new Float32Array(4 * width * height);
    this.exact = this.exact || this.target(gl.RGBA32F);
    this.relight(this.exact, environment, model, degrees);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
    return values;
  }

  // Draw the mesh: to the left of `wipe` with one model, to the right with the other.
  draw(state, toClip) {
    const gl = this.gl, { canvas } = gl, width = Math.round(canvas.clientWidth * devicePixelRatio),
      height = Math.round(canvas.clientHeight * devicePixelRatio);
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const border = Math.round(width * state.wipe);
    const halves = [[state.model, 0, border], [state.other, border, width - border]];
    halves.forEach(([model, , across], i) => { if (across > 0) this.relight(this.targets[i], state.environment, model, state.turn); });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.125, 0.133, 0.145, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.SCISSOR_TEST);
    const program = this.programs.mesh;
    gl.useProgram(program);
    gl.bindVertexArray(this.mesh.vertices);
    gl.uniformMatrix4fv(gl.getUniformLocation(program, "to_clip"), false, toClip);
    gl.uniform1f(gl.getUniformLocation(program, "exposure_gain"), 2 ** state.exposure);
    gl.uniform1i(gl.getUniformLocation(program, "light"), 0);
    gl.activeTexture(gl.TEXTURE0);
    halves.forEach(([, left, across], i) => {
      if (across <= 0) return;
      gl.bindTexture(gl.TEXTURE_2D, this.targets[i].texture);
      gl.scissor(left, 0, across, height);
      gl.drawElements(gl.TRIANGLES, this.mesh.count, gl.UNSIGNED_INT, 0);
    });
    gl.disable(gl.SCISSOR_TEST);
    gl.bindVertexArray(null);
  }
}
