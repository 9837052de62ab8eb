'use strict';
// Where the sun stands, local time, and the spells of a day.

const RAD = Math.PI / 180;

// Heliocentric longitude of the Earth [1e-8 rad; rad; rad per millennium]: the largest terms of VSOP87 (Bretagnon and
// Francou, 1988), as Reda and Andreas (2004) list them.
const LONGITUDE = [
  [[175347046, 0, 0], [3341656, 4.6692568, 6283.07585], [34894, 4.6261, 12566.1517], [3497, 2.7441, 5753.3849],
    [3418, 2.8289, 3.5231], [3136, 3.6277, 77713.7715], [2676, 4.4181, 7860.4194], [2343, 6.1352, 3930.2097],
    [1324, 0.7425, 11506.7698], [1273, 2.0371, 529.691], [1199, 1.1096, 1577.3435], [990, 5.233, 5884.927],
    [902, 2.045, 26.298], [857, 3.508, 398.149], [780, 1.179, 5223.694], [753, 2.533, 5507.553]],
  [[628331966747, 0, 0], [206059, 2.678235, 6283.07585], [4303, 2.6351, 12566.1517], [425, 1.59, 3.523]],
  [[52919, 0, 0], [8720, 1.0721, 6283.0758], [309, 0.867, 12566.152]]];

// TT - UTC [s]: the International Earth Rotation Service's from 1972, to a second.
function ttMinusUtc(unix) {
  const year = 1970 + unix / 31556952;
  return year < 1999 ? 41 + (year - 1970) * 0.8 : Math.min(64 + (year - 1999) * 0.29, 69.2);
}

// The sun in the axes of the date: right ascension less sidereal time at Greenwich, declination [rad].
function sunOfDate(unix) {
  const days = unix / 86400 - 10957.5, t = (days + ttMinusUtc(unix) / 86400) / 365250;
  let longitude = 0;
  LONGITUDE.forEach((terms, power) => {
    let sum = 0;
    for (const [a, b, c] of terms) sum += a * Math.cos(b + c * t);
    longitude += sum * t ** power * 1e-8;
  });
  const T = 10 * t, node = (125.04452 - 1934.136261 * T) * RAD, mean = (280.4665 + 36000.7698 * T) * RAD;
  const nutation = (-17.2 * Math.sin(node) - 1.32 * Math.sin(2 * mean)) / 3600 * RAD;
  const obliquity = (23.4392911 - 0.0130042 * T + (9.2 * Math.cos(node) + 0.57 * Math.cos(2 * mean)) / 3600) * RAD;
  const seen = longitude + Math.PI + nutation - 20.49 / 3600 * RAD;
  const sidereal = (280.46061837 + 360.98564736629 * days + 0.000387933 * T * T) * RAD + nutation * Math.cos(obliquity);
  return {angle: Math.atan2(Math.sin(seen) * Math.cos(obliquity), Math.cos(seen)) - sidereal,
    declination: Math.asin(Math.sin(seen) * Math.sin(obliquity))};
}

// Azimuth from true north and elevation without air [degrees] at a place [degrees].
function sunOver({angle, declination}, lat, lon) {
  const h = lon * RAD - angle, phi = lat * RAD, cd = Math.cos(declination), sd = Math.sin(declination);
  const up = Math.sin(phi) * sd + Math.cos(phi) * cd * Math.cos(h);
  const north = Math.cos(phi) * sd - Math.sin(phi) * cd * Math.cos(h), east = -cd * Math.sin(h);
  return {azimuth: (Math.atan2(east, north) / RAD + 360) % 360,
    elevation: Math.asin(Math.max(-1, Math.min(1, up))) / RAD - 0.00244 * Math.sqrt(Math.max(0, 1 - up * up))};
}

// By how much air lifts a true elevation [degrees]: linear between the table's entries, held beyond its ends.
function lift(table, elevation) {
  const e = table.elevation, v = table.lift;
  let lo = 0, hi = e.length - 1;
  if (elevation <= e[0]) return v[0];
  if (elevation >= e[hi]) return v[hi];
  while (hi - lo > 1) {
    const mid = (lo + hi) >> 1;
    if (e[mid] <= elevation) lo = mid; else hi = mid;
  }
  return v[lo] + (v[hi] - v[lo]) * (elevation - e[lo]) / (e[hi] - e[lo]);
}

function sunAt(meta, unix, lat, lon) {
  const s = sunOver(sunOfDate(unix), lat, lon);
  return {...s, apparent: s.elevation + lift(meta.refraction, s.elevation)};
}

// Seconds that the place's clocks are ahead of UTC.
function zoneOffset(zone, unix) {
  const t = zone.transitions;
  let lo = 0, hi = t.length;
  while (hi - lo > 1) {
    const mid = (lo + hi) >> 1;
    if (t[mid][0] <= unix) lo = mid; else hi = mid;
  }
  return t[lo][1];
}

function midnightOf(zone, unix) {
  const offset = zoneOffset(zone, unix), day = Math.floor((unix + offset) / 86400) * 86400;
  return day - zoneOffset(zone, day - offset);
}

const localDate = (zone, unix) => new Date((unix + zoneOffset(zone, unix)) * 1000);
const clock = (zone, unix) => localDate(zone, unix).toISOString().slice(11, 16);
const dayText = (zone, unix) => localDate(zone, unix).toISOString().slice(0, 10);
function zoneText(zone, unix) {
  const m = Math.round(zoneOffset(zone, unix) / 60), a = Math.abs(m);
  return 'UTC' + (m ? (m < 0 ? '−' : '+') + Math.floor(a / 60) + (a % 60 ? ':' + String(a % 60).padStart(2, '0') : '') : '');
}

// Bilinear value of a table of the coarse grid at a post; longitudes may cross 180 degrees.
function gridValue(meta, name, column, row) {
  const g = meta.grid, v = g[name], [columns, rows] = meta.size;
  const x = column / Math.max(1, columns - 1) * (g.columns - 1), y = row / Math.max(1, rows - 1) * (g.rows - 1);
  const c = Math.max(0, Math.min(g.columns - 2, Math.floor(x))), r = Math.max(0, Math.min(g.rows - 2, Math.floor(y)));
  const i = r * g.columns + c, base = v[i];
  const near = w => name === 'lat' || name === 'scale' ? w : base + ((w - base + 540) % 360 + 360) % 360 - 180;
  return (base * (1 - x + c) + near(v[i + 1]) * (x - c)) * (1 - y + r) +
    (near(v[i + g.columns]) * (1 - x + c) + near(v[i + g.columns + 1]) * (x - c)) * (y - r);
}

function phase(elevation) {
  return elevation > 6 ? 'day' : elevation > -0.83 ? 'golden hour' : elevation > -4 ? 'golden hour' :
    elevation > -6 ? 'civil twilight' : elevation > -12 ? 'nautical twilight' :
    elevation > -18 ? 'astronomical twilight' : 'night';
}
