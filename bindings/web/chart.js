// The falloff as a chart: light against the distance from the middle of the frame, with its standard error.
const NAME = 'http://www.w3.org/2000/svg';
const WIDTH = 640, HEIGHT = 320, LEFT = 56, RIGHT = 16, TOP = 16, BOTTOM = 44;
const CHANNELS = ['red', 'green', 'blue'];

function element(name, attributes, text = '') {
    const made = document.createElementNS(NAME, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
}

const x = r => LEFT + r * (WIDTH - LEFT - RIGHT);

function axes(y, top) {
    const marks = [];
    for (let light = 0; light <= top + 1e-9; light += 0.2) {
        marks.push(element('line', {x1: x(0), x2: x(1), y1: y(light), y2: y(light), class: 'grid'}));
        marks.push(element('text', {x: LEFT - 8, y: y(light) + 4, 'text-anchor': 'end'},
            `${Math.round(100 * light)} %`));
    }
    for (let r = 0; r <= 1.001; r += 0.25) {
        marks.push(element('text', {x: x(r), y: HEIGHT - 24, 'text-anchor': 'middle'}, r.toFixed(2)));
    }
    marks.push(element('text', {x: x(0.5), y: HEIGHT - 6, 'text-anchor': 'middle'},
        'distance from the middle of the frame, half diagonals'));
    return marks;
}

function curve(points, y, name) {
    const place = ([r, light]) => `${x(r).toFixed(2)},${y(light).toFixed(2)}`;
    const marks = [element('polyline', {points: points.map(place).join(' '), class: `curve ${name}`})];
    if (points.every(([, , sigma]) => sigma !== null)) {
        const edge = sign => points.map(([r, light, sigma]) => place([r, light + sign * sigma]));
        const around = [...edge(1), ...edge(-1).reverse()].join(' ');
        marks.unshift(element('polygon', {points: around, class: `band ${name}`}));
    }
    return marks;
}

/** An SVG of the curves of page_profile: one for all channels, or three. */
export function drawChart(curves) {
    const top = Math.max(1, ...curves.flat().map(([, light]) => light)) * 1.04;
    const y = light => HEIGHT - BOTTOM - (light / top) * (HEIGHT - TOP - BOTTOM);
    const chart = element('svg', {viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': 'falloff'});
    chart.append(...axes(y, top));
    curves.forEach((points, i) => chart.append(...curve(points, y, curves.length === 3 ? CHANNELS[i] : 'all')));
    return chart;
}

/** "63.2 % ± 0.4 % of the light in the corner (0.66 EV)", per channel where they differ. */
export function cornerText(curves) {
    return curves.map((points, i) => {
        if (points.length === 0) return 'The image circle has no light at the middle of the frame';
        const [r, light, sigma] = points.at(-1);
        const place = r > 0.999 ? 'in the corner' : `at ${r.toFixed(2)} half diagonals`;
        const error = sigma === null ? '' : ` ± ${(100 * sigma).toFixed(sigma < 0.001 ? 2 : 1)} %`;
        const channel = curves.length === 3 ? `${CHANNELS[i]}: ` : '';
        const loss = `${(-Math.log2(light)).toFixed(2)} EV`;
        return `${channel}${(100 * light).toFixed(1)} %${error} of the light ${place} (${loss})`;
    }).join('; ');
}
