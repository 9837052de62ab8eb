'use strict';
// Puts the page together: reads the data, sweeps in the worker, draws when something has changed.

const $ = id => document.getElementById(id);
const show = text => { $('message').textContent = text; $('message').hidden = !text; };
// The picture of the first view instead of ground that turns.
function still(text) { for (const id of ['ground', 'bar', 'point', 'tools']) $(id).hidden = true; $('still').hidden = false; show(text); }

function worker(ground) {
  const w = new Worker(URL.createObjectURL(new Blob([$('sweep').textContent], {type: 'text/javascript'})));
  const {meta, height, far} = ground;
  w.postMessage({columns: meta.size[0], rows: meta.size[1], step: meta.step_m, height, far, semidiameter: 0.2666});
  return w;
}

// The sun at the four corners, for the sweep.
function cornerSuns(meta, unix) {
  const [w, h] = meta.size, date = sunOfDate(unix);
  return [[0, 0], [w - 1, 0], [0, h - 1], [w - 1, h - 1]].map(([c, r]) => {
    const s = sunOver(date, gridValue(meta, 'lat', c, r), gridValue(meta, 'lon', c, r)), grid = n => gridValue(meta, n, c, r);
    return {azimuth: s.azimuth, apparent: s.elevation + lift(meta.refraction, s.elevation), convergence: grid('convergence'),
      stretch: meta.grid.scale_x ? [grid('scale_x'), grid('scale_y')] : [1, 1]};
  });
}

function readHash() {
  const pairs = location.hash.slice(1).split('&').map(p => p.split('='));
  return Object.fromEntries(pairs.filter(p => p.length === 2 && Number.isFinite(+p[1])).map(p => [p[0], +p[1]]));
}

async function start() {
  const began = performance.now(), {src} = $('data').dataset;
  const bytes = src ? new Uint8Array(await (await fetch(src)).arrayBuffer()) : bytesOfBase64($('data').textContent);
  const container = readContainer(bytes), {meta} = container;
  const ground = {meta, height: await readHeights(container), far: await readFar(container)};
  ground.base = ground.height.reduce((a, h) => h < a ? h : a, Infinity);
  const [w, h] = meta.size, at = (c, r) => ({lat: gridValue(meta, 'lat', c, r), lon: gridValue(meta, 'lon', c, r)});
  const centre = at((w - 1) / 2, (h - 1) / 2);
  $('name').textContent = meta.title; $('credits').textContent = meta.credits.join(' · ');
  $('still').src = URL.createObjectURL(new Blob([container.block('still')], {type: 'image/jpeg'}));
  const canvas = $('ground'), drawer = new Drawer(canvas, ground), sweeper = worker(ground);
  if (container.find('colour')) drawer.setColour(await createImageBitmap(new Blob([container.block('colour')], {type: 'image/jpeg'})));
  const {columns, rows} = meta.sky_view;
  drawer.setSkyView(await inflated(container, 'sky_view', columns * rows), meta.sky_view);
  let sun = null, wanted = null, busy = false, dirty = true, movedAt = 0, point = null, lost = false;
  const sweep = () => {
    if (busy || wanted === null) return;
    const suns = cornerSuns(meta, wanted);
    if (Math.max(...suns.map(s => s.apparent)) < -0.3) { drawer.setLight(new Uint8Array(w * h)); wanted = null; dirty = true; return; }
    sweeper.postMessage({suns, id: wanted}); busy = true; wanted = null;
  };
  sweeper.onmessage = ({data}) => { busy = false; drawer.setLight(data.light); page.light = data.light; dirty = true; sweep(); };
  let remember = 0;
  const changed = () => {
    movedAt = performance.now(); dirty = true; clearTimeout(remember);
    remember = setTimeout(() => {
      const values = {t: Math.round(bar.unix), x: view.x, z: view.z, az: view.azimuth, tilt: view.tilt, d: view.distance};
      history.replaceState(null, '', '#' + Object.entries(values).map(([k, v]) => k + '=' + +v.toFixed(2)).join('&'));
    }, 250);
  };
  const bar = new Bar(meta, centre, s => { sun = s; wanted = bar.unix; sweep(); changed(); if (point) tell(); });
  const view = new View(ground, () => {});
  view.changed = changed;
  const tell = () => {
    const text = spells(point, bar.midnight).map(([a, b]) => `${clock(meta.zone, a)}–${clock(meta.zone, b)}`).join(', ');
    $('spells').textContent = text ? `Direct sun ${text}` : 'No direct sun on this day';
    drawHorizon($('horizon'), point, bar.midnight, bar.unix);
  };
  const choose = hit => {
    if (!hit) { point = null; $('point').hidden = true; return; }
    point = pointAt(ground, hit.column, hit.row);
    $('where').textContent = placeText(point, hit.height); $('point').hidden = false;
    tell(); drawCarpet($('carpet'), point, bar.unix);
  };
  const degrees = (value, [plus, minus]) => `${Math.abs(value).toFixed(5)}° ${value < 0 ? minus : plus}`;
  const placeText = (p, height) => `${degrees(p.lat, 'NS')}  ${degrees(p.lon, 'EW')}  ${Math.round(height)} m`;
  listen(canvas, view, p => choose(view.pick(...p)), p => {
    const hit = view.pick(...p);
    $('cursor').textContent = hit ? placeText(at(hit.column, hit.row), hit.height) : '';
  });
  $('home').onclick = () => view.home(); $('north').onclick = () => view.set({azimuth: 180}); $('close').onclick = () => choose(null);
  $('print').onclick = () => print(canvas, meta, bar, frame);
  const keys = {
    ArrowLeft: () => view.set({azimuth: view.azimuth + 5}), ArrowRight: () => view.set({azimuth: view.azimuth - 5}),
    ArrowUp: () => view.set({tilt: view.tilt + 3}), ArrowDown: () => view.set({tilt: view.tilt - 3}),
    '+': () => view.set({distance: view.distance * 0.9}), '-': () => view.set({distance: view.distance * 1.1}),
    h: () => view.home(), n: () => view.set({azimuth: 180}),
    ' ': () => bar.toggle(), ',': () => bar.set(bar.unix - 600), '.': () => bar.set(bar.unix + 600),
  };
  addEventListener('keydown', e => { if (keys[e.key] && !/INPUT|BUTTON/.test(e.target.tagName)) { keys[e.key](); e.preventDefault(); } });
  canvas.addEventListener('webglcontextlost', e => {
    e.preventDefault(); lost = true;
    still('The graphics were reset by the system. Reload the page to go on.');
  });
  const frame = (every, ratio) => {
    const cw = Math.round(canvas.clientWidth * ratio), ch = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== cw || canvas.height !== ch) { canvas.width = cw; canvas.height = ch; }
    drawer.draw(view.camera(cw / ch), sun, every);
    $('needle').style.transform = `rotate(${180 - view.azimuth}deg)`;
  };
  // While something moves: few posts, and as many pixels as the device draws 20 times a second, which the first frame
  // finds out. At rest: two pixels for one of the layout and all posts; of a slow device, so many that it takes no second.
  const side = Math.max(w, h), every = most => Math.max(1, Math.ceil(side / most));
  let coarse = false, ratio = 0, last = 0;
  const draw = (moving, now) => {
    if (moving && coarse) ratio = Math.max(0.5, Math.min(2, ratio * (now - last > 60 ? 0.8 : now - last < 30 ? 1.1 : 1)));
    if (moving) frame(every(200), ratio); else if (ratio < 1) frame(every(550), 1); else frame(every(1800), 2);
    dirty = false; coarse = moving;
  };
  const loop = now => {
    const moving = performance.now() - movedAt < 150;
    if (!lost && sun && !ratio) {
      const began = performance.now();
      frame(every(200), 0.5); drawer.finish();
      ratio = performance.now() - began > 25 ? 0.5 : 2;
    } else if (!lost && sun && (dirty || (coarse && !moving))) draw(moving, now);
    last = now;
    requestAnimationFrame(loop);
  };
  Object.assign(page, {ground, drawer, view, bar, frame, choose, at, start_ms: 0, light: null});
  addEventListener('resize', () => { dirty = true; });
  const {t, x, z, az, tilt, d} = readHash();
  if (d) view.set({x: x || 0, z: z || 0, azimuth: az || 0, tilt: tilt || 20, distance: d});
  bar.set(t || Date.parse(meta.time) / 1000);
  requestAnimationFrame(loop);
  page.start_ms = performance.now() - began;
  document.body.dataset.ready = '1';
}

// The picture with its place and date below.
function print(canvas, meta, bar, frame) {
  frame(1, 2);
  const out = document.createElement('canvas'), strip = Math.round(canvas.height / 18), g = out.getContext('2d');
  out.width = canvas.width; out.height = canvas.height + strip;
  g.fillStyle = '#12151c'; g.fillRect(0, 0, out.width, out.height);
  g.drawImage(canvas, 0, 0);
  g.fillStyle = '#e6e8ee'; g.font = `${Math.round(strip * 0.42)}px system-ui, sans-serif`; g.textBaseline = 'middle';
  const {zone} = meta, time = `${dayText(zone, bar.unix)} ${clock(zone, bar.unix)} ${zoneText(zone, bar.unix)}`;
  const text = [meta.title, time, ...meta.credits].join(' · ');
  g.fillText(text, strip / 2, canvas.height + strip / 2, out.width - strip);
  out.toBlob(blob => { const a = document.createElement('a'); a.href = URL.createObjectURL(blob); a.download = 'picture.png'; a.click(); });
}

const page = {};
start().catch(e => {
  document.body.dataset.failed = '1';
  if (e.message === 'no WebGL2') still('This browser has no WebGL2: a picture of the first view instead of ground that turns.');
  else show(e.message);
});
