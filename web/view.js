'use strict';
// The camera on its orbit, and what moves it.

class View {
  constructor(ground, changed) {
    const {meta} = ground, [w, h] = meta.size;
    Object.assign(this, {ground, changed, span: Math.hypot(w * meta.step_m[0], h * meta.step_m[1])});
    this.home();
  }
  // The view of the program's picture: its eye, and the ground in the middle.
  home() {
    const {meta, base} = this.ground, v = meta.view, [w, h] = meta.size, [sx, sy] = meta.step_m;
    const a = (v.heading - gridValue(meta, 'convergence', w / 2, h / 2)) * RAD, p = v.pitch * RAD;
    const eye = [(v.post[0] - (w - 1) / 2) * sx, v.height - base * meta.exaggeration, (v.post[1] - (h - 1) / 2) * sy];
    const ahead = [Math.sin(a) * Math.cos(p), Math.sin(p), -Math.cos(a) * Math.cos(p)];
    const distance = this.hit(eye, ahead) || this.span * 0.6;
    Object.assign(this, {x: eye[0] + ahead[0] * distance, z: eye[2] + ahead[2] * distance, distance});
    Object.assign(this, {azimuth: (v.heading + 180) % 360, tilt: Math.max(4, -v.pitch)});
    this.changed();
  }
  set(values) {
    Object.assign(this, values);
    this.azimuth = (this.azimuth % 360 + 360) % 360;
    this.tilt = Math.max(4, Math.min(89.5, this.tilt));
    this.distance = Math.max(this.span / 60, Math.min(this.span * 2, this.distance));
    this.x = Math.max(-this.span / 2, Math.min(this.span / 2, this.x));
    this.z = Math.max(-this.span / 2, Math.min(this.span / 2, this.z));
    this.changed();
  }
  // The camera stands at `azimuth` from its target, `tilt` degrees high.
  camera(aspect) {
    const {ground} = this, {meta, base} = ground, north = gridValue(meta, 'convergence', meta.size[0] / 2, meta.size[1] / 2);
    const a = (this.azimuth - north) * RAD, t = this.tilt * RAD, [c, r] = this.post(this.x, this.z);
    const target = [this.x, ((heightAt(ground, c, r) || base) - base) * meta.exaggeration, this.z];
    const back = [Math.sin(a) * Math.cos(t), Math.sin(t), -Math.cos(a) * Math.cos(t)];
    const eye = target.map((v, i) => v + back[i] * this.distance);
    const right = [-Math.cos(a), 0, -Math.sin(a)], up = [-Math.sin(a) * Math.sin(t), Math.cos(t), Math.cos(a) * Math.sin(t)];
    const ty = Math.tan(meta.view.fov / 2 * RAD) * Math.min(1.5, Math.max(1, 1.2 / aspect)), tx = ty * aspect;
    const near = this.distance / 100, far = this.span * 4;
    const dot = (p, q) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2], k = (far + near) / (near - far), clip = new Float32Array(16);
    [right, up, back].forEach((axis, row) => axis.forEach((v, col) => {
      if (row < 2) clip[col * 4 + row] = v / (row ? ty : tx); else { clip[col * 4 + 2] = v * k; clip[col * 4 + 3] = -v; }
    }));
    clip[12] = -dot(right, eye) / tx; clip[13] = -dot(up, eye) / ty;
    clip[14] = -dot(back, eye) * k + 2 * far * near / (near - far); clip[15] = dot(back, eye);
    const rays = new Float32Array([...right.map(v => v * tx), ...up.map(v => v * ty), ...back.map(v => -v)]);
    return {eye, clip, rays};
  }
  post(x, z) { const {size: [w, h], step_m: [sx, sy]} = this.ground.meta; return [x / sx + (w - 1) / 2, z / sy + (h - 1) / 2]; }
  // How far along a ray the ground is [lengths of the ray's direction], or null.
  hit(eye, ahead) {
    const {ground} = this, below = s => {
      const [c, r] = this.post(eye[0] + ahead[0] * s, eye[2] + ahead[2] * s);
      return eye[1] + ahead[1] * s < (heightAt(ground, c, r) - ground.base) * ground.meta.exaggeration;
    };
    for (let s = this.span / 2000, last = 0; s < this.span * 3; last = s, s *= 1.004) {
      if (!below(s)) continue;
      for (let n = 0; n < 12; n++) { const middle = (last + s) / 2; if (below(middle)) s = middle; else last = middle; }
      return s;
    }
    return null;
  }
  // The post under a place of the picture (-1 to 1, up), or null.
  pick(px, py, aspect) {
    const {eye, rays} = this.camera(aspect), ahead = [0, 1, 2].map(i => rays[i] * px + rays[3 + i] * py + rays[6 + i]);
    const s = this.hit(eye, ahead);
    if (s === null) return null;
    const [column, row] = this.post(eye[0] + ahead[0] * s, eye[2] + ahead[2] * s);
    return {column, row, height: heightAt(this.ground, column, row)};
  }
  pan(dx, dy, height) {
    const a = (this.azimuth - 180) * RAD, k = this.distance / height, f = dy * k, s = -dx * k;
    this.set({x: this.x + Math.cos(a) * s + Math.sin(a) * f, z: this.z + Math.sin(a) * s - Math.cos(a) * f});
  }
}

function listen(canvas, view, click, hover) {
  const fingers = new Map();
  let moved = 0;
  const place = e => {
    const b = canvas.getBoundingClientRect();
    return [(e.clientX - b.left) / b.width * 2 - 1, 1 - (e.clientY - b.top) / b.height * 2, b.width / b.height];
  };
  canvas.addEventListener('pointerdown', e => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, e); moved = 0; });
  canvas.addEventListener('pointermove', e => {
    const old = fingers.get(e.pointerId);
    if (!old) { hover(place(e)); return; }
    const dx = e.clientX - old.clientX, dy = e.clientY - old.clientY;
    moved += Math.abs(dx) + Math.abs(dy);
    if (fingers.size === 2) {
      const other = [...fingers.values()].find(f => f.pointerId !== e.pointerId);
      const gap = f => Math.hypot(f.clientX - other.clientX, f.clientY - other.clientY);
      const turn = f => Math.atan2(f.clientY - other.clientY, f.clientX - other.clientX);
      const azimuth = view.azimuth - (turn(e) - turn(old)) / RAD;
      view.set({distance: view.distance * gap(old) / Math.max(1, gap(e)), azimuth, tilt: view.tilt + dy * 0.15});
    } else if (e.shiftKey || e.buttons & 6) view.pan(dx, dy, canvas.clientHeight);
    else view.set({azimuth: view.azimuth + dx * 0.25, tilt: view.tilt + dy * 0.2});
    fingers.set(e.pointerId, e);
  });
  const up = e => { if (fingers.delete(e.pointerId) && e.type === 'pointerup' && moved < 6 && !fingers.size) click(place(e)); };
  canvas.addEventListener('pointerup', up); canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    view.set({distance: view.distance * Math.exp(e.deltaY * 0.001)});
  }, {passive: false});
}
