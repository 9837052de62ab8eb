'use strict';
// The day's strip: night, three twilights, golden hour, day, in the place's time.

const STRIP = {'night': '#0e1226', 'astronomical twilight': '#242e60', 'nautical twilight': '#424a88', 'civil twilight': '#7068a8',
  'golden hour': '#eca054', 'day': '#f6dc94'};

class Bar {
  constructor(meta, centre, changed) {
    Object.assign(this, {meta, centre, changed, unix: 0, drawn: null, playing: 0});
    const get = id => document.getElementById(id);
    Object.assign(this, {strip: get('strip'), hour: get('hour'), date: get('date'), text: get('when'), play: get('play')});
    this.hour.addEventListener('input', () => this.set(this.midnight + 60 * this.hour.valueAsNumber));
    this.date.addEventListener('change', () => {
      if (!this.date.value) return;
      const day = Date.parse(this.date.value + 'T00:00Z') / 1000, t = day + 60 * this.hour.valueAsNumber;
      this.set(t - zoneOffset(meta.zone, t - zoneOffset(meta.zone, t)));
    });
    for (const [id, minutes] of [['earlier', -10], ['later', 10]])
      get(id).addEventListener('click', () => this.set(this.unix + 60 * minutes));
    this.play.addEventListener('click', () => this.toggle());
  }
  get midnight() { return midnightOf(this.meta.zone, this.unix); }
  toggle() {
    this.playing = this.playing ? 0 : performance.now();
    this.play.textContent = this.playing ? 'Pause' : 'Play';
    const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
    const step = now => {
      if (!this.playing) return;
      const spent = now - this.playing;
      if (!calm || spent > 1000) {   // 20 minutes in a second; in steps where motion is to be little
        this.set(this.unix + Math.min(calm ? 1000 : 200, spent) * 1.2);
        this.playing = now;
      }
      requestAnimationFrame(step);
    };
    if (this.playing) requestAnimationFrame(t => { this.playing = t; step(t); });
  }
  set(unix) {
    this.unix = Math.max(0, Math.min(4133980799, unix));
    const {zone} = this.meta, m = this.midnight;
    this.hour.value = Math.round((this.unix - m) / 60);
    this.date.value = dayText(zone, this.unix);
    const s = sunAt(this.meta, this.unix, this.centre.lat, this.centre.lon);
    this.text.textContent = `${clock(zone, this.unix)} ${zoneText(zone, this.unix)} · ${phase(s.elevation)}`;
    this.hour.setAttribute('aria-valuetext', this.text.textContent);
    if (this.drawn !== m) this.draw(this.drawn = m);
    this.changed(s);
  }
  draw(midnight) {
    const g = this.strip.getContext('2d'), w = this.strip.width = 720;
    this.strip.height = 1;
    for (let x = 0; x < w; x++) {
      g.fillStyle = STRIP[phase(sunAt(this.meta, midnight + x / w * 86400, this.centre.lat, this.centre.lon).elevation)];
      g.fillRect(x, 0, 1, 1);
    }
  }
}
