// Corrects a tile of 8 bit or a frame of 16 bit RGB, packs a blob again, or looks a profile up.
//
// usage: correct.js tile BLOB FRAME_WIDTH FRAME_HEIGHT X Y WIDTH HEIGHT <pixels >corrected
//        correct.js frame BLOB WIDTH HEIGHT <pixels >corrected
//        correct.js repack BLOB >blob
//        correct.js closed DATABASE
//        correct.js lookup DATABASE MAKER MODEL LENS FOCAL_MM APERTURE
import fs from 'node:fs';

function tile({Layout, Plan}, [file, ...texts]) {
    const [frameWidth, frameHeight, x, y, width, height] = texts.map(Number);
    const plan = Plan.ofBlob(fs.readFileSync(file), {layout: Layout.RGB, width: frameWidth, height: frameHeight});
    process.stdout.write(plan.apply(fs.readFileSync(0), {x, y, width, height}));
}

function frame({Layout, Plan, Profile, SampleType}, [file, ...texts]) {
    const [width, height] = texts.map(Number);
    const profile = Profile.unpack(fs.readFileSync(file));
    const plan = Plan.ofProfile(profile, {layout: Layout.RGB, width, height, sample: SampleType.U16});
    const pixels = new Uint16Array(Uint8Array.from(fs.readFileSync(0)).buffer);
    plan.apply(pixels, {x: 0, y: 0, width, height});
    process.stdout.write(Buffer.from(pixels.buffer));
}

function repack({Profile}, [file]) {
    process.stdout.write(Profile.unpack(fs.readFileSync(file)).pack());
}

function lookup({Store}, [database, cameraMaker, cameraModel, lens, focal, aperture]) {
    const store = new Store(database);
    try {
        const focalMm = Number(focal);
        const found = store.lookup({cameraMaker, cameraModel, lens, focalMm, aperture: Number(aperture)});
        const {key, cornerFalloff} = found.profile;
        console.log(`${key.lens}, ${key.focalMm.toFixed(1)} mm, f/${key.aperture.toFixed(1)}: corner `
            + `${cornerFalloff.toFixed(4)}, profiles ${found.profiles}, exact ${Number(found.exact)}`);
    } finally {
        store.close();
    }
}

/** What a call on a closed database throws. */
function closed({Store}, [database]) {
    const store = new Store(database);
    store.close();
    store[Symbol.dispose ?? 'close'](); // as `using` calls it
    store.lookup({});
}

const [mode, ...given] = process.argv.slice(2);
try {
    const lensprof = await import('lensprof');
    if (mode === 'tile' && given.length === 7) tile(lensprof, given);
    else if (mode === 'frame' && given.length === 3) frame(lensprof, given);
    else if (mode === 'repack' && given.length === 1) repack(lensprof, given);
    else if (mode === 'closed' && given.length === 1) closed(lensprof, given);
    else if (mode === 'lookup' && given.length === 6) lookup(lensprof, given);
    else throw new Error('usage: correct.js tile|frame|repack|closed|lookup ...; see the head of correct.js');
} catch (error) {
    console.error(error.message);
    process.exitCode = 1;
}
