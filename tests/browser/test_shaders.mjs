// Exported shaders on a GPU, here a software renderer: WebGL 2 and WebGPU give the picture that the program writes.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {decode} from 'fast-png';
import {lensprof, openPage, read, removeFolder, startBrowser, write, writeCard} from './support.mjs';

const srgb = light => (light < 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
const RESPONSES = {
    linear: {kind: 'linear'}, gamma: {kind: 'gamma', gamma: 2.2}, emor: {kind: 'emor', emor: [0.6, -0.2, 0.05]},
    table: {kind: 'table', values: [Array.from({length: 1024}, (_, i) => srgb(i / 1023))]},
};
const WIDTH = 160, HEIGHT = 120;
let browser, page, rgba;
before(async () => {
    browser = await startBrowser();
    page = await openPage(browser);
    const {data} = writeCard('picture.png', {width: WIDTH, height: HEIGHT, level: 0.35, slope: 1.2});
    rgba = Array.from({length: WIDTH * HEIGHT * 4},
        (_, i) => (i % 4 === 3 ? 255 : data[Math.floor(i / 4) * 3 + (i % 4)]));
    for (const [name, response] of Object.entries(RESPONSES)) {
        write(`${name}.json`, JSON.stringify({
            schema: 2, key: {camera_model: 'One', lens: 'Acme', processing: 'jpeg'}, response,
            vignetting: {k: [[-0.3, 0.05, -0.15], [-0.2, 0.02, -0.1], [-0.4, 0.1, -0.1]], center: [0.02, -0.01]},
        }));
        lensprof('profile', 'import', '--db', `${name}.db`, `${name}.json`);
        for (const ending of ['glsl', 'wgsl']) {
            lensprof('profile', 'export', '1', '--db', `${name}.db`, '-o', `${name}.${ending}`);
        }
        lensprof('apply', 'picture.png', '--db', `${name}.db`, '--profile', '1', '-o', name);
    }
});
after(async () => {
    await browser.close();
    removeFolder();
});

/** In the page: the pixels that a fragment shader with these functions makes. */
function drawnByWebgl({functions, pixels, width, height}) {
    const gl = new OffscreenCanvas(width, height).getContext('webgl2');
    const compiled = (kind, source) => {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        return shader;
    };
    const program = gl.createProgram();
    gl.attachShader(program, compiled(gl.VERTEX_SHADER, `#version 300 es
        void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }`));
    gl.attachShader(program, compiled(gl.FRAGMENT_SHADER, `#version 300 es\n${functions}
        uniform highp sampler2D picture;
        out vec4 color;
        void main() { // row 0 of the texture and of what is drawn is the upper one
            vec3 encoded = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb;
            color = vec4(lensprof_correct(encoded, gl_FragCoord.xy, vec2(textureSize(picture, 0))), 1.0);
        }`));
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const drawn = new Uint8Array(width * height * 4);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, drawn);
    return [...drawn];
}

/** In the page: the same of a compute shader; null without an adapter. */
async function computedByWebgpu({functions, pixels, width, height}) {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return null;
    const device = await adapter.requestDevice();
    const module = device.createShaderModule({code: `${functions}
        @group(0) @binding(0) var<storage, read> encoded: array<u32>;
        @group(0) @binding(1) var<storage, read_write> corrected: array<u32>;
        @compute @workgroup_size(64) fn run(@builtin(global_invocation_id) id: vec3<u32>) {
            let size = vec2<u32>(${width}u, ${height}u);
            if (id.x >= size.x * size.y) { return; }
            let position = vec2<f32>(f32(id.x % size.x) + 0.5, f32(id.x / size.x) + 0.5);
            let light = lensprof_correct(unpack4x8unorm(encoded[id.x]).rgb, position, vec2<f32>(size));
            corrected[id.x] = pack4x8unorm(vec4<f32>(light, 1.0));
        }`});
    const {messages} = await module.getCompilationInfo();
    if (messages.some(({type}) => type === 'error')) throw new Error(messages[0].message);
    const pipeline = device.createComputePipeline({layout: 'auto', compute: {module, entryPoint: 'run'}});
    const size = pixels.length;
    const [input, output, read] = [GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST,
        GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST]
        .map(usage => device.createBuffer({size, usage}));
    device.queue.writeBuffer(input, 0, new Uint8Array(pixels));
    const commands = device.createCommandEncoder(), pass = commands.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({layout: pipeline.getBindGroupLayout(0),
        entries: [{binding: 0, resource: {buffer: input}}, {binding: 1, resource: {buffer: output}}]}));
    pass.dispatchWorkgroups(Math.ceil(width * height / 64));
    pass.end();
    commands.copyBufferToBuffer(output, 0, read, 0, size);
    device.queue.submit([commands.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    return [...new Uint8Array(read.getMappedRange())];
}

for (const [ending, draw] of [['glsl', drawnByWebgl], ['wgsl', computedByWebgpu]]) {
    for (const name of Object.keys(RESPONSES)) {
        test(`${ending}, ${name}`, async context => {
            const drawn = await page.evaluate(draw,
                {functions: read(`${name}.${ending}`).toString(), pixels: rgba, width: WIDTH, height: HEIGHT});
            if (!drawn) return context.skip('there is no WebGPU adapter');
            const own = decode(read(`${name}/picture.png`)).data;
            let largest = 0, different = 0;
            own.forEach((value, i) => {
                const difference = Math.abs(value - drawn[Math.floor(i / 3) * 4 + (i % 3)]);
                largest = Math.max(largest, difference);
                different += difference > 0;
            });
            const found = `${different} of ${own.length} samples differ, by at most ${largest}`;
            context.diagnostic(found);
            assert.ok(largest <= 1 && different < 0.02 * own.length, found);
            assert.ok(own.some((value, i) => value !== rgba[Math.floor(i / 3) * 4 + (i % 3)]), 'nothing was corrected');
        });
    }
}
