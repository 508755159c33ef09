// ident: the page's style sheet and its one script.
#pragma once

namespace pushid {

inline constexpr char kPageStyle[] = R"css(
:root{--paper:#fff;--ink:#222;--faint:#666;--line:#ddd;--link:#0b57d0;--box:#f5f6f8;color-scheme:light dark}
@media(prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e8e8e8;--faint:#a0a0a0;--line:#3a3f46;--link:#8ab4f8;--box:#1e2328}}
*{box-sizing:border-box}
body{margin:0 auto;padding:0 1.2rem 4rem;max-width:1060px;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
h1{margin:1.4rem 0 .2rem;font-size:1.7rem}
h2{margin:2.6rem 0 .6rem;font-size:1.25rem;border-bottom:1px solid var(--line);padding-bottom:.2rem;scroll-margin-top:3rem}
header p{color:var(--faint);margin:.2rem 0 1rem}
nav{position:sticky;top:0;background:var(--paper);border-bottom:1px solid var(--line);z-index:1}
nav ul{display:flex;gap:1rem;margin:0;padding:.5rem 0;list-style:none;font-size:.85rem;overflow-x:auto;white-space:nowrap}
a{color:var(--link)}
p{max-width:78ch}
pre{background:var(--box);padding:.5rem .7rem;overflow-x:auto;font-size:.85rem;border-radius:4px}
.scroll{overflow-x:auto}
table{border-collapse:collapse;margin:1rem 0;font-size:.85rem;font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--faint);padding-bottom:.3rem}
th,td{padding:.2rem .8rem .2rem 0;text-align:left;border-bottom:1px solid var(--line);white-space:nowrap}
td:last-child{white-space:normal}
th{font-weight:600}
.number{text-align:right}
figure{margin:1rem 0;break-inside:avoid}
figcaption{color:var(--faint);font-size:.85rem;max-width:78ch}
svg{max-width:100%;height:auto}
@media(max-width:700px){.scroll svg{min-width:640px}}
details{border-bottom:1px solid var(--line);padding:.3rem 0}
summary{cursor:pointer}
.controls{display:flex;flex-wrap:wrap;gap:.6rem 1.2rem;align-items:center;margin:.6rem 0}
.controls label{display:flex;gap:.4rem;align-items:center}
#fig-time{width:min(22rem,60vw)}
#fig-clock{min-width:4.5em;font-variant-numeric:tabular-nums}
#fig-stage{background:var(--box);border-radius:4px;width:100%}
#fig-stage line{stroke-linecap:round}
.g{stroke:var(--line)}.m{stroke:var(--ink);stroke-width:4}.p{stroke:#3b82f6;stroke-width:4;stroke-opacity:.9}
.b{stroke:var(--faint);stroke-width:1.6}
circle.m{fill:var(--ink);stroke:none}circle.p{fill:#3b82f6;stroke:none}.push{fill:#d55e00}
.key span::before{content:"";display:inline-block;width:1.4em;height:4px;margin:0 .4em .2em 1em;background:var(--ink)}
.key .predicted::before{background:#3b82f6}.key .body::before{background:var(--faint);height:2px}.key .pushed::before{background:#d55e00}
:focus-visible{outline:2px solid var(--link);outline-offset:2px}
@media print{:root{--paper:#fff;--ink:#000;--faint:#444;--line:#bbb;--box:#fff}
nav,.controls{display:none}body{max-width:none}h2{break-after:avoid}
svg .paper{fill:#fff}svg .ink,svg .axis{fill:#222}svg .faint{fill:#666}svg line.axis,svg polyline.ink{stroke:#222;fill:none}svg line.grid{stroke:#ddd}}
)css";

// Draws the moving figure of figure_section.cc.
inline constexpr char kPageScript[] = R"js(
(function () {
  'use strict';
  const data = JSON.parse(document.getElementById('fig-data').textContent);
  const find = id => document.getElementById('fig-' + id);
  const list = find('recording'), time = find('time'), turn = find('turn');
  const play = find('play'), clock = find('clock'), stage = find('stage');
  const width = 900, height = 420;

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
    recording.scale = Math.min((width - 60) / (across + 0.3), (height - 70) / top);
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
  function line(a, b, look) {
    return `<line class="${look}" x1="${a[0].toFixed(1)}" y1="${a[1].toFixed(1)}" ` +
           `x2="${b[0].toFixed(1)}" y2="${b[1].toFixed(1)}"/>`;
  }
  function pendulum(recording, sample, look, pushed) {
    const cart = project(recording, sample[0]), hip = project(recording, sample[1]);
    const disc = (at, r, name) =>
        `<circle class="${name}" cx="${at[0].toFixed(1)}" cy="${at[1].toFixed(1)}" r="${r}"/>`;
    return line(cart, hip, look) + disc(cart, 5, look) + disc(hip, 9, look) +
           (pushed ? disc(hip, 5, 'push') : '');
  }
  function draw() {
    const recording = open(data[list.value]), k = Number(time.value);
    let shapes = '';
    for (let m = -6; m <= 6; ++m) {
      const at = [recording.middle[0] + m * 0.5, recording.middle[1]];
      shapes += line(project(recording, [at[0], at[1] - 0.4, 0]),
                     project(recording, [at[0], at[1] + 0.4, 0]), 'g');
    }
    recording.people.forEach((person, n) => {
      const pushed = recording.pushes.some(p => p[0] === n && k >= p[1] && k < p[2]);
      if (person.skeleton[k]) {
        for (const [a, b] of person.bones) {
          shapes += line(project(recording, person.skeleton[k][a]),
                         project(recording, person.skeleton[k][b]), 'b');
        }
      }
      if (person.measured[k]) shapes += pendulum(recording, person.measured[k], 'm', pushed);
      if (person.predicted[k]) shapes += pendulum(recording, person.predicted[k], 'p', false);
    });
    stage.innerHTML = shapes;
    clock.textContent = (k * recording.step).toFixed(2) + ' s';
    time.setAttribute('aria-valuetext', clock.textContent);
  }
  function choose() {
    time.max = open(data[list.value]).people[0].measured.length - 1;
    time.value = 0;
    draw();
  }
  let started = null;
  function tick(now) {
    if (started === null) return;
    const recording = data[list.value];
    const k = started.sample + Math.floor((now - started.now) / 1000 / recording.step);
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
  // On paper everything is open.
  let closed = [];
  addEventListener('beforeprint', () => {
    closed = [...document.querySelectorAll('details:not([open])')];
    for (const fold of closed) fold.open = true;
  });
  addEventListener('afterprint', () => {
    for (const fold of closed) fold.open = false;
  });
  choose();
})();
)js";

}  // namespace pushid
