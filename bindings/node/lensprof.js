// Corrects pictures by profiles of lenses: blobs, plans for tiles of pixels, and the profile database.
//
//     import {Layout, Plan, Store} from 'lensprof';
//     const store = new Store('lenses.db');
//     const {profile} = store.lookup({lens: 'Acme 50mm f/1.8', focalMm: 50, aperture: 2.8});
//     const plan = Plan.ofProfile(profile, {layout: Layout.RGB, width: 640, height: 480});
//     plan.apply(pixels, {x: 0, y: 0, width: 640, height: 480}); // a Uint8Array, in place
//     store.close();
import {Layout, Processing, SampleType, Status, StoreMode, UNKNOWN} from './abi.js';
import {LensprofError, Struct, addressOf, call, check, lib, pointerBox} from './native.js';

export {Layout, LensprofError, Processing, SampleType, Status, UNKNOWN};

/** Version of the library, e.g. "0.3.0". */
export const version = () => lib.lensprof_version();

/** The result of a call that reads a blob; errors about the blob name it. */
function readBlob(blob, read) {
    try {
        return read();
    } catch (error) {
        const status = error instanceof LensprofError && blob.length === 0 ? Status.ERROR_CORRUPT : error.status;
        const text = {
            [Status.ERROR_LAYOUT]: 'written by a newer lensprof; update this library',
            [Status.ERROR_CORRUPT]: 'not a blob, or damaged; export it again',
        }[status];
        throw text ? new LensprofError(status, `profile blob of ${blob.length} bytes: ${text}`) : error;
    }
}

/** Members of a key in JavaScript and in C. Unknown texts are empty, unknown numbers UNKNOWN. */
const TEXTS = {cameraMaker: 'camera_maker', cameraModel: 'camera_model', lens: 'lens'};
const NUMBERS = {cropFactor: 'crop_factor', focalMm: 'focal_mm', aperture: 'aperture', distanceM: 'distance_m',
    processing: 'processing'};

function rawKey(key) {
    const raw = new Struct('lensprof_profile_key');
    for (const [name, value] of Object.entries(key)) {
        if (name in TEXTS) {
            const room = raw.type.members[TEXTS[name]].type.length;
            if (value.includes('\0') || Buffer.byteLength(value) >= room) {
                throw new LensprofError(Status.ERROR_ARGUMENT,
                    `"${value}": has a zero, or more than ${room - 1} bytes; shorten it`);
            }
            raw.set({[TEXTS[name]]: value});
        } else if (name in NUMBERS) {
            raw.set({[NUMBERS[name]]: value});
        } else {
            throw new TypeError(`${name} is not a member of a key: ${Object.keys({...TEXTS, ...NUMBERS}).join(', ')}`);
        }
    }
    return raw;
}

/** Response and falloff of one camera, lens and setting: 50 kB. */
export class Profile {
    constructor() {
        this._raw = new Struct('lensprof_profile');
    }

    /** The profile of a blob, a Buffer or Uint8Array. */
    static unpack(blob) {
        const profile = new Profile();
        readBlob(blob, () => check(lib.lensprof_profile_unpack(blob, blob.length, profile._raw.bytes),
            () => 'the blob cannot be unpacked'));
        return profile;
    }

    /** The profile as a blob, without covariance. */
    pack() {
        const pack = (data, capacity) => check(lib.lensprof_profile_pack(this._raw.bytes, 0, data, capacity, count),
            () => 'this profile: has values out of range; make it again');
        const count = new BigUint64Array(1);
        pack(null, 0);
        const blob = Buffer.alloc(Number(count[0]));
        pack(blob, blob.length);
        return blob;
    }

    /** Camera, lens and setting. */
    get key() {
        const raw = this._raw.member('key', 'lensprof_profile_key');
        const members = Object.entries({...TEXTS, ...NUMBERS});
        return Object.fromEntries(members.map(([name, field]) => [name, raw.get(field)]));
    }

    /** Relative illuminance of green in the corner, or of all channels. */
    get cornerFalloff() {
        return lib.lensprof_profile_radial_falloff(this._raw.bytes, 1, 1, null);
    }
}

function sampleType(pixels) {
    if (pixels instanceof Uint8Array || pixels instanceof Uint8ClampedArray) return SampleType.U8;
    if (pixels instanceof Uint16Array) return SampleType.U16;
    if (pixels instanceof Float32Array) return SampleType.F32;
    throw new TypeError('pixels are a Uint8Array, Uint8ClampedArray, Uint16Array or Float32Array');
}

/** Corrects falloff in the pixels of frames of one size. Immutable; needs no close. */
export class Plan {
    /** frame: {layout, width, height, sample}; sample: SampleType.U8 if not given. */
    static ofProfile(profile, frame) {
        const options = frameOptions(frame);
        check(lib.lensprof_apply_options_set_profile(options.bytes, profile._raw.bytes),
            () => 'this profile: cannot be applied');
        return new Plan(options, frame.layout, profile);
    }

    /** The same of a blob, which is read in place. */
    static ofBlob(blob, frame) {
        const options = frameOptions(frame).set({blob: addressOf(blob), blob_bytes: blob.length});
        return readBlob(blob, () => new Plan(options, frame.layout, blob));
    }

    /** For ofProfile and ofBlob. source: what the options point to, until the plan is made. */
    constructor(options, layout, source) {
        this._source = source;
        this._layout = layout;
        this._memory = new BigUint64Array(Math.ceil(Number(lib.lensprof_plan_bytes(options.bytes)) / 8) + 1);
        const plan = pointerBox();
        call('lensprof_plan_init', this._memory, this._memory.byteLength, options.bytes, plan.box);
        this._plan = plan.value();
        this._source = null;
    }

    /** Corrects a tile {x, y, width, height} in place. Its rows follow each other without gaps. Returns the pixels. */
    apply(pixels, {x, y, width, height}) {
        const row = width * lib.lensprof_layout_samples(this._layout);
        const target = new Struct('lensprof_target').set({data: addressOf(pixels), width, height,
            row_bytes: row * pixels.BYTES_PER_ELEMENT, sample: sampleType(pixels), layout: this._layout});
        const fits = row * height === pixels.length;
        check(fits ? lib.lensprof_apply(this._plan, null, target.bytes, x, y) : Status.ERROR_SIZE,
            () => `${pixels.length} samples for ${width} x ${height} px at (${x}, ${y}): the tile must fit the frame `
                + 'and the pixels');
        return pixels;
    }
}

function frameOptions({layout, width, height, sample = SampleType.U8}) {
    return new Struct('lensprof_apply_options').set({frame_width: width, frame_height: height, source_layout: layout,
        source_sample: sample, target_sample: sample});
}

/** An open profile database, which is only read. Close it, or declare it with `using`. */
export class Store {
    /** Opens a database that exists. */
    constructor(file) {
        if (file.includes('\0')) {
            throw new LensprofError(Status.ERROR_ARGUMENT, `${file}: has a zero; no file has such a name`);
        }
        const store = pointerBox();
        call('lensprof_store_open', file, StoreMode.READ, store.box);
        this._store = store.value();
    }

    /**
     * The profile for a setting: a stored one, or composed of the lens's falloffs at other settings and the camera's
     * response. Throws ERROR_NOT_FOUND, with the reason, if nothing is near enough. key: cameraMaker, cameraModel,
     * lens, cropFactor, focalMm, aperture, distanceM, processing; what is not given is unknown.
     */
    lookup(key) {
        if (!this._store) throw new LensprofError(Status.ERROR_ARGUMENT, 'this store is closed; open it again');
        const profile = new Profile(), how = new Struct('lensprof_lookup');
        const store = new BigUint64Array([BigInt(this._store)]);
        call('lensprof_store_lookup_in', store, 1, rawKey(key).bytes, null, profile._raw.bytes, how.bytes);
        return {profile, exact: how.get('exact') === 1, profiles: how.get('rows'), sigma: how.get('sigma'),
            reason: how.get('reason')};
    }

    /** May be called twice. */
    close() {
        if (this._store) lib.lensprof_store_close(this._store);
        this._store = null;
    }
}
if (Symbol.dispose) Store.prototype[Symbol.dispose] = Store.prototype.close;
