// The explorable person of the report page: sliders, the pendulum from the side and the hip's path with its band. The
// physics is explore.cc, which stands in the page as WebAssembly; here is only what is drawn.
(async function () {
  'use strict';
  const find = id => document.getElementById('exp-' + id), data = JSON.parse(find('data').textContent);
  const bytes = Uint8Array.from(atob(find('wasm').textContent), c => c.charCodeAt(0));
  const {instance: {exports: model}} = await WebAssembly.instantiate(bytes, {wasi_snapshot_preview1: {proc_exit: () => 0}});
  model._initialize();
  const count = model.parameters(), columns = 7, frames = data.frames, inputs = data.inputs.length;
  const block = () => new Float64Array(model.memory.buffer, model.numbers());
  const stage = find('stage'), graph = find('graph'), sliders = [], height = 300;
  let shown = [], fitted = [], frame = 0, playing = !matchMedia('(prefers-reduced-motion: reduce)').matches, last = 0;

  // Rows [cart, hip, height, step, push, lower, upper] up to where the person leaves the model's domain.
  function roll(values, draws) {
    const numbers = block();
    for (const slider of sliders) if (slider.input >= 0) numbers[slider.input] = slider.value();
    numbers[data.draws_at] = draws;
    numbers.set(values, inputs);
    const length = model.push(), start = inputs + (2 + model.draws()) * count, now = block();
    return Array.from({length}, (_, t) => now.slice(start + columns * t, start + columns * (t + 1)));
  }
  function compute() {
    const values = data.values.slice();
    for (const slider of sliders) if (slider.parameter >= 0) values[slider.parameter] = slider.value();
    shown = roll(values, data.draws.length);
    fitted = roll(data.values, 0);
    draw();
  }
  function slide(row, into) {
    const label = document.createElement('label'), range = document.createElement('input'), out = document.createElement('output');
    const log = row.log, to = log ? Math.log : x => x, from = log ? Math.exp : x => x, name = document.createElement('span');
    Object.assign(range, {type: 'range', min: 0, max: 1000});
    range.value = 1000 * (to(row.value) - to(row.lower)) / (to(row.upper) - to(row.lower));
    const start = range.value;
    const slider = {...row, value: () => range.value === start ? row.value
      : from(to(row.lower) + range.value / 1000 * (to(row.upper) - to(row.lower))), reset: () => { range.value = start; say(); }};
    const say = () => { out.textContent = Number(slider.value().toPrecision(3)) + (row.unit === '1' ? '' : ' ' + row.unit);
                        range.setAttribute('aria-valuetext', out.textContent); };
    name.textContent = row.name;
    label.title = row.meaning;
    label.append(name, range, out);
    range.addEventListener('input', () => { say(); compute(); });
    say();
    sliders.push(slider);
    into.append(label);
  }
  const line = (points, look) => `<polyline class="${look}" fill="none" points="${points.map(p => p.map(v => v.toFixed(1)).join()).join(' ')}"/>`;
  const words = (x, y, text, look) => `<text class="${look}" x="${x.toFixed(1)}" y="${y.toFixed(1)}">${text}</text>`;
  const disc = (at, r, look) => `<circle class="${look}" cx="${at[0].toFixed(1)}" cy="${at[1].toFixed(1)}" r="${r}"/>`;
  const steps = span => [0.1, 0.2, 0.5, 1, 2, 5, 10, 20].find(s => span / s <= 6) || 50;
  const signed = v => String(Number(v.toFixed(2))).replace('-', '\u2212');
  function fit(picture) {
    const width = Math.max(280, picture.clientWidth);
    picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
    return width;
  }
  // From the side, pushed to the right; so far that everybody stays in sight.
  function side() {
    const width = fit(stage), all = shown.concat(fitted).flatMap(r => [r[0], r[1]]);
    const low = Math.min(-0.3, ...all) - 0.25, high = Math.max(0.3, ...all) + 0.25;
    const scale = Math.min(width / (high - low), (height - 50) / 1.45), middle = (low + high) / 2;
    const place = (x, z) => [width / 2 + scale * (x - middle), height - 30 - scale * z];
    let shapes = line([[0, height - 30], [width, height - 30]], 'g');
    const half = width / 2 / scale, every = steps(6 * 64 / scale);  // labels of 64 pixels
    for (let m = Math.ceil((middle - half) / every) * every; m <= middle + half; m += every) {
      const [x] = place(m, 0);
      if (x > 20 && x < width - 20) shapes += line([[x, height - 30], [x, height - 24]], 'g') + words(x, height - 11, signed(m) + ' m', 'faint small middle');
    }
    for (const [rows, look] of [[fitted, 'b'], [shown, 'p']]) {
      const [cart, hip, top, step, push] = rows[Math.min(frame, rows.length - 1)];
      const foot = place(cart, 0), head = place(hip, top), lift = 8 * step;
      shapes += line([foot, head], look) + disc(head, 9, look) + line([[foot[0] - 0.06 * scale, foot[1] - lift], [foot[0] + 0.16 * scale, foot[1]]], look);
      if (look !== 'p' || !push) continue;
      const from = place(hip - push / 1000, top), way = Math.sign(push);
      shapes += line([from, [head[0] - 10 * way, head[1]]], 'a') + line([[head[0] - 20 * way, head[1] - 6], [head[0] - 10 * way, head[1]], [head[0] - 20 * way, head[1] + 6]], 'a') +
                words(Math.min(width - 40, Math.max(40, from[0])), head[1] - 14, Math.round(push) + ' N', 'ink bold middle');
    }
    stage.innerHTML = shapes;
  }
  function paths() {
    const width = fit(graph), left = 52, bottom = height - 34, end = frames * data.dt;
    const all = shown.flatMap(r => [r[5], r[6]]).concat(fitted.map(r => r[1]));
    const low = Math.min(0, ...all), high = Math.max(0.05, ...all);
    const x = t => left + (width - left - 12) * t * data.dt / end, y = v => bottom - (bottom - 24) * (v - low) / (high - low);
    let shapes = words(left - 44, 14, 'hip, m', 'faint small');
    const every = steps(high - low);
    for (let v = Math.ceil(low / every) * every; v <= high; v += every) {
      shapes += line([[left, y(v)], [width - 12, y(v)]], 'g') + (y(v) > 22 ? words(left - 8, y(v) + 4, signed(v), 'faint small end') : '');
    }
    for (let s = 0; s <= end; ++s) shapes += words(x(s / data.dt), height - 12, s + (s === 0 ? ' s' : ''), 'faint small middle');
    const edge = side => shown.map((r, t) => [x(t), y(r[side])]);
    shapes += `<polygon class="exp-band" points="${edge(5).concat(edge(6).reverse()).map(p => p.map(v => v.toFixed(1)).join()).join(' ')}"/>` +
              line(fitted.map((r, t) => [x(t), y(r[1])]), 'b') + line(edge(1), 'exp-path');
    const now = Math.min(frame, shown.length - 1);
    graph.innerHTML = shapes + line([[x(frame), 24], [x(frame), bottom]], 'g') + disc([x(now), y(shown[now][1])], 5, 'p');
  }
  function draw() {
    side();
    paths();
    const out = shown.length < frames, t = shown.length * data.dt, final = shown[shown.length - 1];
    find('clock').textContent = (frame * data.dt).toFixed(2) + ' s';
    find('said').dataset.hip = final[1];  // for who asks exactly
    find('said').textContent = out ? `The person falls: after ${t.toFixed(2)} s the pendulum leaves the model's domain.`
      : `After ${t.toFixed(0)} s the hip is ${signed(final[1])} m from where it stood (90 %: ${signed(final[5])} to ${signed(final[6])} m).`;
  }
  function tick(now) {
    if (!playing) return;
    const gone = Math.floor((now - last) / 1000 / data.dt);
    if (gone > 0) { last = now; frame = (frame + gone) % frames; draw(); }
    requestAnimationFrame(tick);
  }
  function play(on) {
    playing = on;
    find('play').textContent = on ? 'pause' : 'play';
    if (on) { last = performance.now(); requestAnimationFrame(tick); }
  }
  const numbers = block();
  numbers.set(data.inputs);
  numbers.set(data.estimate, inputs + count);
  data.draws.forEach((draw, k) => {
    const full = data.estimate.slice();
    data.drawn.forEach((index, i) => { full[index] = draw[i]; });
    numbers.set(full, inputs + (2 + k) * count);
  });
  for (const row of data.sliders) slide(row, find(row.held ? 'held' : 'sliders'));
  if (!data.sliders.some(row => row.held)) find('held').parentElement.remove();
  find('play').addEventListener('click', () => play(!playing));
  find('reset').addEventListener('click', () => { for (const slider of sliders) slider.reset(); compute(); });
  addEventListener('resize', draw);
  compute();
  play(playing);
})();
