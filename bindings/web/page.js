// What the page shows. Files stay in the browser: the page makes no connection, and its policy forbids any.
import {cornerText, drawChart} from './chart.js';
import {bytesOf, isPicture, readPicture} from './pictures.js';
import workerSource from 'worker';

const one = id => document.getElementById(id);
const worker = new Worker(URL.createObjectURL(new Blob([workerSource], {type: 'text/javascript'})));
const waiting = new Map();
const PREVIEW = 2000; // px of the longer side of a picture that is shown; the saved one is whole
let cards = [], frame = {width: 6000, height: 4000}, picture = null, index = -1;

worker.onmessage = ({data: {id, result, error}}) => {
    const {resolve, reject} = waiting.get(id);
    waiting.delete(id);
    if (error) reject(new Error(error));
    else resolve(result);
};

function call(name, given = {}) {
    return new Promise((resolve, reject) => {
        const id = crypto.getRandomValues(new Uint32Array(1))[0];
        waiting.set(id, {resolve, reject});
        worker.postMessage({id, call: name, given});
    });
}

/** Runs a handler; the page is busy until it ends, and states its error. */
let running = Promise.resolve();
function run(work) {
    running = running.then(async () => {
        document.body.classList.add('busy');
        one('error').textContent = '';
        try {
            await work();
        } catch (error) {
            one('error').textContent = error.message;
        }
        document.body.classList.remove('busy');
    });
    return running;
}

// ---- Camera, lens and setting ----

const TEXTS = ['maker', 'camera', 'lens'], NUMBERS = ['crop', 'focal_mm', 'aperture', 'distance_m'];

function showKey(key) {
    for (const name of [...TEXTS, ...NUMBERS]) one(name).value = key[name] ?? '';
}

function keyOfFields() {
    const key = {};
    for (const name of TEXTS) key[name] = one(name).value.trim();
    for (const name of NUMBERS) key[name] = one(name).value === '' ? null : Number(one(name).value);
    return key;
}

// ---- Cards ----

function showCards() {
    one('cards').replaceChildren(...cards.map(card => {
        const row = document.createElement('li'), turn = document.createElement('select');
        for (const degrees of [0, 90, 180, 270]) turn.add(new Option(`camera rotated by ${degrees}°`, degrees));
        turn.value = card.rotation;
        turn.setAttribute('aria-label', `rotation of ${card.name}`);
        turn.onchange = () => {
            card.rotation = Number(turn.value);
            hideResult();
        };
        row.append(`${card.name}, ${card.width} × ${card.height} `, turn);
        return row;
    }));
    one('measure').disabled = cards.length === 0;
}

/** What is shown is not of these cards any more. */
function hideResult() {
    index = -1;
    one('result').hidden = one('correction').hidden = true;
}

async function addCards(files) {
    const added = [], known = new Set(cards.map(card => card.identity));
    for (const file of files) {
        const identity = `${file.name} ${file.size} ${file.lastModified}`;
        if (known.has(identity)) continue;
        known.add(identity);
        added.push({...await readPicture(file), rotation: 0, identity});
    }
    if (added.length === 0) return;
    const first = cards[0] ?? added[0];
    const other = added.find(card => card.width !== first.width || card.height !== first.height);
    if (other) {
        throw new Error(`${other.name}: is ${other.width} × ${other.height}, but ${first.name} is ${first.width} × `
            + `${first.height}; give cards of one camera and one size`);
    }
    if (cards.length === 0) {
        showKey(first.key);
        one('response').value = first.isLinear ? 'linear' : 'typical';
    }
    cards.push(...added);
    hideResult();
    showCards();
}

async function measure() {
    await call('clearCards');
    for (const {pixels, width, height, sample, ev, rotation} of cards) {
        await call('addCard', {pixels, width, height, sample, ev, rotation});
    }
    const {usable, findings} = await call('fit', {
        key: keyOfFields(), response: one('response').value, lossy: cards.some(card => card.isLossy),
        radial: one('radial').checked,
    });
    frame = {width: cards[0].width, height: cards[0].height};
    one('entries').hidden = true;
    await showProfile(0);
    if (!usable) findings.unshift({kind: 'refusal', text: 'These pictures do not show the falloff well enough.'});
    showFindings(findings);
}

function showFindings(findings) {
    one('findings').replaceChildren(...findings.map(({kind, text}) => {
        const item = document.createElement('li');
        item.className = kind;
        item.textContent = kind === 'note' ? text : `${kind}: ${text}`;
        return item;
    }));
}

// ---- Profiles ----

function nameOf({maker, camera, lens, focal_mm: focal, aperture, distance_m: distance}) {
    const parts = [lens || camera || maker, focal && `${focal} mm`, aperture && `f/${aperture}`,
        distance && `${distance} m`];
    return parts.filter(Boolean).join(', ') || 'without a name';
}

async function openProfile(file) {
    const bytes = await bytesOf(file, file.name);
    let profiles;
    try {
        ({profiles} = await call('import', {bytes, name: file.name}));
    } catch (error) {
        throw new Error(`${file.name}: ${error.message}`);
    }
    one('entries').replaceChildren(...profiles.map((key, i) => new Option(nameOf(key), i)));
    one('entries').hidden = profiles.length < 2;
    await showProfile(0);
    showFindings([]);
}

async function showProfile(number) {
    const {key, doubt, curves} = await call('profile', {index: number, ...frame});
    const chart = drawChart(curves), corner = cornerText(curves); // before anything changes
    index = number;
    if (!one('entries').hidden) one('entries').value = number;
    showKey(key);
    one('rendering').hidden = key.rendered;
    one('corner').textContent = corner;
    one('doubt').textContent = doubt ? `Doubt: ${doubt}.` : '';
    one('chart').replaceChildren(chart);
    one('result').hidden = one('correction').hidden = false;
    if (picture) await correct();
}

async function saveProfile() {
    await call('setKey', {index, key: keyOfFields()});
    const format = one('format').value, ending = one('format').selectedOptions[0].dataset.ending;
    const bytes = await call('export', {index, format, ...frame}).catch(({message}) => {
        throw new Error(`the profile: ${message.replace(/^profile 0: /, '').replace(/set key\.\w+/, 'fill in the field')}`);
    });
    save(new Blob([bytes]), `${nameOf(keyOfFields()).replace(/[^\p{L}\p{N}.]+/gu, '-')}.${ending}`);
}

function save(blob, name) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// ---- A picture ----

function show(canvas, {pixels, width, height}) {
    canvas.width = width, canvas.height = height;
    canvas.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(pixels), width), 0, 0);
}

/** The same pixels, made smaller if they are more than are shown. */
function previewOf({pixels, width, height}) {
    const share = Math.min(1, PREVIEW / Math.max(width, height));
    if (share === 1) return {pixels, width, height};
    const whole = new OffscreenCanvas(width, height), small = new OffscreenCanvas(width * share, height * share);
    show(whole, {pixels, width, height});
    const context = small.getContext('2d');
    context.imageSmoothingQuality = 'high';
    context.drawImage(whole, 0, 0, small.width, small.height);
    return {pixels: context.getImageData(0, 0, small.width, small.height).data, width: small.width, height: small.height};
}

async function corrected({pixels, width, height}) {
    const response = one('rendered').value, strength = Number(one('strength').value) / 100;
    return {pixels: await call('correct', {index, pixels, width, height, response, strength}), width, height};
}

const correct = async () => show(one('after'), await corrected(picture.preview));

async function openPicture(file) {
    const opened = await readPicture(file);
    if (opened.sample !== 0) throw new Error(`${file.name}: has 16 or 32 bits; give JPEG, WebP, AVIF or PNG of 8 bits`);
    picture = {...opened, preview: previewOf(opened)};
    show(one('before'), picture.preview);
    one('view').hidden = one('save-picture').hidden = false;
    one('view').style.aspectRatio = `${picture.width} / ${picture.height}`;
    await correct();
}

async function savePicture() {
    const [type, ending] = picture.isLossy ? ['image/jpeg', 'jpg'] : ['image/png', 'png'];
    const canvas = new OffscreenCanvas(1, 1);
    show(canvas, await corrected(picture));
    save(await canvas.convertToBlob({type, quality: 0.95}), `${picture.name.replace(/\.[^.]*$/, '')}-corrected.${ending}`);
}

// ---- Wiring ----

async function openFiles(files) {
    const pictures = [];
    for (const file of files) {
        if (await isPicture(file)) pictures.push(file);
        else await openProfile(file);
    }
    if (pictures.length) await addCards(pictures);
}

function accept(zone, open) {
    const input = zone.querySelector('input');
    input.onchange = () => {
        const files = [...input.files];
        input.value = '';
        run(() => open(files));
    };
    zone.ondragover = event => event.preventDefault();
    zone.ondrop = event => {
        event.preventDefault();
        const files = [...event.dataTransfer.files];
        run(() => open(files));
    };
}

accept(one('open'), openFiles);
accept(one('open-picture'), files => openPicture(files[0]));
one('measure').onclick = () => run(measure);
one('clear').onclick = () => run(() => {
    cards = [];
    showKey({});
    hideResult();
    showCards();
});
one('response').onchange = () => { if (cards.length) hideResult(); };
one('entries').onchange = () => run(() => showProfile(Number(one('entries').value)));
one('strength').onchange = one('rendered').onchange = () => run(async () => { if (picture) await correct(); });
one('split').oninput = () => one('view').style.setProperty('--split', `${one('split').value}%`);
one('save-profile').onclick = () => run(saveProfile);
one('save-picture').onclick = () => run(savePicture);
showCards();
run(async () => {
    one('version').textContent = await call('version');
    for (const {name, about} of await call('formats')) {
        const option = new Option(`${name}: ${about}`, name);
        option.dataset.ending = about.match(/\.([a-z0-9]+)[,)]/i)?.[1] ?? 'txt';
        one('format').add(option);
    }
});
