'use strict';
// Light of every post for one sun, in a worker. Lines half a post apart go away from the sun over the grid. Each falls with
// the sun and rises to the ground at its crossings with rows and columns.

// The sun at the corners of the grid becomes two affine fields: slope of the rays in posts along the minor axis for each
// row along the major one, and fall in metres for each such row.
function sweepFields(job) {
  const {columns, rows, step, suns} = job, mean = {x: 0, y: 0};
  const ways = suns.map(s => {
    const a = (s.azimuth - s.convergence) * Math.PI / 180;  // from the rows' up direction
    const x = Math.sin(a) / (step[0] * s.stretch[0]), y = -Math.cos(a) / (step[1] * s.stretch[1]);
    return {x, y, tangent: Math.tan(s.apparent * Math.PI / 180)};
  });
  for (const w of ways) { mean.x += w.x; mean.y += w.y; }
  const byRows = Math.abs(mean.y) >= Math.abs(mean.x);
  const major = w => byRows ? w.y : w.x, minor = w => byRows ? w.x : w.y;
  const sunwards = Math.sign(major(mean)) || 1;
  const slope = ways.map(w => minor(w) / major(w) * sunwards);        // towards the sun
  const metres = ways.map(w => 1 / Math.abs(major(w)));
  return {byRows, sunwards, slope, metres, tangent: ways.map(w => w.tangent)};
}

// Corners in the order (0,0), (columns-1,0), (0,rows-1), (columns-1,rows-1).
function cornerAt(v, byRows, a, b) {
  const [p, q] = byRows ? [b, a] : [a, b];
  return (v[0] * (1 - p) + v[1] * p) * (1 - q) + (v[2] * (1 - p) + v[3] * p) * q;
}

// Returns per post the light from 0 to 255; 128 and more: the sun's centre is over the ground before the post.
function sweepLight(job) {
  const {columns, rows, height, semidiameter} = job, f = sweepFields(job);
  const na = f.byRows ? rows : columns, nb = f.byRows ? columns : rows;
  const sa = f.byRows ? columns : 1, sb = f.byRows ? 1 : columns, light = new Uint8Array(columns * rows);
  const disc = Math.tan(semidiameter * Math.PI / 180), capacity = 2 * (nb + na) * 2 + 16, base = capacity >> 1;
  const level = new Float64Array(capacity).fill(-1e9), age = new Float64Array(capacity).fill(1);
  const k = 0.13 / 6371000, NONE = -1e9;
  const ground = (i) => { const h = height[i]; return h === h ? h : NONE; };
  let origin = 0, pitch = 0.5;   // line n is at origin + pitch * (n - base)
  for (let n = 0; n < na; n++) {
    const a = f.sunwards > 0 ? na - 1 - n : n, before = a + f.sunwards, at = a / Math.max(1, na - 1);
    const row = a * sa, last = before * sa;
    if (n) {
      const s0 = cornerAt(f.slope, f.byRows, at, 0), s1 = cornerAt(f.slope, f.byRows, at, 1);
      const grow = 1 - (s1 - s0) / Math.max(1, nb - 1), origin0 = origin, pitch0 = pitch;
      origin = origin * grow - s0;
      pitch *= grow;
      const d0 = cornerAt(f.metres, f.byRows, at, 0), d1 = cornerAt(f.metres, f.byRows, at, 1);
      const t0 = cornerAt(f.tangent, f.byRows, at, 0), t1 = cornerAt(f.tangent, f.byRows, at, 1);
      const from = Math.max(0, base + Math.floor(-origin / pitch) - 1);
      const to = Math.min(capacity - 1, base + Math.ceil((nb - 1 - origin) / pitch) + 1);
      for (let l = from; l <= to; l++) {
        const b0 = origin0 + pitch0 * (l - base), b1 = origin + pitch * (l - base), u = b1 / Math.max(1, nb - 1);
        const metres = d0 + (d1 - d0) * u, fall = metres * (t0 + (t1 - t0) * u);
        let h = level[l], g = age[l];
        if (b0 >= 0 && b0 <= nb - 1) {            // the ground at the row before
          const c = Math.min(nb - 2, Math.floor(b0)), i = last + c * sb, p = ground(i), q = ground(i + sb);
          const top = p === NONE || q === NONE ? (b0 - c < 0.5 ? p : q) : p + (q - p) * (b0 - c);
          if (top > h) { h = top; g = 0; }
        }
        const low = Math.min(b0, b1), m = Math.ceil(low + 1e-9);   // a column between the two rows
        if (m < Math.max(b0, b1) - 1e-9 && m >= 0 && m <= nb - 1) {
          const t = (m - b0) / (b1 - b0), p = ground(last + m * sb), q = ground(row + m * sb);
          const there = h - fall * t + k * (g + metres * t / 2) * metres * t;
          const top = p === NONE || q === NONE ? NONE : p + (q - p) * t;
          if (top > there) { h = top - fall * (1 - t); g = metres * (1 - t); }
          else { h = there - fall * (1 - t); g += metres; }
        } else {
          h += k * g * metres - fall;
          g += metres;
        }
        level[l] = h;
        age[l] = g;
      }
    }
    for (let b = 0; b < nb; b++) {
      const i = row + b * sb, h = height[i], x = base + (b - origin) / pitch, l = Math.floor(x), w = x - l;
      if (h !== h) { light[i] = 255; continue; }
      const shadow = level[l] < -1e8 || level[l + 1] < -1e8 ? NONE : level[l] * (1 - w) + level[l + 1] * w;
      const far = Math.max(1, age[l] * (1 - w) + age[l + 1] * w);
      light[i] = shareOf((h - shadow) / (far * disc));
    }
  }
  if (job.far) shadeByFar(job, light);
  return light;
}

// Of the sun's disc, cut by a level edge x radii below its centre.
function shareOf(x) {
  if (x >= 1) return 255;
  if (x <= -1) return 0;
  const share = 0.5 + (x * Math.sqrt(1 - x * x) + Math.asin(x)) / Math.PI;
  return x >= 0 ? 128 + Math.floor(127 * (2 * share - 1)) : Math.min(127, Math.floor(254 * share));
}

// The horizon of the ground outside of the DEM at the nodes of a coarse grid, as seen towards an azimuth from the ground
// there, and how much it sinks for a metre more of the eye's height [degrees].
function farTowards({far, columns, rows, height}, azimuthAt) {
  const count = far.columns * far.rows, eye = new Float32Array(count), angle = new Float32Array(count), sinks = new Float32Array(count);
  for (let i = 0; i < count; i++) {
    const u = i % far.columns / (far.columns - 1), v = Math.floor(i / far.columns) / (far.rows - 1);
    const h = height[Math.round(v * (rows - 1)) * columns + Math.round(u * (columns - 1))];
    const x = azimuthAt(u, v) / 360 * far.azimuths, a = Math.floor(x), first = i * far.azimuths;
    const between = of => of[first + a % far.azimuths] * (1 - x + a) + of[first + (a + 1) % far.azimuths] * (x - a);
    angle[i] = between(far.angle);
    if (h !== h) continue;
    eye[i] = h;
    sinks[i] = between(far.nearness) * 180 / Math.PI * Math.cos(angle[i] * Math.PI / 180) ** 2;
  }
  // At a place, 0 to 1 along rows and columns, and a height.
  return (u, v, h) => {
    const x = u * (far.columns - 1), c = Math.min(far.columns - 2, Math.floor(x));
    const y = v * (far.rows - 1), r = Math.min(far.rows - 2, Math.floor(y));
    const at = i => angle[i] - sinks[i] * (h - eye[i]), i = r * far.columns + c, p = x - c, q = y - r;
    return (at(i) * (1 - p) + at(i + 1) * p) * (1 - q) + (at(i + far.columns) * (1 - p) + at(i + far.columns + 1) * p) * q;
  };
}

function shadeByFar(job, light) {
  const {columns, rows, height, suns, semidiameter} = job, apparent = suns.map(s => s.apparent);
  const first = suns[0].azimuth, turned = suns.map(s => (s.azimuth - first + 540) % 360 - 180);
  const horizon = farTowards(job, (u, v) => (first + cornerAt(turned, true, v, u) + 360) % 360);
  for (let r = 0, i = 0; r < rows; r++)
    for (let c = 0; c < columns; c++, i++) {
      const u = c / Math.max(1, columns - 1), v = r / Math.max(1, rows - 1);
      const over = cornerAt(apparent, true, v, u) - horizon(u, v, height[i]);
      if (over < semidiameter) light[i] = Math.min(light[i], shareOf(over / semidiameter));
    }
}

// In the worker: heights once, then suns. The answer carries the number of its request.
if (typeof WorkerGlobalScope !== 'undefined') {
  let ground = null;
  onmessage = ({data}) => {
    if (data.height) { ground = data; return; }
    const light = sweepLight({...ground, ...data});
    postMessage({id: data.id, light}, [light.buffer]);
  };
}
