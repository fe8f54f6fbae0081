// Shared by the tests of the page: the browser, files to give to it, and the program to compare with.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {basename, join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {encode} from 'fast-png';
import puppeteer from 'puppeteer-core';

export const folder = mkdtempSync(join(tmpdir(), 'lensprof-browser-'));
const program = process.env.LENSPROF;

/** Runs the program in the folder of the test. */
export const lensprof = (...words) => execFileSync(program, words, {cwd: folder, encoding: 'utf8', stdio: 'pipe'});

export async function startBrowser() {
    return puppeteer.launch({
        executablePath: process.env.CHROMIUM, headless: true,
        args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--enable-unsafe-webgpu',
            '--use-webgpu-adapter=swiftshader'],
    });
}

export const removeFolder = () => rmSync(folder, {recursive: true});

/** The page, opened from its file, with the addresses that it asked for and the faults that it reported. */
export async function openPage(browser) {
    const page = await browser.newPage();
    page.requested = [], page.faults = [];
    page.on('request', request => page.requested.push(request.url()));
    page.on('pageerror', error => page.faults.push(error.message));
    await page.goto(pathToFileURL(process.env.PAGE).href);
    await idle(page);
    return page;
}

/** Waits until the page has done what it was asked for. */
export async function idle(page) {
    await page.waitForFunction('!document.body.classList.contains("busy")', {timeout: 60000});
    await page.waitForFunction('document.getElementById("version").textContent');
}

/** Gives files to a drop zone. */
export async function give(page, zone, ...names) {
    const input = await page.$(`#${zone} input`);
    await input.uploadFile(...names.map(name => join(folder, name)));
    await new Promise(done => setTimeout(done, 50));
    await idle(page);
}

export async function press(page, id) {
    await page.evaluate(name => document.getElementById(name).click(), id);
    await new Promise(done => setTimeout(done, 50));
    await idle(page);
}

export const textOf = (page, id) => page.$eval(`#${id}`, element => element.textContent);

export async function set(page, id, value) {
    await page.$eval(`#${id}`, (element, given) => {
        element.value = given;
        element.dispatchEvent(new Event('change'));
    }, value);
    await idle(page);
}

/** Presses a button that saves a file; its path in the folder of the test. */
export async function saved(page, button) {
    const downloads = mkdtempSync(join(folder, 'saved-'));
    const session = await page.createCDPSession();
    await session.send('Browser.setDownloadBehavior', {behavior: 'allow', downloadPath: downloads});
    await press(page, button);
    for (let i = 0; i < 100; i++) {
        const name = readdirSync(downloads).find(file => !file.endsWith('.crdownload'));
        if (name) return join(basename(downloads), name);
        await new Promise(done => setTimeout(done, 50));
    }
    throw new Error(`${button}: saved no file (${await textOf(page, 'error')})`);
}

export const read = name => readFileSync(join(folder, name));
export const write = (name, bytes) => writeFileSync(join(folder, name), bytes);

/** Numbers of a seed, with mean 0 and variance 1. */
function* noise(seed) {
    for (let state = seed; ;) {
        let sum = -6;
        for (let i = 0; i < 12; i++) {
            state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
            sum += state / 2 ** 32;
        }
        yield sum;
    }
}

/** Writes a card as PNG: light `level` in the middle, falloff 1 + k1 r^2 + k2 r^4, noise, encoded with a gamma. */
export function writeCard(name, {width, height, k = [-0.3, -0.1], level = 0.6, gamma = 2.2, depth = 8, seed = 1,
    slope = 0}) {
    const full = 2 ** depth - 1, random = noise(seed);
    const data = new (depth === 8 ? Uint8Array : Uint16Array)(width * height * 3);
    for (let y = 0, to = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
            const u = x - (width - 1) / 2, v = y - (height - 1) / 2;
            const r2 = 4 * (u * u + v * v) / (width ** 2 + height ** 2);
            const light = level * (1 + slope * u / width) * (1 + k[0] * r2 + k[1] * r2 * r2);
            for (let c = 0; c < 3; c++) {
                const value = light ** (1 / gamma) * (1 + 0.01 * random.next().value);
                data[to++] = Math.max(0, Math.min(full, Math.round(full * value)));
            }
        }
    }
    write(name, encode({width, height, data, channels: 3, depth}));
    return {width, height, data};
}
