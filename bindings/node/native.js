// The shared library: finding it, types and functions from the tables of abi.js, structures in memory, and errors.
//
// Search order: the file named by the environment variable LENSPROF_LIBRARY, the folder of this package, the system's
// loader. A structure is a Buffer of its size; its members are read and written where they lie.
import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import koffi from 'koffi';
import * as abi from './abi.js';

/** The library refused a call or failed. status: a number of Status. text: a sentence that names the next step. */
export class LensprofError extends Error {
    constructor(status, text) {
        super(`${text} (${nameOf(status)})`);
        this.name = 'LensprofError';
        this.status = status;
        this.text = text;
    }
}

function nameOf(status) {
    const found = Object.entries(abi.Status).find(([, value]) => value === status);
    return found ? `LENSPROF_${found[0]}` : 'unknown status';
}

function fileNames() {
    if (process.platform === 'win32') return ['lensprof.dll'];
    if (process.platform === 'darwin') return ['liblensprof.0.3.dylib', 'liblensprof.dylib'];
    return ['liblensprof.so.0.3', 'liblensprof.so'];
}

function load() {
    const named = process.env.LENSPROF_LIBRARY;
    const folder = path.dirname(fileURLToPath(import.meta.url));
    const beside = fileNames().map((name) => path.join(folder, name)).filter((file) => fs.existsSync(file));
    let cause;
    for (const file of named ? [named] : [...beside, ...fileNames()]) {
        try {
            return checked(koffi.load(file), file);
        } catch (error) {
            if (error instanceof LensprofError) throw error;
            cause = error;
        }
    }
    const text = named ? `LENSPROF_LIBRARY=${named}: cannot be loaded; correct or unset it`
        : `the lensprof library is not installed; install it or set LENSPROF_LIBRARY to the file ${fileNames()[0]}`;
    throw new Error(text, {cause});
}

/** While the major version is 0, structures may change with the minor one. */
function checked(library, file) {
    const version = library.func('lensprof_version', 'str', [])();
    const minor = (text) => text.split('.').slice(0, 2).join('.');
    if (minor(version) !== minor(abi.VERSION)) {
        throw new LensprofError(abi.Status.ERROR_UNSUPPORTED,
            `${file}: is lensprof ${version}, but this package is for ${abi.VERSION}; install the two together`);
    }
    return library;
}

/** Types of koffi by their name in C. They have no names in koffi, whose names are global. */
const types = Object.fromEntries(['int32_t', 'int64_t', 'uint8_t', 'uint16_t', 'uint32_t', 'uint64_t', 'size_t', 'char',
    'int', 'float', 'double', 'void'].map((name) => [name, name]));
types.ptrdiff_t = 'intptr_t';

/** The type of a text of abi.js: a name, then * for a pointer and [n] for an array. */
function typeOf(text) {
    if (text === 'char*') return 'str';
    if (text.endsWith('*')) return 'void *';
    const array = text.match(/^(.*)\[(\d+)\]$/);
    return array ? koffi.array(typeOf(array[1]), Number(array[2])) : types[text];
}

for (const [kind, name, of] of abi.TYPES) {
    if (kind === 'struct') {
        const fields = Object.entries(of).map(([field, text]) => [field, typeOf(text)]);
        types[name] = koffi.struct(Object.fromEntries(fields));
    } else if (kind === 'callback') {
        types[name] = 'void *';
    }
}

const library = load();

/** The exported functions, by their names in C; each is made when it is used first. */
export const lib = new Proxy({}, {
    get(made, name) {
        if (!(name in made)) {
            const [result, parameters] = abi.FUNCTIONS[name];
            made[name] = library.func(name, typeOf(result), parameters.map(typeOf));
        }
        return made[name];
    },
});

/** A structure in memory: zero, or with the defaults of its _init function. */
export class Struct {
    constructor(name) {
        this.type = types[name];
        this.bytes = Buffer.alloc(koffi.sizeof(this.type));
        if (name in abi.INITS) {
            const [init, sizes] = abi.INITS[name];
            lib[init](this.bytes, ...sizes.map((of) => koffi.sizeof(types[of])));
        }
    }

    get(field) {
        const {offset, type} = this.type.members[field];
        return koffi.decode(this.bytes, offset, type);
    }

    set(fields) {
        for (const [field, value] of Object.entries(fields)) {
            const {offset, type} = this.type.members[field];
            koffi.encode(this.bytes, offset, type, value);
        }
        return this;
    }

    /** Another structure that is a member of this one; both share memory. */
    member(field, name) {
        const {offset} = this.type.members[field];
        const part = Object.create(Struct.prototype);
        part.type = types[name];
        part.bytes = this.bytes.subarray(offset, offset + koffi.sizeof(part.type));
        return part;
    }
}

/** A function that ends in a pointer to lensprof_error: throws its text. */
export function call(name, ...values) {
    const error = new Struct('lensprof_error');
    check(lib[name](...values, error.bytes), () => error.get('text'));
}

export function check(status, text) {
    if (status !== abi.Status.OK) throw new LensprofError(status, text());
}

/** Memory for a pointer that a function sets, and the pointer. */
export function pointerBox() {
    const box = Buffer.alloc(koffi.sizeof('void *'));
    return {box, value: () => koffi.decode(box, 'void *')};
}

export const addressOf = (bytes) => koffi.address(bytes);
export const typeMembers = (name) => ({size: koffi.sizeof(types[name]), alignment: koffi.alignof(types[name]),
    members: types[name].members});
