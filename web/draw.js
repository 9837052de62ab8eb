'use strict';
// Draws the ground and the sky with WebGL2.

// What both programs know: the sky, the light of sun and sky, the air, and the plain around the DEM.
const LIGHT = `
uniform vec3 sun, eye, beam, fill; uniform float sunUp, air, exposure; uniform vec2 extent; uniform sampler2D colour;
float day() { return smoothstep(-14.0, 8.0, sunUp); }
vec3 skyOf(vec3 d) {
  float low = exp(-pow((sunUp - 1.0) / 7.0, 2.0)), up = max(d.y, 0.0), thin = 9.0 * exp(min(eye.y / 8000.0, 1.2));
  vec3 zenith = mix(vec3(.012, .018, .042), vec3(.06, .20, .62), day());
  vec3 rim = mix(vec3(.024, .034, .07), vec3(.46, .59, .88), day());
  float towards = pow(max(0.0, dot(normalize(d.xz + 1e-5), normalize(sun.xz + 1e-5)) * .5 + .5), 2.0);
  rim = mix(rim, vec3(.95, .50, .26) * (.25 + day()), low * (.25 + .6 * towards));
  float glow = max(dot(d, sun), 0.0);
  return mix(rim, zenith, 1.0 - exp(-thin * up)) + vec3(1., .72, .42) * day() * (.10 * pow(glow, 24.0) + .5 * pow(glow, 900.0));
}
vec3 hazeTowards(vec3 d) { return skyOf(normalize(vec3(d.x, .01, d.z))) * vec3(.60, .66, .76); }
vec3 linear(vec3 shown) { return shown * shown * (.78 + .22 * shown); }   // within 0.01 of sRGB
vec3 through(vec3 c, vec3 haze, float far) {
  return mix(c, haze, 1.0 - exp(-pow(far * air, 1.6) * vec3(.85, .95, 1.1)));
}
vec3 backdrop(vec3 d) {
  if (d.y >= 0.0) return skyOf(d);
  float far = eye.y / -d.y;
  vec2 at = (eye.xz + d.xz * far) / extent + .5, near = clamp(at, .05, .95);
  float broad = log2(float(textureSize(colour, 0).x)) - 3.0 + length(at - near);
  vec3 albedo = linear(textureLod(colour, near, broad).rgb);
  vec3 ground = through(albedo * (beam * max(sun.y, 0.0) + fill), hazeTowards(d), far);
  return mix(ground, skyOf(vec3(d.x, 0.0, d.z)), smoothstep(-.05, 0.0, d.y));
}
vec3 shown(vec3 c) {
  c = max(c, 0.0) * exposure;
  c = c * (2.51 * c + .03) / (c * (2.43 * c + .59) + .14);
  vec3 a = sqrt(c), b = sqrt(a), d = sqrt(b);   // of sRGB's power, within 0.003
  return .662002687 * a + .684122060 * b - .323583601 * d - .0225411470 * c;
}`;
const GROUND_VERTEX = `#version 300 es
precision highp float; precision highp sampler2D;
${LIGHT}
uniform sampler2D heights; uniform mat4 clip; uniform vec3 world; uniform ivec2 size; uniform int every; uniform float base;
out vec2 uv; out vec3 at, haze; out float solid;
void main() {
  ivec2 p = min(ivec2((gl_VertexID >> 1), gl_InstanceID + (gl_VertexID & 1)) * every, size - 1);
  float h = texelFetch(heights, p, 0).r;
  solid = h < -1e8 ? 0.0 : 1.0;
  uv = (vec2(p) + .5) / vec2(size);
  at = vec3(float(p.x) - float(size.x - 1) * .5, max(h, base) - base, float(p.y) - float(size.y - 1) * .5) * world;
  haze = hazeTowards(at - eye);
  gl_Position = clip * vec4(at, 1.0);
}`;
const GROUND_FRAGMENT = `#version 300 es
precision highp float;
uniform sampler2D normals, light, open;
in vec2 uv; in vec3 at, haze; in float solid; out vec4 result;
${LIGHT}
void main() {
  if (solid < 0.99) discard;
  vec2 n2 = texture(normals, uv).rg * 2.0 - 1.0;
  vec3 n = vec3(n2.x, sqrt(max(0.0, 1.0 - dot(n2, n2))), n2.y), albedo = linear(texture(colour, uv).rgb);
  float lit = clamp((texture(light, uv).r - .02) * 1.04, 0.0, 1.0);
  vec3 sky = fill * (.45 + .55 * n.y) * texture(open, uv).r, bounced = beam * max(sun.y, 0.0) * .06;
  vec3 c = albedo * (beam * lit * max(dot(n, sun), 0.0) + sky + bounced);
  vec2 e = min(uv, 1.0 - uv);
  c = through(c, haze, length(at - eye));
  float inside = smoothstep(0.0, .02, min(e.x, e.y));
  if (inside < 1.0) c = mix(backdrop(normalize(at - eye)), c, inside);
  result = vec4(shown(c), 1.0);
}`;
const SKY_VERTEX = `#version 300 es
out vec2 p; void main() { p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0; gl_Position = vec4(p, 1.0, 1.0); }`;
const SKY_FRAGMENT = `#version 300 es
precision highp float;
in vec2 p; out vec4 result; uniform mat3 rays;
${LIGHT}
void main() { result = vec4(shown(backdrop(normalize(rays * vec3(p, 1.0)))), 1.0); }`;

const smooth = (low, high, x) => { const t = Math.max(0, Math.min(1, (x - low) / (high - low))); return t * t * (3 - 2 * t); };
// Light of the sun after its way through the air, and of the sky, by the sun's elevation [degrees].
function beamOf(up) {
  const mass = 1 / (Math.max(0, Math.sin(up * RAD)) + 0.15 * (Math.max(up, 0) + 3.885) ** -1.253);
  return [0.07, 0.12, 0.24].map(thick => 3 * Math.exp(-thick * mass) * smooth(-0.8, 0.3, up));
}
function fillOf(up) {
  const day = smooth(-12, 14, up);
  return [[0.024, 0.125], [0.032, 0.17], [0.062, 0.28]].map(([dark, bright]) => dark + (bright - dark) * day);
}

function program(gl, vertex, fragment) {
  const p = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const s = gl.createShader(kind);
    gl.shaderSource(s, text); gl.compileShader(s); gl.attachShader(p, s);
  }
  gl.linkProgram(p);
  if (!gl.getProgramParameter(p, gl.LINK_STATUS) && !gl.isContextLost()) throw Error(gl.getProgramInfoLog(p) || 'shader');
  return p;
}

// Normals of the drawn ground, two bytes a post.
function normalsOf({meta, height}) {
  const [columns, rows] = meta.size, [sx, sy] = meta.step_m, e = meta.exaggeration, out = new Uint8Array(2 * columns * rows);
  for (let r = 0, i = 0; r < rows; r++)
    for (let c = 0; c < columns; c++, i++) {
      const l = c ? 1 : 0, R = c < columns - 1 ? 1 : 0, u = r ? columns : 0, d = r < rows - 1 ? columns : 0;
      const gx = (height[i - l] - height[i + R]) * e / ((l + R) * sx) || 0;
      const gz = (height[i - u] - height[i + d]) * e / (((u + d) / columns) * sy) || 0, k = 1 / Math.sqrt(1 + gx * gx + gz * gz);
      out[2 * i] = 127.5 + 127.5 * gx * k; out[2 * i + 1] = 127.5 + 127.5 * gz * k;
    }
  return out;
}

class Drawer {
  constructor(canvas, ground) {
    const gl = this.gl = canvas.getContext('webgl2', {antialias: false});
    if (!gl) throw Error('no WebGL2');
    this.ground = ground; this.bytes = 0; this.names = new Map();
    this.terrain = program(gl, GROUND_VERTEX, GROUND_FRAGMENT); this.sky = program(gl, SKY_VERTEX, SKY_FRAGMENT);
    gl.enable(gl.DEPTH_TEST); gl.depthFunc(gl.LEQUAL);   // the sky is drawn last, farthest
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1); gl.bindVertexArray(gl.createVertexArray());
    const [w, h] = ground.meta.size, count = w * h, filled = ground.height.map(v => v === v ? v : -1e9);
    this.texture(0, gl.R32F, w, h, gl.RED, gl.FLOAT, filled, gl.NEAREST, 4);
    this.texture(1, gl.RG8, w, h, gl.RG, gl.UNSIGNED_BYTE, normalsOf(ground), gl.LINEAR, 2);
    this.texture(2, gl.R8, w, h, gl.RED, gl.UNSIGNED_BYTE, new Uint8Array(count).fill(255), gl.LINEAR, 1);
    this.texture(3, gl.RGBA8, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([150, 142, 122, 255]), gl.LINEAR, 4);
    this.texture(4, gl.R8, 1, 1, gl.RED, gl.UNSIGNED_BYTE, new Uint8Array([255]), gl.LINEAR, 1);
  }
  texture(unit, format, w, h, channels, type, data, filter, bytes) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit); gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, format, w, h, 0, channels, type, data);
    for (const [k, v] of [[gl.TEXTURE_MIN_FILTER, filter], [gl.TEXTURE_MAG_FILTER, filter],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, k, v);
    this.bytes += w * h * bytes;
  }
  setColour(bitmap) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE3); gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    gl.generateMipmap(gl.TEXTURE_2D); gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    this.bytes += bitmap.width * bitmap.height * 4 * 4 / 3;
  }
  setSkyView(bytes, {columns, rows}) {
    const gl = this.gl;
    this.texture(4, gl.R8, columns, rows, gl.RED, gl.UNSIGNED_BYTE, bytes, gl.LINEAR, 1);
  }
  setLight(light) {
    const gl = this.gl, [w, h] = this.ground.meta.size;
    gl.activeTexture(gl.TEXTURE2); gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, w, h, gl.RED, gl.UNSIGNED_BYTE, light);
  }
  // Waits until all is drawn.
  finish() { this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4)); }
  // Draws every `every`-th post.
  draw(camera, sun, every) {
    const gl = this.gl, {meta, base} = this.ground, [w, h] = meta.size, [sx, sy] = meta.step_m;
    const a = (sun.azimuth - gridValue(meta, 'convergence', w / 2, h / 2)) * RAD, e = sun.apparent * RAD;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight); gl.clear(gl.DEPTH_BUFFER_BIT);
    for (const p of [this.terrain, this.sky]) {
      const at = name => gl.getUniformLocation(p, name);
      gl.useProgram(p);
      gl.uniform3f(at('sun'), Math.sin(a) * Math.cos(e), Math.sin(e), -Math.cos(a) * Math.cos(e));
      gl.uniform1f(at('sunUp'), sun.apparent); gl.uniform3fv(at('eye'), camera.eye);
      gl.uniform1f(at('exposure'), meta.exposure);
      gl.uniform3fv(at('beam'), beamOf(sun.apparent)); gl.uniform3fv(at('fill'), fillOf(sun.apparent));
      gl.uniform2f(at('extent'), w * sx, h * sy); gl.uniform1f(at('air'), 0.75 / Math.hypot(w * sx, h * sy));
      ['heights', 'normals', 'light', 'colour', 'open'].forEach((n, i) => gl.uniform1i(at(n), i));
      if (p === this.sky) {
        gl.uniformMatrix3fv(at('rays'), false, camera.rays); gl.drawArrays(gl.TRIANGLES, 0, 3);
        continue;
      }
      gl.uniformMatrix4fv(at('clip'), false, camera.clip); gl.uniform3f(at('world'), sx, meta.exaggeration, sy);
      gl.uniform2i(at('size'), w, h); gl.uniform1i(at('every'), every); gl.uniform1f(at('base'), base);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 2 * (Math.ceil((w - 1) / every) + 1), Math.ceil((h - 1) / every));
    }
  }
}
