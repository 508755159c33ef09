// ident: the page's style sheet and its one script.
#pragma once

namespace pushid {

inline constexpr char kPageStyle[] = R"css(
:root{--paper:#fff;--ink:#222;--faint:#666;--line:#ddd;--link:#0b57d0;--box:#f5f6f8;color-scheme:light dark}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--faint:#a0a0a0;--line:#3a3f46;--link:#8ab4f8;--box:#1e2328}}
*{box-sizing:border-box}
body{margin:0 auto;padding:0 1.2rem 4rem;max-width:1060px;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
h1{margin:1.4rem 0 .2rem;font-size:1.7rem}
h2{margin:2.6rem 0 .6rem;font-size:1.25rem;border-bottom:1px solid var(--line);padding-bottom:.2rem}
section{scroll-margin-top:5.5rem}
header p{color:var(--faint);margin:.2rem 0 1rem}
nav{position:sticky;top:0;background:var(--paper);border-bottom:1px solid var(--line);z-index:1}
nav ul{display:flex;flex-wrap:wrap;gap:.1rem 1rem;margin:0;padding:.5rem 0;list-style:none;font-size:.8rem;white-space:nowrap}
a{color:var(--link)}
p{max-width:78ch}
pre{background:var(--box);padding:.5rem .7rem;overflow-x:auto;font-size:.85rem;border-radius:4px}
.panels{display:flex;flex-wrap:wrap;align-items:flex-start}
.scroll{overflow-x:auto}  /* pictures keep their size, so that labels stay readable */
table{border-collapse:collapse;margin:1rem 0;font-size:.85rem;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .8rem .2rem 0;text-align:left;border-bottom:1px solid var(--line);white-space:nowrap}
td:last-child{white-space:normal;min-width:6rem}
th{font-weight:600}
.number{text-align:right}
.alarm{border-left:5px solid #c62828;background:var(--box);padding:.5rem .8rem}
figure{margin:1rem 0;break-inside:avoid}
figcaption{color:var(--faint);font-size:.85rem;max-width:78ch}
.panels svg{display:block;flex:none}
@media(max-width:1000px){nav{position:static}section{scroll-margin-top:1rem}}
details{border-bottom:1px solid var(--line);padding:.3rem 0}
summary{cursor:pointer}
.controls{display:flex;flex-wrap:wrap;gap:.6rem 1.2rem;align-items:center;margin:.6rem 0}
.controls label{display:flex;gap:.4rem;align-items:center}
#fig-time{width:min(22rem,60vw)}
#fig-clock{min-width:4.5em;font-variant-numeric:tabular-nums}
#fig-stage{background:var(--box);border-radius:4px;width:100%;height:420px}
#fig-stage line{stroke-linecap:round}
.g{stroke:var(--line)}.m{stroke:var(--ink);stroke-width:4}.p{stroke:#3b82f6;stroke-width:4;stroke-opacity:.9}
.b{stroke:var(--faint);stroke-width:1.6}
circle.m{fill:var(--ink);stroke:none}circle.p{fill:#3b82f6;stroke:none}
.a{stroke:#d55e00;stroke-width:4}.ring-push{fill:none;stroke:#d55e00;stroke-width:3}
.inset{fill:var(--paper);fill-opacity:.85;stroke:var(--line)}
.key span::before{content:"";display:inline-block;width:1.4em;height:4px;margin:0 .4em .2em 1em;background:var(--ink)}
.key .predicted::before{background:#3b82f6}.key .body::before{background:var(--faint);height:2px}.key .pushed::before{background:#d55e00}
:focus-visible{outline:2px solid var(--link);outline-offset:2px}
@media print{:root{--paper:#fff;--ink:#000;--faint:#444;--line:#bbb;--box:#fff}
nav,.controls{display:none}body{max-width:none}h2{break-after:avoid}svg{max-width:100%;height:auto}
pre{white-space:pre-wrap;overflow-wrap:anywhere}.scroll{overflow:visible}summary{break-after:avoid}
table{font-size:.62rem}th,td{white-space:normal;padding-right:.35rem}td:last-child{min-width:0}
svg .paper{fill:#fff}svg .ink,svg .axis{fill:#222}svg .faint{fill:#666}svg line.axis,svg path.axis,svg path.ink{stroke:#222;fill:none}svg line.grid,svg path.grid{stroke:#ddd}}
)css";

// Draws the moving figure of figure_section.cc.
inline constexpr char kPageScript[] = R"js(
(function () {
  'use strict';
  const holder = document.getElementById('fig-data');
  if (!holder) return;
  const data = JSON.parse(holder.textContent);
  const find = id => document.getElementById('fig-' + id);
  const list = find('recording'), time = find('time'), turn = find('turn');
  const play = find('play'), clock = find('clock'), stage = find('stage');
  const height = 420;
  let width = 900;

  // Differences to positions: [sample][point][axis].
  function decode(flat, points) {
    const last = new Array(3 * points).fill(0), samples = [];
    for (let i = 0; i < flat.length; i += 3 * points) {
      const sample = [];
      for (let k = 0; k < points; ++k) {
        const at = [];
        for (let a = 0; a < 3; ++a) at.push((last[3 * k + a] += flat[i + 3 * k + a]) / 1000);
        sample.push(at);
      }
      samples.push(sample);
    }
    return samples;
  }
  // As wide as there is room, so that words keep their size on a telephone.
  function fit() {
    width = Math.max(320, stage.clientWidth || width);
    stage.setAttribute('viewBox', `0 0 ${width} ${height}`);
    for (const recording of data) recording.ready = false;
  }
  function open(recording) {
    if (recording.ready) return recording;
    let low = [Infinity, Infinity], high = [-Infinity, -Infinity], top = 1.2;
    for (const person of recording.people) {
      const joints = person.bones.length ? 1 + Math.max(...person.bones.flat()) : 0;
      person.measured = decode(person.m, 2);
      person.predicted = decode(person.p, 2);
      person.skeleton = joints ? decode(person.j, joints) : [];
      for (const samples of [person.measured, person.predicted, person.skeleton]) {
        for (const sample of samples) for (const [x, y, z] of sample) {
          low = [Math.min(low[0], x), Math.min(low[1], y)];
          high = [Math.max(high[0], x), Math.max(high[1], y)];
          top = Math.max(top, z);
        }
      }
    }
    recording.middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const across = Math.hypot(high[0] - low[0], high[1] - low[1]);
    recording.scale = Math.min((width - 60) / (across + 0.3), (height - 110) / top);
    recording.top = top;
    recording.span = [high[0] - low[0] + 0.2, high[1] - low[1] + 0.2];
    recording.pushed = new Set(recording.pushes.map(push => push[0]));
    const first = recording.people[recording.pushes.length ? recording.pushes[0][0] : 0];
    recording.origin = first.measured[0][0];
    recording.ready = true;
    return recording;
  }
  function project(recording, point) {
    const angle = turn.value * Math.PI / 180, tilt = 0.12;
    const x = point[0] - recording.middle[0], y = point[1] - recording.middle[1];
    const across = x * Math.cos(angle) + y * Math.sin(angle);
    const depth = y * Math.cos(angle) - x * Math.sin(angle);
    return [width / 2 + recording.scale * across,
            height - 40 - recording.scale * (point[2] + tilt * depth)];
  }
  // Between samples, where they lie far apart.
  function at(samples, k) {
    const here = samples[Math.floor(k)], next = samples[Math.floor(k) + 1], share = k % 1;
    if (!here || !next || !share) return here;
    return here.map((p, n) => p.map((v, axis) => v + share * (next[n][axis] - v)));
  }
  function line(a, b, look) {
    return `<line class="${look}" x1="${a[0].toFixed(1)}" y1="${a[1].toFixed(1)}" ` +
           `x2="${b[0].toFixed(1)}" y2="${b[1].toFixed(1)}"/>`;
  }
  const fixed = number => number.toFixed(1);
  function disc(at, r, look) {
    return `<circle class="${look}" cx="${fixed(at[0])}" cy="${fixed(at[1])}" r="${fixed(r)}"/>`;
  }
  function words(at, text, look) {
    const safe = text.replace(/&/g, '&amp;').replace(/</g, '&lt;');
    return `<text class="${look}" x="${fixed(at[0])}" y="${fixed(at[1])}">${safe}</text>`;
  }
  function pendulum(recording, sample, look) {
    const cart = project(recording, sample[0]), hip = project(recording, sample[1]);
    return line(cart, hip, look) + disc(cart, 5, look) + disc(hip, 9, look);
  }
  // Metres from where the pushed person starts.
  function ground(recording) {
    let shapes = '';
    for (let m = -6; m <= 6; ++m) {
      const x = recording.origin[0] + m, y = recording.origin[1];
      const near = project(recording, [x, y - 0.5, 0]), far = project(recording, [x, y + 0.5, 0]);
      if (Math.min(near[0], far[0]) < 20 || Math.max(near[0], far[0]) > width - 20) continue;
      shapes += line(near, far, 'g') + words([near[0], near[1] + 14], String(m).replace('-', '\u2212') + ' m', 'faint small middle');
    }
    return shapes;
  }
  // An arrow of 1 m for 1000 N that ends at the hip it pushes, with its size.
  function arrow(recording, hip, force) {
    const size = Math.hypot(force[0], force[1]);
    if (size < 1) return '';
    const from = project(recording, [hip[0] - force[0] / 1000, hip[1] - force[1] / 1000, hip[2]]);
    const to = project(recording, hip);
    const long = Math.hypot(to[0] - from[0], to[1] - from[1]) || 1;
    const u = [(to[0] - from[0]) / long, (to[1] - from[1]) / long];
    const wing = side => [to[0] - 10 * u[0] - side * 6 * u[1], to[1] - 10 * u[1] + side * 6 * u[0]];
    return line(from, to, 'a') + line(to, wing(1), 'a') + line(to, wing(-1), 'a') +
           words([from[0], from[1] - 10], Math.round(size) + ' N', 'ink bold middle');
  }
  // A group from above, its front to the right.
  function fromAbove(recording, k) {
    const across = Math.min(220, 0.4 * width);
    const box = {x: width - across - 10, y: 10, w: across, h: 120};
    const scale = Math.min((box.w - 30) / recording.span[0], (box.h - 40) / recording.span[1]);
    const place = p => [box.x + box.w / 2 + scale * (p[0] - recording.middle[0]),
                        box.y + box.h / 2 + 8 - scale * (p[1] - recording.middle[1])];
    let shapes = `<rect class="inset" x="${box.x}" y="${box.y}" width="${box.w}" height="${box.h}"/>` +
                 words([box.x + 8, box.y + 15], 'from above', 'faint small');
    recording.people.forEach((person, n) => {
      for (const [samples, look] of [[person.measured, 'm'], [person.predicted, 'p']]) {
        const sample = at(samples, k);
        if (!sample) continue;
        const cart = place(sample[0]), hip = place(sample[1]);
        shapes += line(cart, hip, look) + disc(cart, 4, look);
        if (recording.pushed.has(n) && look === 'm') shapes += disc(cart, 7, 'ring-push');
      }
    });
    return shapes;
  }
  function draw() {
    const recording = open(data[list.value]), k = Number(time.value);
    let shapes = ground(recording);
    recording.people.forEach((person, n) => {
      const skeleton = at(person.skeleton, k), measured = at(person.measured, k);
      const predicted = at(person.predicted, k), sample = Math.floor(k);
      for (const [a, b] of skeleton ? person.bones : []) {
        shapes += line(project(recording, skeleton[a]), project(recording, skeleton[b]), 'b');
      }
      if (measured) shapes += pendulum(recording, measured, 'm');
      if (predicted) shapes += pendulum(recording, predicted, 'p');
      if (!measured) return;
      const hip = measured[1];
      if (recording.pushed.has(n)) shapes += disc(project(recording, hip), 13, 'ring-push');
      for (const [who, start, force] of recording.pushes) {
        if (who !== n || !force[sample - start]) continue;
        shapes += arrow(recording, hip, force[sample - start]);
      }
      const head = project(recording, [hip[0], hip[1], recording.top]);
      if (recording.people.length > 1) shapes += words([head[0], head[1] - 6 - 12 * (n % 2)], person.name, 'ink small middle');
    });
    if (recording.people.length > 1) shapes += fromAbove(recording, k);
    stage.innerHTML = shapes;
    clock.textContent = (k * recording.step).toFixed(2) + ' s';
    time.setAttribute('aria-valuetext', clock.textContent);
  }
  function choose() {
    time.step = data[list.value].step > 0.1 ? 0.25 : 1;
    time.max = open(data[list.value]).people[0].measured.length - 1;
    time.value = 0;
    draw();
  }
  let started = null;
  function tick(now) {
    if (started === null) return;
    const recording = data[list.value];
    const k = started.sample + (now - started.now) / 1000 / recording.step;
    time.value = Math.min(k, time.max);
    draw();
    if (k >= time.max) stop(); else requestAnimationFrame(tick);
  }
  function stop() {
    started = null;
    play.textContent = 'play';
    play.setAttribute('aria-pressed', 'false');
  }
  play.addEventListener('click', () => {
    if (started !== null) return stop();
    if (time.value === time.max) time.value = 0;
    started = {now: performance.now(), sample: Number(time.value)};
    play.textContent = 'pause';
    play.setAttribute('aria-pressed', 'true');
    requestAnimationFrame(tick);
  });
  data.forEach((recording, i) => list.add(new Option(recording.id, i)));
  list.addEventListener('change', () => { stop(); choose(); });
  time.addEventListener('input', () => { stop(); draw(); });
  turn.addEventListener('input', draw);
  addEventListener('resize', () => { fit(); draw(); });
  // On paper everything is open.
  let closed = [];
  addEventListener('beforeprint', () => {
    closed = [...document.querySelectorAll('details:not([open])')];
    for (const fold of closed) fold.open = true;
  });
  addEventListener('afterprint', () => {
    for (const fold of closed) fold.open = false;
  });
  fit();
  choose();
})();
)js";

}  // namespace pushid
