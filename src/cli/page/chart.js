'use strict';
// Line charts as SVG. Colours come from the style sheet, so that they follow the reader's light or dark mode.

const svgNamespace = 'http://www.w3.org/2000/svg';

function svgElement(name, attributes, text) {
  const element = document.createElementNS(svgNamespace, name);
  for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

// Steps of 1, 2 or 5 times a power of ten, about `count` of them between low and high.
function niceTicks(low, high, count) {
  const raw = (high - low) / count;
  const power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) ticks.push(i * step);
  return ticks;
}

function tickText(value, ticks) {
  const step = ticks.length > 1 ? Math.abs(ticks[1] - ticks[0]) : 1;
  const digits = Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9)));
  return value.toFixed(digits).replace(/^-(0(\.0+)?)$/, '$1');
}

// Extent of the values, with a margin, at least `minExtent` wide.
function extent(values, minExtent) {
  const finite = values.filter((value) => Number.isFinite(value));
  if (!finite.length) return [0, 1];
  let low = finite.reduce((a, b) => Math.min(a, b)), high = finite.reduce((a, b) => Math.max(a, b));
  const margin = Math.max(0.06 * (high - low), (minExtent - (high - low)) / 2, 0);
  return [low - margin, high + margin];
}

// Labels of curves: curves with the same values share one.
function labelsOf(lines) {
  const labels = [];
  for (const line of lines.filter((entry) => entry.label && entry.points.length)) {
    const twin = labels.find((label) => label.points.length === line.points.length &&
      label.points.every((point, i) => Math.abs(point[1] - line.points[i][1]) < 0.002));
    if (twin) twin.text += ', ' + line.label;
    else labels.push({ text: line.label, points: line.points, colour: line.colour });
  }
  return labels;
}

// Puts labels at the right ends of their curves, `distance` apart: those that would overlap form a group about the mean
// of their places (pool adjacent violators).
function placeLabels(labels, y, top, bottom) {
  const distance = 15;
  const groups = [];
  for (const label of labels.map((entry) => ({ ...entry, end: y(entry.points[entry.points.length - 1][1]) }))
    .sort((a, b) => a.end - b.end)) {
    groups.push({ members: [label] });
    for (;;) {
      const last = groups[groups.length - 1], n = last.members.length;
      const mean = last.members.reduce((sum, member) => sum + member.end, 0) / n;
      last.start = Math.max(top, Math.min(bottom - (n - 1) * distance, mean - (n - 1) / 2 * distance));
      const before = groups[groups.length - 2];
      if (!before || before.start + before.members.length * distance <= last.start) break;
      groups.splice(-2, 2, { members: before.members.concat(last.members) });
    }
  }
  return groups.flatMap((group) => group.members.map((label, i) => ({ ...label, position: group.start + i * distance })));
}

// chart: {title, x: {label, low, high, ticks?, text?}, y: the same, bands: [{points: [[x, low, high]], colour}],
// lines: [{points: [[x, y]], colour, label, dash}], dots: [{points: [[x, y, error, name]], colour, hollow, label}]}
function drawChart(chart) {
  const lines = chart.lines || [], dots = chart.dots || [], bands = chart.bands || [];
  const narrow = window.innerWidth < 600;  // a phone: fewer units, so that the text is as large as elsewhere
  const width = narrow ? 400 : 640, height = (chart.height || 360) * (narrow ? 0.85 : 1), ticks = narrow ? 4 : 6;
  const character = 7.6, maxCharacters = narrow ? 15 : 30;
  const labels = labelsOf(lines).map((label) => label.text.length <= maxCharacters ? label :
    { ...label, text: label.text.slice(0, maxCharacters - 1) + '…' });
  const longest = Math.max(0, ...labels.map((label) => label.text.length));
  const named = chart.x.names && chart.x.names.length <= 20;
  const edge = { left: 62, right: 18 + character * longest, top: 14, bottom: named ? 120 : 48 };
  const x = (value) => edge.left + (value - chart.x.low) / (chart.x.high - chart.x.low) * (width - edge.left - edge.right);
  const y = (value) => height - edge.bottom -
    (value - chart.y.low) / (chart.y.high - chart.y.low) * (height - edge.top - edge.bottom);
  const svg = svgElement('svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': chart.title });
  const add = (name, attributes, text) => svg.appendChild(svgElement(name, attributes, text));
  const xTicks = chart.x.ticks || niceTicks(chart.x.low, chart.x.high, ticks),
    yTicks = niceTicks(chart.y.low, chart.y.high, 6);

  for (const tick of yTicks) {
    add('line', { class: 'grid', x1: edge.left, x2: width - edge.right, y1: y(tick), y2: y(tick) });
    add('text', { class: 'tick', x: edge.left - 8, y: y(tick) + 4, 'text-anchor': 'end' }, tickText(tick, yTicks));
  }
  if (named) {
    chart.x.names.forEach((name, i) => {
      const base = name.split('/').pop(), short = base.length > 18 ? '…' + base.slice(-17) : base;
      add('text', { class: 'tick', transform: `translate(${x(i) + 4} ${height - edge.bottom + 14}) rotate(-55)`,
        'text-anchor': 'end', 'font-size': 11 }, short);
    });
  } else {
    for (const tick of xTicks)
      add('text', { class: 'tick', x: x(tick), y: height - edge.bottom + 18, 'text-anchor': 'middle' },
        (chart.x.text || tickText)(tick, xTicks));
    add('text', { x: (edge.left + width - edge.right) / 2, y: height - 8, 'text-anchor': 'middle' }, chart.x.label);
  }
  add('text', { transform: `translate(15 ${(height - edge.bottom + edge.top) / 2}) rotate(-90)`, 'text-anchor': 'middle' },
    chart.y.label);
  add('path', { class: 'axis', d: `M${edge.left} ${edge.top}V${height - edge.bottom}H${width - edge.right}` });

  const clamped = (value) => Math.max(edge.top, Math.min(height - edge.bottom, y(value)));
  for (const band of bands) {
    const forward = band.points.map((p) => `${x(p[0]).toFixed(1)} ${clamped(p[2]).toFixed(1)}`);
    const back = band.points.slice().reverse().map((p) => `${x(p[0]).toFixed(1)} ${clamped(p[1]).toFixed(1)}`);
    add('path', { class: 'band', style: `fill:var(--${band.colour})`, d: 'M' + forward.concat(back).join('L') + 'Z' });
  }
  for (const line of lines)
    add('path', { class: 'curve', style: `stroke:var(--${line.colour})`, 'stroke-dasharray': line.dash || 'none',
      d: 'M' + line.points.map((p) => `${x(p[0]).toFixed(1)} ${clamped(p[1]).toFixed(1)}`).join('L') });
  for (const group of dots)
    for (const [position, value, error, name] of group.points) {
      if (!Number.isFinite(value)) continue;
      const style = `stroke:var(--${group.colour});fill:${group.hollow ? 'none' : `var(--${group.colour})`}`;
      if (error > 0)
        add('line', { class: 'bar', style, x1: x(position), x2: x(position), y1: clamped(value - error), y2: clamped(value + error) });
      const dot = add('circle', { style, cx: x(position).toFixed(1), cy: clamped(value).toFixed(1), r: group.hollow ? 4 : 3 });
      if (name) dot.appendChild(svgElement('title', {}, name));
    }
  for (const label of placeLabels(labels, y, edge.top + 4, height - edge.bottom))
    add('text', { x: width - edge.right + 6, y: label.position + 4, style: `fill:var(--${label.colour})` },
      label.text);
  return svg;
}

// A grid of cells, each with a value -1..1 (blue to red), or 0..1 (transparent to full) for one colour.
function drawCells(cells, columns, title, colourOf, aspect) {
  const side = 20, rows = cells.length / columns, tall = side * (aspect || 1);
  const svg = svgElement('svg', { class: 'chart', viewBox: `0 0 ${columns * side} ${rows * tall}`, role: 'img',
    'aria-label': title, style: 'border:1px solid var(--line)' });
  cells.forEach((value, i) => {
    if (!value || !Number.isFinite(value.share)) return;
    const cell = svgElement('rect', { x: (i % columns) * side, y: Math.floor(i / columns) * tall, width: side + 0.3,
      height: tall + 0.3, style: `fill:var(--${colourOf(value)})`, 'fill-opacity': Math.min(1, Math.abs(value.share)).toFixed(3) });
    if (value.text) cell.appendChild(svgElement('title', {}, value.text));
    svg.appendChild(cell);
  });
  return svg;
}
