// One HTML file from the page, its worker and the library:
//     node build.mjs FOLDER OUTPUT LICENCE...
// FOLDER has library.mjs and library.wasm; the folder of a licence has the name of what is under it.
import {createHash} from 'node:crypto';
import {readFileSync, writeFileSync} from 'node:fs';
import {basename, dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';
import {build} from 'esbuild';

const here = fileURLToPath(new URL('.', import.meta.url));
const [folder, output, ...licences] = process.argv.slice(2);
const library = resolve(folder);

/** A bundle of `entry`, whose imports of the names in `texts` are these texts. */
async function bundle(entry, texts) {
    const given = {
        name: 'given',
        setup({onResolve, onLoad}) {
            onResolve({filter: /^(wasm|worker)$/}, ({path}) => ({path, namespace: 'given'}));
            onLoad({filter: /.*/, namespace: 'given'}, ({path}) => ({contents: texts[path], loader: 'text'}));
        },
    };
    const {outputFiles} = await build({
        entryPoints: [join(here, entry)], bundle: true, minify: true, write: false, format: 'iife',
        target: 'es2022', charset: 'utf8', legalComments: 'eof', plugins: [given], logLevel: 'warning',
        alias: {library: join(library, 'library.mjs')}, define: {'import.meta.url': 'self.location.href'},
    });
    return outputFiles[0].text;
}

/** What the page may run and load: its own script and style, and nothing from elsewhere. */
function policy(script, style) {
    const hash = text => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
    return `default-src 'none'; connect-src 'none'; script-src ${hash(script)} 'wasm-unsafe-eval'; `
        + `style-src ${hash(style)}; worker-src blob:; img-src blob: data:; form-action 'none'; base-uri 'none'`;
}

const escaped = text => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');
const titled = path => `--- ${basename(dirname(path))}: ${basename(path)} ---\n\n${readFileSync(path, 'utf8')}`;
const inside = licences.map(titled)
    .concat('--- emscripten ---\n\nMIT licence, as of exifr above. Copyright 2010 The Emscripten Authors\n').join('\n');
const wasm = gzipSync(readFileSync(join(library, 'library.wasm')), {level: 9}).toString('base64');
const script = await bundle('page.js', {worker: await bundle('worker.js', {wasm})});
const page = readFileSync(join(here, 'index.html'), 'utf8');
const style = page.match(/<style>([^]*?)<\/style>/)[1];
const html = page
    .replace('<pre id="licences"></pre>', () => `<pre id="licences">${escaped(inside)}</pre>`)
    .replace('<meta charset="utf-8">',
        () => `<meta charset="utf-8">\n<meta http-equiv="Content-Security-Policy" content="${policy(script, style)}">`)
    .replace('</body>', () => `<script>${script}</script>\n</body>`);
writeFileSync(output, html);
console.log(`${output}: ${(html.length / 1e6).toFixed(2)} MB`);
