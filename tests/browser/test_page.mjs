// The page in a browser: what it measures, corrects and saves is what the program does; nothing leaves the machine.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {decode} from 'fast-png';
import {give, idle, lensprof, openPage, press, read, removeFolder, saved, set, startBrowser, textOf, write,
    writeCard} from './support.mjs';

let browser, page;
before(async () => {
    browser = await startBrowser();
    lensprof('simulate', '-o', 'scene', '--images', '2', '--size', '320x240', '--format', 'jpeg', '--exif');
    write('pcalib.txt', Array.from({length: 256}, (_, i) => i).join(' '));
    writeCard('card.png', {width: 600, height: 400});
    writeCard('second.png', {width: 600, height: 400, seed: 2, slope: 0.05});
    writeCard('linear16.png', {width: 600, height: 400, depth: 16, gamma: 1, seed: 3});
    writeCard('large.png', {width: 3400, height: 2300, seed: 4});
});
after(async () => {
    await browser.close();
    removeFolder();
});
test.beforeEach(async () => { page = await openPage(browser); });
test.afterEach(async () => {
    assert.deepEqual(page.faults, []);
    assert.deepEqual(page.requested.filter(url => !/^(file|blob|data):/.test(url)), []);
    await page.close();
});

/** Light in the corner and its error, as the page states them. */
async function corner() {
    const [, light, sigma] = (await textOf(page, 'corner')).match(/^([\d.]+) % ± ([\d.]+) %/);
    return {light: Number(light) / 100, sigma: Number(sigma) / 100};
}

async function nameLens() {
    for (const [id, value] of Object.entries({maker: 'Acme', camera: 'One', lens: 'Acme 35mm f/2', crop: '1.5',
        focal_mm: '35', aperture: '2'})) await set(page, id, value);
}

const falloffOf = xml => ['k1', 'k2', 'k3'].map(name => Number(xml.match(new RegExp(`${name}="([^"]+)"`))[1]));

async function measured(response, ...names) {
    await give(page, 'open', ...names);
    await set(page, 'response', response);
    await nameLens();
    await press(page, 'measure');
    assert.equal(await textOf(page, 'error'), '');
}

for (const {name, response, words} of [
    {name: 'card.png', response: 'gamma:2.2', words: ['--fit', 'gamma=2.2']},
    {name: 'linear16.png', response: 'linear', words: ['--linear']},
]) {
    test(`${name} gives the falloff that the program gives`, async () => {
        await measured(response, name);
        const {light, sigma} = await corner();
        assert.ok(Math.abs(light - 0.6) < Math.max(0.006, 3 * sigma), `${light}, true 0.6`);
        await set(page, 'format', 'lensfun');
        const file = await saved(page, 'save-profile');
        assert.match(file, /Acme-35mm-f-2-35-mm-f-2.*\.xml$/);
        lensprof('flat', name, ...words, '--no-store', '-o', 'own.xml', '--camera', 'One', '--lens', 'Acme 35mm f/2',
            '--focal', '35', '--aperture', '2', '--key', 'maker=Acme', '--key', 'crop-factor=1.5');
        const found = falloffOf(read(file).toString()), expected = falloffOf(read('own.xml').toString());
        found.forEach((k, i) => assert.ok(Math.abs(k - expected[i]) < 1e-9, `${found}, the program: ${expected}`));
    });
}

test('two cards with light of their own', async () => {
    await measured('gamma:2.2', 'card.png', 'second.png');
    assert.ok(Math.abs((await corner()).light - 0.6) < 0.01);
});

test('a card that is reduced', async () => {
    await measured('gamma:2.2', 'large.png');
    assert.ok(Math.abs((await corner()).light - 0.6) < 0.005);
});

test('a typical response is stated as a doubt, and its error is that of the light', async () => {
    await measured('typical', 'card.png');
    assert.match(await textOf(page, 'doubt'), /response not shown/);
    const {light, sigma} = await corner();
    assert.ok(sigma > 0.02 && Math.abs(light - 0.6) < 3 * sigma, `${light} ± ${sigma}`);
});

test('a saved profile corrects a picture in the page and in the program to the same bytes', async () => {
    await measured('gamma:2.2', 'card.png');
    await set(page, 'format', 'json');
    const profile = await saved(page, 'save-profile');
    writeCard('picture.png', {width: 512, height: 384, level: 0.9, seed: 5, slope: 0.4});
    await give(page, 'open-picture', 'picture.png');
    const picture = await saved(page, 'save-picture');
    assert.match(picture, /picture-corrected\.png$/);
    lensprof('profile', 'import', '--db', 'own.db', profile);
    lensprof('apply', 'picture.png', '--db', 'own.db', '--profile', '1', '-o', 'corrected');
    const found = decode(read(picture)), own = decode(read('corrected/picture.png'));
    assert.equal(found.channels, 4);
    const rgb = found.data.filter((_, i) => i % 4 !== 3);
    assert.deepEqual(Buffer.from(rgb), Buffer.from(own.data));
});

test('what is shown is of the cards that are listed', async () => {
    await measured('gamma:2.2', 'card.png');
    const isShown = () => page.$eval('#result', element => !element.hidden);
    assert.ok(await isShown());
    await set(page, 'response', 'srgb');
    assert.ok(!await isShown());
    await press(page, 'measure');
    await give(page, 'open', 'card.png'); // the same file again
    assert.ok(await isShown());
    await press(page, 'clear');
    assert.ok(!await isShown());
    assert.deepEqual(await page.$$eval('input:not([type])', fields => fields.map(field => field.value)), ['', '', '']);
});

test('a lens without a name cannot be saved for Lensfun, and the page names its field', async () => {
    await give(page, 'open', 'card.png');
    await press(page, 'measure');
    await set(page, 'format', 'lensfun');
    await press(page, 'save-profile');
    assert.equal(await textOf(page, 'error'), 'the profile: its lens is unknown; fill in the field');
});

test('a large picture is shown smaller, and saved whole', async () => {
    await measured('gamma:2.2', 'card.png');
    await give(page, 'open-picture', 'large.png');
    assert.deepEqual(await page.$eval('#after', canvas => [canvas.width, canvas.height]), [2000, 1352]);
    const {width, height} = decode(read(await saved(page, 'save-picture')));
    assert.deepEqual([width, height], [3400, 2300]);
});

test('a profile file: its entries, their falloff, a picture', async () => {
    await measured('gamma:2.2', 'card.png');
    await set(page, 'format', 'lensfun');
    const first = await saved(page, 'save-profile');
    const xml = read(first).toString(), line = xml.match(/<vignetting[^>]*>/)[0];
    const other = line.replace('aperture="2"', 'aperture="4"').replace(/k1="[^"]*"/, 'k1="-0.1"');
    write('more.xml', xml.replace(line, `${line}\n${other}`));
    await page.reload();
    await idle(page);
    await give(page, 'open', 'more.xml');
    assert.equal(await textOf(page, 'error'), '');
    const entries = await page.$$eval('#entries option', options => options.map(option => option.textContent));
    const wider = await textOf(page, 'corner');
    await set(page, 'entries', `${entries.findIndex(entry => entry.includes('f/4'))}`);
    assert.notEqual(await textOf(page, 'corner'), wider);
    assert.equal(await page.$eval('#aperture', field => field.value), '4');
    await give(page, 'open-picture', 'scene/img000.jpg');
    assert.deepEqual(await page.$eval('#after', canvas => [canvas.width, canvas.height]), [320, 240]);
    await press(page, 'save-picture');
});

test('each format is written, and the program reads it', async () => {
    await measured('gamma:2.2', 'card.png');
    const formats = await page.$$eval('#format option', options => options.map(option => option.value));
    for (const name of ['lensfun', 'lcp', 'json', 'blob', 'glsl', 'wgsl', 'c', 'cube', 'pcalib']) {
        assert.ok(formats.includes(name), name);
    }
    for (const format of formats) {
        await set(page, 'format', format);
        const name = await saved(page, 'save-profile');
        assert.ok(read(name).length > 100, format);
        if (['lensfun', 'lcp', 'json', 'blob'].includes(format)) {
            lensprof('profile', 'import', '--db', `${format}.db`, name);
        }
    }
});

/** A JPEG with an EXIF orientation of 90 degrees. */
function turned(jpeg) {
    const exif = Buffer.concat([Buffer.from([0xff, 0xe1, 0, 34]),
        Buffer.from('Exif\0\0MM\0*\0\0\0\x08\0\x01', 'latin1'),
        Buffer.from([1, 0x12, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0])]);
    return Buffer.concat([jpeg.subarray(0, 2), exif, jpeg.subarray(2)]);
}

test('the frame is that of the sensor, whatever the orientation', async () => {
    write('turned.jpg', turned(read('scene/img000.jpg')));
    await give(page, 'open', 'turned.jpg');
    assert.match(await textOf(page, 'cards'), /turned\.jpg, 320 × 240/);
});

test('EXIF fills the fields', async () => {
    await give(page, 'open', 'scene/img000.jpg');
    assert.equal(await textOf(page, 'error'), '');
    const camera = await page.$eval('#camera', field => field.value);
    assert.ok(camera.length > 0);
    assert.equal(await page.$eval('#response', field => field.value), 'typical');
});

test('the page may not connect to anything', async () => {
    const refused = await page.evaluate(() => fetch('https://example.org/').then(() => false, () => true));
    assert.ok(refused); // by the policy: a request would stand in page.requested
});

test('bad input: one sentence that names the file, and the page as before', async () => {
    await measured('gamma:2.2', 'card.png');
    const stated = await textOf(page, 'corner');
    await set(page, 'format', 'blob');
    const blob = Buffer.from(read(await saved(page, 'save-profile')));
    const newer = Buffer.from(blob), damaged = Buffer.from(blob);
    newer[4] = 99;
    damaged[damaged.length - 9] ^= 1;
    writeCard('small.png', {width: 300, height: 200});
    const bad = {
        'empty.xml': Buffer.alloc(0), 'notes.txt': Buffer.from('a shopping list'),
        'half.xml': Buffer.from('<lensdatabase><lens><model>Half'),
        'truncated.jpg': read('scene/img000.jpg').subarray(0, 700),
        'truncated.png': read('linear16.png').subarray(0, 2000), 'newer.blob': newer, 'damaged.blob': damaged,
        'response.txt': read('pcalib.txt'),
        'half.tif': Buffer.from('II*\0\x08\0\0\0\xff\xff', 'latin1'), 'small.png': read('small.png'),
        'no-falloff.xml': Buffer.from('<lensdatabase version="1"><lens><maker>A</maker><model>B</model></lens>'
            + '</lensdatabase>'),
    };
    for (const [name, bytes] of Object.entries(bad)) {
        write(name, bytes);
        await give(page, 'open', name);
        const error = await textOf(page, 'error');
        assert.ok(error.startsWith(`${name}: `), `${name}: ${error}`);
        assert.ok(error.length > name.length + 10 && !/undefined|\[object|internal/.test(error), error);
        assert.equal(await textOf(page, 'corner'), stated);
        assert.match(await textOf(page, 'cards'), /^card\.png, 600 × 400/);
    }
    await give(page, 'open-picture', 'truncated.jpg');
    assert.ok((await textOf(page, 'error')).startsWith('truncated.jpg: '));
    await give(page, 'open-picture', 'linear16.png');
    assert.match(await textOf(page, 'error'), /^linear16\.png: has 16 or 32 bits/);
    await set(page, 'aperture', '-1');
    await press(page, 'save-profile');
    assert.match(await textOf(page, 'error'), /aperture/);
});
