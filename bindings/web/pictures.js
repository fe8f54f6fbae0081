// Picture files as pixels, and what their EXIF states. The browser decodes JPEG, PNG, WebP and AVIF; libraries decode
// TIFF and PNG of 16 bits. Colour profiles and orientation are ignored, so that the frame is that of the sensor and
// values are those of the file.
import exifr from 'exifr/dist/full.esm.mjs';
import {decode as decodePng, hasPngSignature} from 'fast-png';
import {decode as decodeTiff} from 'tiff';

/** lensprof_sample_type of an array of samples. */
const SAMPLES = new Map([[Uint8Array, 0], [Uint8ClampedArray, 0], [Uint16Array, 1], [Float32Array, 2]]);

const isJpeg = bytes => bytes[0] === 0xff && bytes[1] === 0xd8;
const isPng16 = bytes => hasPngSignature(bytes) && bytes[24] === 16;
const isTiff = bytes => ['II*\0', 'MM\0*'].includes(String.fromCharCode(...bytes.subarray(0, 4)));

/** The bytes of a file, or of a part of it. */
export async function bytesOf(blob, name) {
    try {
        return new Uint8Array(await blob.arrayBuffer());
    } catch {
        throw new Error(`${name}: cannot be read; if it is a folder, drop the files in it`);
    }
}

/** Whether a file is a picture, by its first bytes; JPEG, PNG, TIFF, WebP and AVIF are. */
export async function isPicture(file) {
    const bytes = await bytesOf(file.slice(0, 32), file.name);
    const at = (offset, text) => String.fromCharCode(...bytes.subarray(offset, offset + text.length)) === text;
    return isJpeg(bytes) || hasPngSignature(bytes) || isTiff(bytes) || at(8, 'WEBP') || at(4, 'ftypavif');
}

/** A JPEG without its EXIF, whose orientation browsers apply. */
function withoutExif(bytes) {
    const parts = [bytes.subarray(0, 2)];
    let at = 2;
    while (at + 4 <= bytes.length && bytes[at] === 0xff && bytes[at + 1] !== 0xda) {
        const end = at + 2 + bytes[at + 2] * 256 + bytes[at + 3];
        if (bytes[at + 1] !== 0xe1) parts.push(bytes.subarray(at, end));
        at = end;
    }
    return new Blob([...parts, bytes.subarray(at)], {type: 'image/jpeg'});
}

/** Grey, grey with alpha, RGB or RGBA samples as RGBA. */
function toRgba({width, height, data, channels}) {
    const opaque = data instanceof Float32Array ? 1 : data instanceof Uint16Array ? 65535 : 255;
    const rgba = new data.constructor(width * height * 4);
    const colours = channels < 3 ? [0, 0, 0] : [0, 1, 2];
    for (let from = 0, to = 0; to < rgba.length; from += channels, to += 4) {
        for (let c = 0; c < 3; c++) rgba[to + c] = data[from + colours[c]];
        rgba[to + 3] = channels % 2 ? opaque : data[from + channels - 1];
    }
    return rgba;
}

function decodedTiff(bytes) {
    const page = decodeTiff(bytes)[0];
    if (page.get('NewSubfileType') & 1) throw new Error('camera raw: only its preview can be decoded; develop it first');
    if (!SAMPLES.has(page.data.constructor)) throw new Error(`samples of ${page.bitsPerSample} bits`);
    return {width: page.width, height: page.height, data: page.data, channels: page.samplesPerPixel};
}

async function decodedByBrowser(blob) {
    const bitmap = await createImageBitmap(blob, {colorSpaceConversion: 'none', premultiplyAlpha: 'none'});
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext('2d', {willReadFrequently: true});
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
    const {width, height, data} = context.getImageData(0, 0, canvas.width, canvas.height);
    return {width, height, data, channels: 4};
}

const positive = value => (Number.isFinite(value) && value > 0 ? value : null);

/** Camera, lens, setting and exposure of a file, as far as EXIF states them. */
async function metadataOf(bytes) {
    let exif;
    try {
        exif = await exifr.parse(bytes) ?? {};
    } catch { // has none that can be read
        exif = {};
    }
    const text = value => (typeof value === 'string' ? value.replaceAll('\0', '').trim() : '');
    const focal = positive(exif.FocalLength), aperture = positive(exif.FNumber);
    const equivalent = positive(exif.FocalLengthIn35mmFormat), time = positive(exif.ExposureTime);
    return {
        key: {
            maker: text(exif.Make), camera: text(exif.Model), lens: text(exif.LensModel),
            crop: focal && equivalent ? Math.round(100 * equivalent / focal) / 100 : null,
            focal_mm: focal, aperture, distance_m: positive(exif.SubjectDistance),
        },
        ev: time ? Math.log2(time * (positive(exif.ISO) ?? 100) / 100 / (aperture ?? 1) ** 2) : 0,
    };
}

/** {name, width, height, sample, pixels, isLossy, isLinear, key, ev}: pixels are RGBA; isLinear is a guess. */
export async function readPicture(file) {
    const bytes = await bytesOf(file, file.name);
    try {
        const decoded = isTiff(bytes) ? decodedTiff(bytes)
            : isPng16(bytes) ? decodePng(bytes)
                : await decodedByBrowser(isJpeg(bytes) ? withoutExif(bytes) : file);
        const pixels = decoded.channels === 4 ? decoded.data : toRgba(decoded);
        const sample = SAMPLES.get(pixels.constructor);
        return {
            name: file.name, width: decoded.width, height: decoded.height, sample, pixels,
            isLossy: !isTiff(bytes) && !hasPngSignature(bytes), isLinear: sample > 0, ...await metadataOf(bytes),
        };
    } catch (error) {
        throw new Error(`${file.name}: cannot be read as a picture (${error.message}); `
            + 'give JPEG, PNG, TIFF, WebP or AVIF');
    }
}
