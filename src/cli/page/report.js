// The page of a fit, a folder, a profile or a database, from the JSON in the page.

const data = JSON.parse(document.getElementById('data').textContent);
const page = document.getElementById('report');

function element(name, attributes, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
  for (const child of children) if (child !== null && child !== undefined) made.append(child);
  return made;
}

const fixed = (value, digits) => Number.isFinite(value) ? value.toFixed(digits) : '–';
const sigmaText = (sigma) => sigma > 0 && sigma < 0.0005 ? sigma.toPrecision(1) : fixed(sigma, 3);
const signed = (value, digits) => Number.isFinite(value) ? (value < 0 ? '−' : '+') + Math.abs(value).toFixed(digits) : '–';

function section(title, ...children) {
  return element('section', {}, title ? element('h2', {}, title) : null, ...children);
}

function table(head, rows) {
  const isNumber = head.map((name, i) => rows.length > 0 && rows.every((row) => /^[−+–\d.\s±]*$/.test(row[i])));
  const row = (cells, kind) => element('tr', {},
    ...cells.map((cell, i) => element(kind, isNumber[i] ? { class: 'number' } : {}, cell)));
  return element('div', { class: 'scroll', tabindex: '0' },
    element('table', {}, element('thead', {}, row(head, 'th')), element('tbody', {}, ...rows.map((cells) => row(cells, 'td')))));
}

function values(head, rows) {
  return element('details', {}, element('summary', {}, 'Values'), table(head, rows));
}

// Two versions of a picture, one over the other, with a divider that the mouse, a finger or the arrow keys move.
function comparison(view) {
  const slider = element('input', { type: 'range', min: '0', max: '100', value: '50',
    'aria-label': `Divider between ${view.name} before and after correction` });
  const box = element('div', { class: 'compare' },
    element('img', { src: view.before, alt: `${view.name} before correction` }),
    element('img', { class: 'after', src: view.after, alt: `${view.name} after correction` }),
    element('span', { class: 'left' }, 'before'), element('span', { class: 'right' }, 'after'), slider);
  slider.addEventListener('input', () => box.style.setProperty('--cut', slider.value + '%'));
  return box;
}

function pictures(views, note) {
  if (!views || !views.length) return note ? section('Before and after', element('p', {}, note)) : null;
  const stage = element('div'), name = element('p', { class: 'quiet' });
  const buttons = views.map((view) => element('button', { type: 'button', 'aria-pressed': 'false', title: view.name },
    element('img', { src: view.after, alt: view.name, loading: 'lazy' })));
  const show = (i) => {
    stage.replaceChildren(comparison(views[i]));
    name.textContent = views[i].name;
    buttons.forEach((button, k) => button.setAttribute('aria-pressed', String(k === i)));
  };
  buttons.forEach((button, i) => button.addEventListener('click', () => show(i)));
  show(0);
  return section('Before and after', note ? element('p', { class: 'quiet' }, note) : null, stage, name,
    views.length > 1 ? element('div', { class: 'views' }, ...buttons) : null);
}

// Sections next to each other where the page is wide enough; null ones are left out.
function sideBySide(...parts) {
  const present = parts.filter((part) => part);
  return present.length ? element('div', { class: 'pair' }, ...present) : null;
}

const curveColour = (curve, i) => ['red', 'green', 'blue'].includes(curve.label) ? curve.label : 'curve' + i % 8;

function illuminanceChart(falloffs, points, title) {
  const lows = falloffs.flatMap((curve) => curve.m.map((m, i) => m - curve.sigma[i]));
  const highs = falloffs.flatMap((curve) => curve.m.map((m, i) => m + curve.sigma[i]));
  const low = Math.min(0.5, Math.floor(10 * lows.reduce((a, b) => Math.min(a, b), 1)) / 10);
  const high = Math.max(1.02, highs.reduce((a, b) => Math.max(a, b), 1));
  const radiusOf = (i, curve) => i / (curve.m.length - 1);
  return drawChart({
    title, x: { label: 'radius, half diagonals', low: 0, high: 1 }, y: { label: 'relative illuminance M', low, high },
    bands: falloffs.map((curve, i) => ({ colour: curveColour(curve, i),
      points: curve.m.map((m, k) => [radiusOf(k, curve), m - curve.sigma[k], m + curve.sigma[k]]) })),
    lines: falloffs.map((curve, i) => ({ colour: curveColour(curve, i), label: curve.label,
      dash: i < 8 ? 'none' : '6 4', points: curve.m.map((m, k) => [radiusOf(k, curve), m]) })),
    dots: points && points.length ? [{ colour: 'quiet', points: points.map((p) =>
      [p.r, p.m, p.sigma, `radius ${fixed(p.r, 2)}: M ${fixed(p.m, 3)} ± ${sigmaText(p.sigma)}, ${p.count} pairs`]) }] : [] });
}

function illuminance(report) {
  if (!report.falloffs.length) return null;
  const rows = report.falloffs.flatMap((curve) => [0.25, 0.5, 0.75, 1].map((r) => {
    const k = Math.round(r * (curve.m.length - 1));
    return [curve.label || 'all channels', fixed(r, 2), fixed(curve.m[k], 3), sigmaText(curve.sigma[k]), signed(Math.log2(curve.m[k]), 2)];
  }));
  return section('Relative illuminance',
    element('p', { class: 'quiet' }, 'The light that arrives at a radius, compared with the centre.' +
      (report.falloffs.some((curve) => curve.sigma.some((sigma) => sigma > 0.002)) ? ' Band: one standard error.' : '') +
      (report.falloff_points.length ? ' Dots: medians of the measured pairs.' : '')),
    illuminanceChart(report.falloffs, report.falloff_points, 'Relative illuminance over the radius'),
    values(['curve', 'radius', 'M', 'standard error', 'EV'], rows));
}

function responses(report) {
  if (!report.responses.length) return null;
  const curves = report.responses;
  const points = (list) => list.map((value, i) => [i / (list.length - 1), value]);
  const bands = curves.filter((curve) => curve.sigma).map((curve, i) => ({ colour: curveColour(curve, i),
    points: curve.f.map((value, k) => [k / (curve.f.length - 1), value - curve.sigma[k], value + curve.sigma[k]]) }));
  if (report.typical)
    bands.unshift({ colour: 'quiet', points: report.typical.low.map((low, i) =>
      [i / (report.typical.low.length - 1), low, report.typical.high[i]]) });
  return section('Response',
    element('p', { class: 'quiet' }, 'The recorded value over the light.' +
      (report.typical ? ` Grey band: ${report.typical.label}.` : '') +
      (bands.length > (report.typical ? 1 : 0) ? ' Coloured band: one standard error.' : '')),
    drawChart({ title: 'Response', x: { label: 'light, 1 = saturation', low: 0, high: 1 },
      y: { label: 'recorded value', low: 0, high: 1 }, bands,
      lines: curves.map((curve, i) => ({ colour: curveColour(curve, i), label: curve.label, points: points(curve.f) })) }));
}

function exposures(report) {
  const images = report.images.map((image, i) => ({ ...image, index: i })).filter((image) => image.ev !== null);
  if (images.length < 2) return null;
  const names = report.images.map((image) => image.name);
  const axis = { label: 'image', low: -0.5, high: names.length - 0.5, names,
    text: (value) => String(Math.round(value)) };
  const known = images.filter((image) => image.known_ev !== null);
  const all = images.flatMap((image) => [image.ev - image.ev_sigma, image.ev + image.ev_sigma])
    .concat(known.map((image) => image.known_ev));
  const [low, high] = extent(all, 0.4);
  const dots = [{ colour: 'accent', points: images.map((image) => [image.index, image.ev, image.ev_sigma,
    `${image.name}: ${signed(image.ev, 3)} ± ${fixed(image.ev_sigma, 3)} EV`]) }];
  if (known.length) dots.unshift({ colour: 'quiet', hollow: true, points: known.map((image) =>
    [image.index, image.known_ev, 0, `${image.name}: ${signed(image.known_ev, 2)} EV by EXIF`]) });
  const height = names.length <= 20 ? 440 : 360;
  const parts = [element('p', { class: 'quiet' }, 'Exposure relative to the reference, with its standard error.' +
    (known.length ? ' Circles: EXIF, up to a common offset.' : '')),
    drawChart({ title: 'Exposure of each image', height, x: axis, y: { label: 'EV', low, high }, dots })];
  const balances = [];
  const coloured = images.filter((image) => image.balance_sigma[0] > 0 || image.balance_sigma[2] > 0 ||
    image.balance[0] !== 1 || image.balance[2] !== 1);
  if (coloured.length) {
    const [minFactor, maxFactor] = extent(images.flatMap((image) => [0, 2].flatMap((channel) =>
      [-1, 1].map((sign) => image.balance[channel] + sign * image.balance_sigma[channel]))), 0.1);
    balances.push(element('p', { class: 'quiet' }, 'Factors of red (red dots) and blue (blue dots), relative to green.'),
      drawChart({ title: 'White balance of each image', height, x: axis,
        y: { label: 'factor', low: minFactor, high: maxFactor },
        dots: [0, 2].map((channel) => ({ colour: channel ? 'blue' : 'red', points: images.map((image) =>
          [image.index, image.balance[channel], image.balance_sigma[channel],
            `${image.name}: ${fixed(image.balance[channel], 4)}`]) })) }));
  }
  const rows = report.images.map((image) => [image.name, image.ev === null ? 'left out' : signed(image.ev, 3),
    fixed(image.ev_sigma || NaN, 3), signed(image.known_ev === null ? NaN : image.known_ev, 2), fixed(image.balance[0], 4),
    fixed(image.balance[2], 4)]);
  parts.push(values(['image', 'EV', 'standard error', 'EXIF', 'red', 'blue'], rows));
  return sideBySide(section('Exposure', ...parts), balances.length ? section('White balance', ...balances) : null);
}

function jointHistogram(histogram, title) {
  const bins = histogram.bins, cells = new Array(bins * bins);
  const maxCount = histogram.cells.reduce((a, cell) => Math.max(a, cell[2]), 1);
  for (const [column, row, count] of histogram.cells)
    cells[(bins - 1 - row) * bins + column] = { share: 0.15 + 0.85 * Math.log(1 + count) / Math.log(1 + maxCount),
      text: `${count} pairs` };
  const svg = drawCells(cells, bins, title, () => 'accent');
  const side = bins * 20, left = 52, below = 34;
  svg.append(svgElement('path', { d: `M0 ${side}L${side} 0`, style: 'stroke:var(--quiet);stroke-width:2' }),
    svgElement('rect', { width: side, height: side, fill: 'none', style: 'stroke:var(--line);stroke-width:2' }));
  for (const level of [0, 64, 128, 192, 255]) {
    const offset = level / 255 * side;
    svg.append(svgElement('text', { class: 'tick', x: -8, y: side - offset + 8, 'text-anchor': 'end', 'font-size': 22 }, level),
      svgElement('text', { class: 'tick', x: offset, y: side + 26, 'text-anchor': 'middle', 'font-size': 22 }, level));
  }
  svg.setAttribute('viewBox', `${-left} -12 ${side + left + 24} ${side + 12 + below}`);
  svg.style.border = '0';
  return element('figure', { style: 'margin:0' }, svg, element('figcaption', { class: 'quiet' }, title));
}

function residualChart(bins, title, label, low, high) {
  const points = bins.filter((bin) => bin.count > 0);
  if (points.length < 2) return null;
  const limit = 1.15 * points.reduce((a, bin) => Math.max(a, Math.abs(bin.mean) + bin.spread), 1);
  return drawChart({ title, height: 300, x: { label, low, high }, y: { label: 'residual, levels of 255', low: -limit, high: limit },
    bands: [{ colour: 'accent', points: points.map((bin) => [bin.at, bin.mean - bin.spread, bin.mean + bin.spread]) }],
    lines: [{ colour: 'accent', points: points.map((bin) => [bin.at, bin.mean]) }] });
}

function residuals(report) {
  if (!report.residuals) return [];
  const r = report.residuals, maxSamples = r.frame.count.reduce((a, b) => Math.max(a, b), 1);
  const limit = Math.max(1, r.frame.mean.reduce((a, b) => Math.max(a, Math.abs(b || 0)), 0));
  const map = r.frame.mean.map((mean, i) => r.frame.count[i] ? { share: mean / limit,
    text: `${signed(mean, 2)} levels, ${r.frame.count[i]} samples` } : null);
  const coverage = r.frame.count.map((count) => count ? { share: 0.1 + 0.9 * Math.sqrt(count / maxSamples), text: `${count} samples` } : null);
  return [
    sideBySide(section('Values of the same scene points in two pictures', element('p', { class: 'quiet' },
      'Each cell counts pairs of green values; x: value in one picture, y: in the other. On the diagonal both pictures agree.'),
      sideBySide(jointHistogram(r.joint_before, 'before'), jointHistogram(r.joint_after, 'after')))),
    sideBySide(section('Residual over the radius', element('p', { class: 'quiet' },
      'Mean, and band of half of all pairs. A mean away from 0 towards the edge is remaining falloff.'),
      residualChart(r.by_radius, 'Residual over the radius', 'radius, half diagonals', 0, 1)),
    section('Residual over the grey value', element('p', { class: 'quiet' },
      'A mean away from 0 is an error of the response.'),
      residualChart(r.by_grey, 'Residual over the grey value', 'grey value, levels of 255', 0, 255))),
    sideBySide(section('Residual over the frame', element('p', { class: 'quiet' },
      `Red: brighter than predicted, blue: darker. Full colour is ${fixed(limit, 1)} levels.`),
      drawCells(map, r.frame.columns, 'Mean residual over the frame', (cell) => cell.share > 0 ? 'red' : 'blue', r.frame.aspect)),
    section('Coverage of the frame', element('p', { class: 'quiet' }, `Samples in each part of the frame: full colour is ${maxSamples}.`),
      drawCells(coverage, r.frame.columns, 'Samples over the frame', () => 'accent', r.frame.aspect)))];
}

function leftOut(report) {
  if (!report.left_out || !report.left_out.length) return null;
  return section('Left out', table(['picture', 'reason'], report.left_out.map((out) => [out.name, out.reason])));
}

function closing(report) {
  const parts = [leftOut(report)];
  if (report.command)
    parts.push(section('Repeat', element('p', { class: 'quiet' }, `${report.program}. Run this command in the folder where the report was made.`),
      element('pre', {}, report.command)));
  if (report.result)
    parts.push(section('Numbers', element('p', { class: 'quiet' },
      'The same numbers as JSON. The page carries them in the element with the id "data".'),
      element('details', {}, element('summary', {}, 'JSON'), element('pre', {}, JSON.stringify(report.result, null, 1)))));
  return parts;
}

function verdict(report) {
  const box = section(null, element('p', {}, element('strong', {}, report.verdict.headline)),
    ...report.verdict.details.map((text) => element('p', {}, text)),
    ...(report.verdict.notes || []).map((text) => element('p', { class: 'quiet' }, 'Note: ' + text)),
    element('dl', { class: 'facts' }, ...report.facts.map(([name, value]) =>
      element('div', {}, element('dt', {}, name), element('dd', {}, value)))));
  box.className = 'verdict ' + report.verdict.level;
  return box;
}

function heading(title, subtitle) {
  return element('header', {}, element('h1', {}, title), element('p', { class: 'quiet' }, subtitle));
}

function appendPresent(parent, parts) {
  parent.append(...parts.filter((part) => part));
}

function charts(report) {
  return [sideBySide(illuminance(report), responses(report)), exposures(report), ...residuals(report)];
}

function fitPage(report) {
  appendPresent(page, [heading(report.title, report.subtitle), verdict(report), pictures(report.views, report.views_note),
    ...charts(report), ...closing(report)]);
}

// One line for each panorama, which opens its verdict and charts; they are drawn then.
function panoramas(report) {
  if (!report.panoramas.length) return null;
  const list = report.panoramas.map((panorama) => {
    if (!panorama.page) return element('p', {}, panorama.line);
    const details = element('details', {}, element('summary', {}, panorama.line));
    details.addEventListener('toggle', () => {
      if (details.open && details.childElementCount === 1)
        appendPresent(details, [verdict(panorama.page), ...charts(panorama.page), leftOut(panorama.page)]);
    });
    return details;
  });
  if (list[0].tagName === 'DETAILS') list[0].open = true;
  return section('Panoramas', ...list);
}

// A folder of pictures: its panoramas, and the pictures corrected with profiles of a database.
function folderPage(report) {
  const lookedUp = report.looked_up.length ? section('Corrected with profiles of a database',
    table(['picture', 'correction'], report.looked_up.map((picture) => [picture.name, picture.correction]))) : null;
  appendPresent(page, [heading(report.title, report.subtitle), verdict(report), pictures(report.views, report.views_note),
    panoramas(report), lookedUp, ...closing(report)]);
}

// A lens: its settings, measured on cards.
function lensPage(report) {
  appendPresent(page, [heading(report.title, report.subtitle), verdict(report),
    section('Settings', table(['setting', 'pictures', 'light in the corner', 'result'], report.settings)),
    sideBySide(illuminance(report)), ...closing(report)]);
}

// One figure of all units, from the lowest to the highest, with the limits as dashed lines.
function unitPlot(plot) {
  const points = plot.points.slice().sort((a, b) => a.value - b.value).map((point, i) => [i + 1, point.value, point.sigma,
    `${point.unit}: ${signed(point.value, 2)} ± ${fixed(point.sigma, 2)} %`, point.pass]);
  if (!points.length) return null;
  const isSigned = points[0][1] < 0;
  const limits = isSigned ? [-plot.limit, plot.limit] : [plot.limit];
  const [low, high] = extent(points.flatMap((point) => [point[1] - point[2], point[1] + point[2]]).concat(limits, 0), 0.1);
  const x = { label: 'units, by this figure', low: 0, high: points.length + 1 };
  return drawChart({ title: `Difference: ${plot.name}`, height: 280, x, y: { label: `${plot.name}, %`, low, high },
    lines: limits.map((limit) => ({ colour: 'quiet', dash: '6 4', points: [[0, limit], [points.length + 1, limit]] })),
    dots: [{ colour: 'accent', points: points.filter((point) => point[4]) },
      { colour: 'red', points: points.filter((point) => !point[4]) }] });
}

// Differences over the frame, %.
function unitMap(map, most) {
  const cells = map.cells.map((value) => value === null ? null : { share: value / most, text: `${signed(value, 2)} %` });
  return element('figure', { style: 'margin:0' },
    drawCells(cells, map.columns, map.name, (cell) => cell.share > 0 ? 'red' : 'blue'),
    element('figcaption', { class: 'quiet' }, map.name));
}

function unitBatch(batch) {
  const parts = [batch.note ? section(null, element('p', {}, batch.note)) : null];
  if (batch.failed.length)
    parts.push(section('Units that do not pass', element('p', { class: 'quiet' }, 'Differences in % and their standard errors.'),
      table(['unit', 'verdict', 'corner', 'centre', 'frame', 'colour', 'reason'], batch.failed)));
  const plots = batch.plots.map(unitPlot).filter((plot) => plot);
  if (plots.length)
    parts.push(section('Differences of all units', element('p', { class: 'quiet' },
      'From what is usual, with standard errors. Dashed: limits. Red: units that fail.'), sideBySide(...plots)));
  if (batch.mean) {
    const light = batch.mean.cells.map((value) => value === null ? null : { share: value / 100, text: `${fixed(value, 1)} %` });
    const most = batch.maps[0].cells.reduce((a, value) => Math.max(a, Math.abs(value || 0)), 0.1);
    const largest = batch.maps.slice(1).flatMap((map) => map.cells).reduce((a, value) => Math.max(a, Math.abs(value || 0)), 0.1);
    parts.push(sideBySide(section('Usual light', element('p', { class: 'quiet' }, 'Green relative to the middle: full colour is 100 %.'),
      drawCells(light, batch.mean.columns, 'Usual light over the frame', () => 'accent')),
    section('Largest difference of a unit that passes', element('p', { class: 'quiet' },
      `At each place. Red: brighter, blue: darker. Full colour is ${fixed(most, 2)} %.`), unitMap(batch.maps[0], most))));
    if (batch.maps.length > 1)
      parts.push(section('Differences of units that fail', element('p', { class: 'quiet' },
        `Red: brighter, blue: darker. Full colour is ${fixed(largest, 1)} %.`),
      sideBySide(...batch.maps.slice(1).map((map) => unitMap(map, largest)))));
  }
  return parts;
}

// Units of one type, a part for each setting.
function unitsPage(report) {
  appendPresent(page, [heading(report.title, report.subtitle), verdict(report),
    ...report.batches.flatMap((batch) => [report.batches.length > 1 ? element('h2', {}, batch.title) : null, ...unitBatch(batch)]),
    ...closing(report)]);
}

function cameras(report) {
  if (!report.cameras.length) return '';
  return section('Cameras', table(['camera', 'profiles', 'response'], report.cameras.map((camera) =>
    [camera.name, String(camera.profiles), camera.response])));
}

// A database: lenses in a table that a search narrows, and the curves of one lens over its apertures.
function databasePage(report) {
  const count = (n, word) => `${n} ${word}${n === 1 ? '' : word.endsWith('s') ? 'es' : 's'}`;
  page.append(heading(report.title, report.subtitle), verdict(report));
  const search = element('input', { type: 'search', id: 'search', placeholder: 'e.g. canon 24-70', autocomplete: 'off' });
  const focal = element('select', { id: 'focal' }), distance = element('select', { id: 'distance' }),
    crop = element('select', { id: 'crop' });
  const list = element('tbody'), found = element('p', { class: 'quiet', 'aria-live': 'polite' });
  const chart = element('div'), name = element('h2', {}, '');
  const focalLabel = element('label', {}, 'focal length', focal), distanceLabel = element('label', {}, 'focus distance', distance),
    cropLabel = element('label', {}, 'sensor', crop);
  let shown = null;

  if (!report.lenses.length) {
    page.append(section('Lenses', element('p', {}, 'No profile has a falloff.')), cameras(report));
    appendPresent(page, closing(report));
    return;
  }
  const millimetres = (value) => value === null ? 'any focal length' : `${+value.toFixed(1)} mm`;
  const metres = (value) => value === null ? 'any distance' : value >= 1000 ? 'infinity' : `${+value.toFixed(2)} m`;
  const distinct = (list) => [...new Set(list)].sort((a, b) => (a === null ? -1 : a) - (b === null ? -1 : b));
  const fill = (select, options, text) => select.replaceChildren(...options.map((value, i) =>
    element('option', { value: String(i) }, text(value))));

  // Each selector offers the values that the settings have which the selectors before it leave.
  const selectors = [
    { key: 'crop', select: crop, label: cropLabel, first: () => 0,
      text: (value) => value === null ? 'any size' : `crop factor ${+value.toFixed(2)}` },
    { key: 'focal_mm', select: focal, label: focalLabel, first: () => 0, text: millimetres },
    { key: 'distance_m', select: distance, label: distanceLabel, first: (values) => values.length - 1, text: metres }];

  // The settings that all selectors leave, after those from number `from` on are filled again.
  function chosenSettings(from) {
    return selectors.reduce((settings, { key, select, label, first, text }, i) => {
      const values = distinct(settings.map((setting) => setting[key]));
      if (i >= from) {
        fill(select, values, text);
        select.selectedIndex = first(values);
        label.hidden = values.length < 2;
      }
      return settings.filter((setting) => setting[key] === values[select.selectedIndex]);
    }, shown.settings);
  }

  function draw(from) {
    const settings = chosenSettings(from).sort((a, b) => (a.aperture || 0) - (b.aperture || 0));
    const samples = 50;
    const curves = settings.map((setting) => ({ label: (setting.aperture === null ? 'any aperture' : `f/${+setting.aperture.toFixed(2)}`) +
      (setting.note ? ` ${setting.note}` : ''),
      sigma: new Array(samples + 1).fill(0), m: Array.from({ length: samples + 1 }, (_, i) => {
        const r2 = (i / samples) ** 2;
        return 1 + r2 * (setting.k[0] + r2 * (setting.k[1] + r2 * setting.k[2]));
      }) }));
    chart.replaceChildren(illuminanceChart(curves, [], `Relative illuminance of ${shown.lens || shown.camera}`),
      values(['setting', 'profile', 'k1', 'k2', 'k3', 'corner M', 'corner EV'], settings.map((setting, i) => [curves[i].label,
        String(setting.id), ...setting.k.map((k) => fixed(k, 4).replace('-', '−')), fixed(curves[i].m[samples], 3),
        signed(Math.log2(curves[i].m[samples]), 2)])));
  }

  function show(lens) {
    shown = lens;
    name.textContent = [lens.lens || 'lens not stated', lens.camera].filter((text) => text).join(' · ');
    draw(0);
  }

  function filter() {
    const words = search.value.toLowerCase().split(/\s+/).filter((word) => word);
    const matching = report.lenses.filter((lens) => {
      const text = `${lens.camera} ${lens.lens}`.toLowerCase();
      return words.every((word) => text.includes(word));
    });
    const maxListed = 200;
    list.replaceChildren(...matching.slice(0, maxListed).map((lens) => {
      const button = element('button', { type: 'button' }, lens.lens || 'lens not stated');
      button.addEventListener('click', () => { show(lens); name.scrollIntoView({ block: 'nearest' }); });
      return element('tr', {}, element('td', {}, button), element('td', {}, lens.camera || 'any camera'),
        element('td', { class: 'number' }, String(lens.settings.length)));
    }));
    found.textContent = count(matching.length, 'lens') + (matching.length > maxListed ? `; the first ${maxListed} are listed` : '');
    if (matching.length && !matching.includes(shown)) show(matching[0]);
  }

  search.addEventListener('input', filter);
  selectors.forEach(({ select }, i) => select.addEventListener('change', () => draw(i + 1)));
  page.append(section('Lenses', element('div', { class: 'filter' }, element('label', {}, 'search lens or camera', search)), found,
    element('div', { class: 'scroll lenses', tabindex: '0' }, element('table', {}, element('thead', {}, element('tr', {},
      element('th', {}, 'lens'), element('th', {}, 'camera'), element('th', { class: 'number' }, 'profiles'))), list))));
  const curves = section(null, name, element('div', { class: 'filter' }, cropLabel, focalLabel, distanceLabel), chart);
  page.append(curves);
  filter();
  page.append(cameras(report));
  appendPresent(page, closing(report));
}

// Of a white card: the pictures, and what of the light is not radial.
function card(report) {
  const { images, gain_grid: grid } = report.result;
  const percent = (share) => fixed(100 * share, 1).replace('-', '−');
  const rows = images.map((image) => [image.file, String(image.shot), signed(image.ev, 2), fixed(image.rotation_deg, 0),
    fixed(image.radius, 2), percent(image.white_share), percent(image.black_share), fixed(image.noise_levels, 2),
    fixed(100 * image.residual, 2), signed(100 * image.gradient[0], 1), signed(100 * image.gradient[1], 1)]);
  const parts = [section('Pictures of the card', element('p', { class: 'quiet' },
    'Radius: the largest that the card covers, in half diagonals. Gradient: of the light, per half diagonal.'),
    table(['picture', 'shot', 'EV', 'rotated by °', 'radius', 'white %', 'black %', 'noise, levels', 'residual %',
      'gradient right %', 'gradient down %'], rows))];
  if (grid) {
    const green = grid.attenuation[grid.attenuation.length === 3 ? 1 : 0].flat();
    const most = green.reduce((a, value) => Math.max(a, Math.abs(value - 1)), 1e-6);
    const cells = green.map((value) => ({ share: (value - 1) / most, text: fixed(value, 4) }));
    parts.push(section('Gain grid', element('p', { class: 'quiet' },
      `Light of green relative to the falloff curve. Red: more, blue: less. Full colour is ${fixed(100 * most, 2)} %.`),
      drawCells(cells, grid.columns, 'Gain grid over the frame', (cell) => cell.share > 0 ? 'red' : 'blue', 0.7)));
  }
  return parts;
}

function profilePage(report, ...more) {
  page.append(heading(report.title, report.subtitle), verdict(report));
  appendPresent(page, [sideBySide(illuminance(report), responses(report)), ...more, ...closing(report)]);
}

if (data.kind === 'database') databasePage(data);
else if (data.kind === 'profile') profilePage(data);
else if (data.kind === 'card') profilePage(data, ...card(data));
else if (data.kind === 'lens') lensPage(data);
else if (data.kind === 'units') unitsPage(data);
else if (data.kind === 'folder') folderPage(data);
else fitPage(data);
