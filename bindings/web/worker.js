// The library, on a thread of its own. A message {id, call, given} is answered by {id, result} or {id, error}.
import makeLibrary from 'library';
import compressed from 'wasm';

async function start() {
    const bytes = Uint8Array.from(atob(compressed), letter => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    return makeLibrary({wasmBinary: await new Response(stream).arrayBuffer(), locateFile: name => name});
}

/** Calls a function that answers with JSON. Arguments are numbers and strings; these may be too long for the stack. */
function ask(library, name, ...given) {
    const at = given.findIndex(value => typeof value === 'string');
    if (at >= 0) {
        return withBytes(library, new TextEncoder().encode(`${given[at]}\0`),
            address => ask(library, name, ...given.slice(0, at), address, ...given.slice(at + 1)));
    }
    const answer = JSON.parse(library.UTF8ToString(library[`_${name}`](...given)));
    if (answer.error) throw new Error(answer.error);
    return answer;
}

/** What `work` makes of the bytes of an array in the library's memory. */
function withBytes(library, array, work) {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    const address = library._malloc(Math.max(bytes.length, 1)) >>> 0;
    if (!address) throw new Error('there is not enough memory; use smaller pictures, or fewer');
    try {
        library.HEAPU8.set(bytes, address);
        return work(address);
    } finally {
        library._free(address);
    }
}

const calls = {
    version: library => library.UTF8ToString(library._page_version()),
    formats: library => ask(library, 'page_formats'),
    clearCards: library => library._page_clear_cards(),
    addCard: (library, {pixels, width, height, sample, ev, rotation}) => withBytes(library, pixels,
        address => ask(library, 'page_add_card', address, width, height, sample, ev, rotation)),
    fit: (library, options) => ask(library, 'page_fit', JSON.stringify(options)),
    import: (library, {bytes, name}) => withBytes(library, bytes,
        address => ask(library, 'page_import', address, bytes.length, name)),
    profile: (library, {index, width, height}) => ask(library, 'page_profile', index, width, height),
    setKey: (library, {index, key}) => ask(library, 'page_set_key', index, JSON.stringify(key)),
    correct: (library, {index, pixels, width, height, response, strength}) => withBytes(library, pixels, address => {
        ask(library, 'page_correct', index, address, width, height, response, strength);
        return library.HEAPU8.slice(address, address + pixels.length);
    }),
    export: (library, {index, format, width, height}) => {
        const {bytes} = ask(library, 'page_export', index, format, width, height);
        const address = library._page_file() >>> 0;
        return library.HEAPU8.slice(address, address + bytes);
    },
};

const ready = start();
self.onmessage = async ({data: {id, call, given}}) => {
    try {
        const result = calls[call](await ready, given);
        self.postMessage({id, result}, result instanceof Uint8Array ? [result.buffer] : []);
    } catch (error) {
        self.postMessage({id, error: error.message});
    }
};
