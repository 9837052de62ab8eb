'use strict';
// Light at one point: its horizon in the DEM, the spells of sun of a day and of a year.

// Height at a place between posts [m]; NaN outside and in voids.
function heightAt({meta, height}, x, y) {
  const [columns, rows] = meta.size;
  if (!(x >= 0 && y >= 0 && x <= columns - 1 && y <= rows - 1)) return NaN;
  const c = Math.min(columns - 2, Math.floor(x)), r = Math.min(rows - 2, Math.floor(y)), i = r * columns + c, u = x - c, v = y - r;
  return (height[i] * (1 - u) + height[i + 1] * u) * (1 - v) + (height[i + columns] * (1 - u) + height[i + columns + 1] * u) * v;
}

// Elevation of the terrain horizon [degrees] towards an azimuth from true north; -90: nothing in sight.
function horizonTowards(ground, x, y, azimuth) {
  const {meta} = ground, [sx, sy] = meta.step_m, eye = heightAt(ground, x, y), curvature = 0.87 / (2 * 6371000);
  const a = (azimuth - gridValue(meta, 'convergence', x, y)) * RAD, dx = Math.sin(a) / sx, dy = -Math.cos(a) / sy;
  const ahead = (v, d) => (d > 0 ? Math.floor(v + 1e-6) + 1 - v : v - Math.ceil(v - 1e-6) + 1) / Math.abs(d);
  let column = ahead(x, dx), row = ahead(y, dy);   // metres to the next crossing with each
  let best = -Infinity;
  for (;;) {
    const s = Math.min(column, row);
    if (column <= row) column += 1 / Math.abs(dx); else row += 1 / Math.abs(dy);
    const px = x + dx * s, py = y + dy * s;
    if (px < 0 || py < 0 || px > meta.size[0] - 1 || py > meta.size[1] - 1) break;
    const t = (heightAt(ground, px, py) - eye) / s - curvature * s;
    if (t > best) best = t;
  }
  const angle = best === -Infinity ? -90 : Math.atan(best) / RAD;
  if (!ground.far) return angle;
  const far = farTowards({...ground, columns: meta.size[0], rows: meta.size[1]}, () => azimuth);
  return Math.max(angle, far(x / (meta.size[0] - 1), y / (meta.size[1] - 1), eye));
}

// A point with its horizon towards every half degree.
function pointAt(ground, x, y) {
  const {meta} = ground, towards = azimuth => horizonTowards(ground, x, y, azimuth);
  const horizon = Float32Array.from({length: 720}, (_, n) => towards(n / 2));
  return {meta, lat: gridValue(meta, 'lat', x, y), lon: gridValue(meta, 'lon', x, y), towards, horizon};
}

function clearance(point, unix) {
  const s = sunAt(point.meta, unix, point.lat, point.lon), n = Math.floor(s.azimuth * 2), w = s.azimuth * 2 - n;
  return s.apparent - Math.max(-0.6, point.horizon[n % 720] * (1 - w) + point.horizon[(n + 1) % 720] * w);
}

// The same with the horizon of just this azimuth.
function clearanceExact(point, unix) {
  const s = sunAt(point.meta, unix, point.lat, point.lon);
  return s.apparent - Math.max(-0.6, point.towards(s.azimuth));
}

// Spells of direct sun [from, to] within a local day, to a second.
function spells(point, midnight) {
  const found = [], step = 120;
  let begin = clearance(point, midnight) > 0 ? midnight : null;
  for (let t = midnight; t < midnight + 86400; t += step) {
    if ((clearance(point, t) > 0) === (clearance(point, t + step) > 0)) continue;
    let lo = t - step, hi = t + 2 * step;
    const was = clearance(point, t) > 0;
    while (hi - lo > 1) { const mid = (lo + hi) / 2; if ((clearanceExact(point, mid) > 0) === was) lo = mid; else hi = mid; }
    if (was) { found.push([begin, hi]); begin = null; } else begin = hi;
  }
  if (begin !== null) found.push([begin, midnight + 86400]);
  return found;
}

// A year as a carpet: days from left to right, hours upwards.
function drawCarpet(canvas, point, unix) {
  const g = canvas.getContext('2d'), image = g.createImageData(canvas.width = 365, canvas.height = 96);
  const first = Date.UTC(localDate(point.meta.zone, unix).getUTCFullYear(), 0, 1) / 1000 - zoneOffset(point.meta.zone, unix);
  for (let d = 0; d < 365; d++)
    for (let q = 0; q < 96; q++) {
      const t = first + d * 86400 + q * 900 + 450, s = sunAt(point.meta, t, point.lat, point.lon);
      const dark = s.apparent > 0 ? [70, 66, 74] : s.apparent > -6 ? [44, 42, 66] : [18, 20, 30];
      const colour = clearance(point, t) > 0 ? [242, 184, 75] : dark;
      image.data.set([...colour, 255], ((95 - q) * 365 + d) * 4);
    }
  g.putImageData(image, 0, 0);
}

// Horizon and the sun's path, from north over east, south and west to north.
function drawHorizon(canvas, point, midnight, unix) {
  const g = canvas.getContext('2d'), w = canvas.width = 720, h = canvas.height = 220, y = e => h - 20 - (e + 2) / 92 * (h - 26);
  g.fillStyle = '#1b2230'; g.fillRect(0, 0, w, h);
  g.beginPath(); g.moveTo(0, h);
  point.horizon.forEach((e, n) => g.lineTo(n, y(Math.max(-2, e))));
  g.lineTo(w, h); g.fillStyle = '#464a45'; g.fill();
  for (let t = midnight; t < midnight + 86400; t += 240) {
    const s = sunAt(point.meta, t, point.lat, point.lon);
    if (s.apparent < -1) continue;
    g.fillStyle = clearance(point, t) > 0 ? '#f2b84b' : '#7d765f';
    g.fillRect(s.azimuth * 2 - 1, y(s.apparent) - 1, 3, 3);
  }
  const now = sunAt(point.meta, unix, point.lat, point.lon);
  g.beginPath(); g.arc(now.azimuth * 2, y(now.apparent), 7, 0, 7); g.fillStyle = '#f2b84b'; g.fill();
  g.fillStyle = '#d8dae0'; g.font = '20px system-ui, sans-serif'; g.textAlign = 'center';
  ['E', 'S', 'W'].forEach((name, n) => g.fillText(name, 180 * (n + 1), h - 4));
}
