// The script of page.html, in which DATA is what bench/browser/browser_page.cpp puts there.
const DATA = JSON.parse(document.getElementById("data").textContent);
const GUARD = DATA.guard_words, WORDS = DATA.hit_words, POISON = DATA.poison;
const at = id => document.getElementById(id);
const query = new URLSearchParams(location.search);
// What the run has found; result_of() makes a result of it.
const found = { records: [] };
let stopped = false;
const MIN_SAMPLE_S = 0.05; // of all views

async function unpacked(text) {
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}
const array = number => unpacked(DATA.arrays[number]);
const words_of = bytes => new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);

// As in bench/browser/answer_hash.cpp.
function hash_of_words(words) {
    let low = 0, high = 0;
    for (const word of words) {
        low = Math.imul(turned(low, 5) ^ word, 0x9E3779B1);
        high = Math.imul(turned(high, 7) ^ Math.imul(word, 0x27D4EB2F), 0x85EBCA77);
    }
    return [low >>> 0, high >>> 0];
}

// The two hashes of a ray's answer, as bench/browser/answer_hash.cpp has them.
function hash_of_ray(words, first, factor) {
    let h = 0x9E3779B9;
    for (let i = 0; i < WORDS; ++i) {
        h = Math.imul(h ^ words[first + i], factor);
        h ^= h >>> 13;
    }
    h = Math.imul(h, 0xC2B2AE35);
    return (h ^ (h >>> 16)) >>> 0;
}
const turned = (h, by) => (h << by) | (h >>> (32 - by));
function hashes_of(words, rays) {
    let low = 0, high = 0;
    const bytes = new Uint8Array(rays);
    for (let ray = 0; ray < rays; ++ray) {
        const first = GUARD + ray * WORDS, a = hash_of_ray(words, first, 0x85EBCA6B), b = hash_of_ray(words, first, 0x27D4EB2F);
        low = Math.imul(turned(low, 5) ^ a, 0x9E3779B1);
        high = Math.imul(turned(high, 7) ^ b, 0x85EBCA77);
        bytes[ray] = a & 255;
    }
    return { view: [low >>> 0, high >>> 0], bytes };
}

class LostDevice extends Error {}

class Gpu {
    static async open() {
        if (!navigator.gpu) throw new Error("this browser has no WebGPU. Chrome and Edge from 113 on have it (on Linux: chrome://flags/#enable-unsafe-webgpu), Safari from 26, Firefox from 141 on Windows (elsewhere: about:config, dom.webgpu.enabled)");
        const adapter = await navigator.gpu.requestAdapter({ powerPreference: "high-performance" });
        if (!adapter) throw new Error("the browser offers no GPU; chrome://gpu or about:support says why");
        const wanted = ["maxStorageBufferBindingSize", "maxBufferSize", "maxStorageBuffersPerShaderStage"];
        const device = await adapter.requestDevice({
            requiredFeatures: adapter.features.has("timestamp-query") ? ["timestamp-query"] : [],
            requiredLimits: Object.fromEntries(wanted.map(name => [name, adapter.limits[name]])) });
        const gpu = new Gpu();
        Object.assign(gpu, { adapter, device, errors: [], lost: null });
        device.addEventListener("uncapturederror", event => gpu.errors.push(event.error.message));
        device.lost.then(info => { gpu.lost = info.message || info.reason; });
        gpu.is_timed = device.features.has("timestamp-query");
        if (gpu.is_timed) {
            gpu.queries = device.createQuerySet({ type: "timestamp", count: 2 });
            gpu.resolved = device.createBuffer({ size: 16, usage: GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC });
            gpu.times = device.createBuffer({ size: 16, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
        }
        return gpu;
    }
    check() {
        if (this.lost) throw new LostDevice("the device was lost: " + this.lost);
        if (this.errors.length) throw new Error(this.errors[0]);
    }
    buffer(bytes, usage = 0) {
        if (bytes.byteLength > this.device.limits.maxStorageBufferBindingSize) throw new Error(`the scene needs a buffer of ${bytes.byteLength} bytes, and this device has at most ${this.device.limits.maxStorageBufferBindingSize}`);
        const buffer = this.device.createBuffer({ size: Math.max(16, (bytes.byteLength + 3) & ~3), usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST | usage });
        this.device.queue.writeBuffer(buffer, 0, bytes);
        return buffer;
    }
    // bindings: of all but its output.
    async pipeline(code, bindings, constants) {
        const begin = performance.now(), module = this.device.createShaderModule({ code });
        const problem = (await module.getCompilationInfo()).messages.find(message => message.type === "error");
        if (problem) throw new Error(`line ${problem.lineNum} of its WGSL: ${problem.message}`);
        const written = [DATA.output_binding, DATA.sums_binding];
        const entries = [...bindings, DATA.output_binding].map(binding => ({
            binding, visibility: GPUShaderStage.COMPUTE, buffer: { type: written.includes(binding) ? "storage" : "read-only-storage" } }));
        const layout = this.device.createPipelineLayout({ bindGroupLayouts: [this.device.createBindGroupLayout({ entries })] });
        const pipeline = await this.device.createComputePipelineAsync({ layout, compute: { module, entryPoint: "main", constants } });
        return { pipeline, compile_ms: performance.now() - begin };
    }
    bindings(pipeline, entries) {
        return this.device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: entries.map(([binding, buffer]) => ({ binding, resource: { buffer } })) });
    }
    // Seconds of a dispatch, by the device's clock if it has one, which browsers round to 100 us: so that of many passes.
    async dispatch(pipeline, group, groups, passes = 1) {
        const begin = performance.now(), encoder = this.device.createCommandEncoder();
        const pass = encoder.beginComputePass(this.is_timed ? { timestampWrites: { querySet: this.queries, beginningOfPassWriteIndex: 0, endOfPassWriteIndex: 1 } } : {});
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, group);
        for (let i = 0; i < passes; ++i) pass.dispatchWorkgroups(groups);
        pass.end();
        if (this.is_timed) {
            encoder.resolveQuerySet(this.queries, 0, 2, this.resolved, 0);
            encoder.copyBufferToBuffer(this.resolved, 0, this.times, 0, 16);
        }
        this.device.queue.submit([encoder.finish()]);
        if (!this.is_timed) {
            await this.device.queue.onSubmittedWorkDone();
            this.check();
            return (performance.now() - begin) * 1e-3 / passes;
        }
        await this.times.mapAsync(GPUMapMode.READ).catch(() => {});
        this.check();
        const [first, last] = new BigUint64Array(this.times.getMappedRange());
        this.times.unmap();
        return (last > first ? Number(last - first) * 1e-9 : (performance.now() - begin) * 1e-3) / passes;
    }
    async words(buffer, count) {
        const copy = this.device.createBuffer({ size: count * 4, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
        const encoder = this.device.createCommandEncoder();
        encoder.copyBufferToBuffer(buffer, 0, copy, 0, count * 4);
        this.device.queue.submit([encoder.finish()]);
        await copy.mapAsync(GPUMapMode.READ).catch(() => {});
        this.check();
        const words = new Uint32Array(copy.getMappedRange().slice(0));
        copy.destroy();
        return words;
    }
}

async function self_test(gpu) {
    const operations = words_of(await unpacked(DATA.probe.operations)), expected = words_of(await unpacked(DATA.probe.words));
    const { pipeline } = await gpu.pipeline(DATA.probe.wgsl, [0, DATA.launch_binding]);
    const output = gpu.buffer(new Uint32Array(expected.length).fill(POISON), GPUBufferUsage.COPY_SRC);
    const group = gpu.bindings(pipeline, [[0, gpu.buffer(operations)], [DATA.output_binding, output], [DATA.launch_binding, gpu.buffer(new Uint32Array([expected.length, 0]))]]);
    await gpu.dispatch(pipeline, group, Math.ceil(expected.length / 64));
    const words = await gpu.words(output, expected.length);
    const is_tiny = word => (word & 0x7F800000) === 0 && (word & 0x007FFFFF) !== 0;
    const wrong = {}, findings = {};
    for (let i = 0; i < words.length; ++i) {
        if (words[i] === expected[i]) continue;
        const { name, finding, value } = DATA.probe.names[operations[4 * i]];
        const inputs = [1, 2, 3].map(k => operations[4 * i + k]);
        if (DATA.probe.may_flush.includes(operations[4 * i]) && [expected[i], ...inputs].some(is_tiny)) {
            findings.denormals_kept = false;
            continue;
        }
        wrong[name] = (wrong[name] || 0) + 1;
        findings[finding] = value ?? Math.max(findings[finding] || 0, Math.abs(words[i] - expected[i]));
    }
    const exact = Object.keys(wrong).length === 0;
    const text = (exact ? "exact" : "NOT exact: " + Object.entries(wrong).map(([name, count]) => `${name} (${count})`).join(", ")) +
        (findings.denormals_kept === false ? "; denormals flushed" : "");
    return { exact, text, ...findings };
}

class Session {
    constructor(gpu, kernel, scene) { Object.assign(this, { gpu, kernel, scene, tiles: 256, groups: new Map() }); }
    async open() {
        const read = [DATA.launch_binding, ...this.kernel.arrays.map(({ binding }) => binding)];
        if (this.kernel.views.some(view => view.given_rays !== undefined)) read.push(DATA.rays_binding);
        if (this.kernel.views.some(view => view.tally)) read.push(DATA.sums_binding);
        const { pipeline, compile_ms } = await this.gpu.pipeline(this.kernel.wgsl, read, { tile_height: DATA.tile_height });
        this.pipeline = pipeline;
        this.compile_ms = compile_ms;
        this.most_rays = Math.max(...this.kernel.views.map(view => view.rays));
        this.output = this.gpu.buffer(new Uint32Array(2 * GUARD + WORDS * this.most_rays), GPUBufferUsage.COPY_SRC);
        this.launch = this.gpu.device.createBuffer({ size: DATA.launch_words * 4, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
        const buffers = [[DATA.output_binding, this.output], [DATA.launch_binding, this.launch]];
        if (read.includes(DATA.sums_binding)) {
            this.sums = this.gpu.buffer(new Uint32Array(2 * this.kernel.tets), GPUBufferUsage.COPY_SRC);
            buffers.push([DATA.sums_binding, this.sums]);
        }
        for (const { binding, array: number } of this.kernel.arrays) buffers.push([binding, this.gpu.buffer(await array(number))]);
        for (const view of this.kernel.views) {
            const rays = view.given_rays === undefined ? [] : [[DATA.rays_binding, this.gpu.buffer(await array(view.given_rays))]];
            this.groups.set(view, this.gpu.bindings(pipeline, [...buffers, ...rays]));
        }
        this.gpu.check();
    }
    // Seconds of all launches of a view, each done so many times. A launch ends long before a watchdog would end it.
    async trace(view, passes = 1) {
        const words = words_of(await unpacked(view.launch)).slice();
        let seconds = 0;
        for (let first = 0; first < view.tiles;) {
            const tiles = Math.min(this.tiles, view.tiles - first, 65535);
            words[DATA.first_tile_word] = first;
            this.gpu.device.queue.writeBuffer(this.launch, 0, words);
            const took = await this.gpu.dispatch(this.pipeline, this.groups.get(view), tiles, tiles === view.tiles ? passes : 1);
            seconds += took;
            this.tiles = Math.max(64, Math.floor(tiles * 0.1 / Math.max(took, 1e-5)));
            first += tiles;
        }
        return seconds;
    }
    async verified(view) {
        this.gpu.device.queue.writeBuffer(this.output, 0, new Uint32Array(2 * GUARD + WORDS * view.rays).fill(POISON));
        if (this.sums) this.gpu.device.queue.writeBuffer(this.sums, 0, new Uint32Array(2 * this.kernel.tets));
        const kernel_s = await this.trace(view), seen = await this.judged(view);
        return { kernel_s, has_wrong_sums: this.sums && !await this.has_sums(view), ...seen };
    }
    // Of the one pass since they were 0.
    async has_sums(view) {
        const hash = hash_of_words(await this.gpu.words(this.sums, 2 * this.kernel.tets));
        return hash[0] === view.tally[0] && hash[1] === view.tally[1];
    }
    // What is in the output, compared with the right answers to the view that was traced last. is_sampled: other views
    // were traced since there was poison, so the words after a smaller one's answers are theirs.
    async judged(view, is_sampled = false) {
        const begin = performance.now(), count = 2 * GUARD + WORDS * view.rays, words = await this.gpu.words(this.output, count);
        const download_s = (performance.now() - begin) * 1e-3;
        const has_end = !is_sampled || view.rays === this.most_rays;
        for (let i = 0; i < GUARD; ++i) if (words[i] !== POISON || (has_end && words[count - 1 - i] !== POISON)) return { words, download_s, outside: true, wrong: 0 };
        const hashes = hashes_of(words, view.rays);
        if (hashes.view[0] === view.hash[0] && hashes.view[1] === view.hash[1]) return { words, download_s, wrong: 0 };
        const expected = await array(view.ray_hashes);
        let wrong = 0, first = -1;
        for (let ray = 0; ray < view.rays; ++ray) if (hashes.bytes[ray] !== expected[ray]) {
            ++wrong;
            if (first < 0) first = ray;
        }
        return { words, download_s, wrong: Math.max(wrong, 1), first };
    }
}

function draw(words, scene, title) {
    const canvas = document.createElement("canvas");
    canvas.width = scene.width;
    canvas.height = scene.height;
    canvas.title = title;
    const context = canvas.getContext("2d"), image = context.createImageData(scene.width, scene.height);
    for (let ray = 0; ray < scene.width * scene.height; ++ray) {
        const id = words[GUARD + ray * WORDS], shade = Math.imul(id + 1, 0x9E3779B1) >>> 24;
        image.data.set(id === 0xFFFFFFFF ? [16, 18, 28, 255] : [96 + shade / 2, 110 + shade / 3, 150 + shade / 4, 255], ray * 4);
    }
    context.putImageData(image, 0, 0);
    at("pictures").append(canvas);
}

function quantile(values, share) {
    const sorted = [...values].sort((a, b) => a - b), place = share * (sorted.length - 1), low = Math.floor(place);
    return sorted[low] + (place - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
}

function show_row(row) {
    if (!row.line) {
        row.line = document.createElement("tr");
        at("rows").tBodies[0].append(row.line);
        at("rows").hidden = false;
    }
    const samples = row.record.samples_s, median = samples.length ? quantile(samples, 0.5) : 0;
    const rate = median ? row.record.rays / median / 1e6 : 0;
    const spread = samples.length > 4 ? (quantile(samples, 0.75) - quantile(samples, 0.25)) / median : 0;
    const share = row.record.hit_share;
    const cells = [row.record.kernel, row.record.scene, row.record.rays.toLocaleString("en"), share === undefined ? "–" : (100 * share).toFixed(0) + " %", row.record.conformity,
        rate ? rate.toPrecision(3) : "–", spread ? (100 * spread).toFixed(1) + " %" + (spread > 0.05 ? ", noisy" : "") : "–", samples.length, row.record.compile_ms.toFixed(0)];
    row.line.replaceChildren(...cells.map((cell, i) => {
        const element = document.createElement("td");
        element.textContent = cell;
        if (i === 4) element.className = row.record.conformity === "bit-exact" ? "good" : "bad";
        return element;
    }));
    row.record.mrays_per_s = rate;
}

const next_frame = () => new Promise(resolve => setTimeout(resolve, 0));
async function while_hidden() {
    while (document.hidden && !stopped) await new Promise(resolve => setTimeout(resolve, 100));
}

// The first ray that is wrong, in full: its words here, and how to see what is right.
async function first_wrong_text(record, scene, kernel, view, seen) {
    const ray = seen.first, first = GUARD + ray * WORDS, where = `${record.kernel}, ${record.scene}, view ${view.number}`;
    if (ray < 0) return `${where}: the hash of the view differs`;
    const words = [...seen.words.slice(first, first + WORDS)].map(word => "0x" + word.toString(16).padStart(8, "0")).join(" ");
    if (view.given_rays === undefined) {
        const pixel = `${ray % scene.width},${Math.floor(ray / scene.width)}`;
        return `${where}: pixel ${pixel} is wrong; here it has the words\n${words}\n(${kernel.answer}). The right answer, step by step:\n${scene.trace_command} --view ${view.number} --pixel ${pixel}`;
    }
    const reals = new Float32Array((await array(view.given_rays)).buffer);
    const vector = quad => "(" + [0, 1, 2].map(i => reals[4 * (quad * view.rays + ray) + i]).join(", ") + ")";
    return `${where}: given ray ${ray} is wrong, from ${vector(1)} in direction ${vector(0)}; here it has the words\n${words}\n(${kernel.answer})`;
}

async function tell_first_wrong(record, scene, kernel, view, seen) {
    if (!seen.wrong || found.has_told) return;
    found.has_told = true;
    tell(await first_wrong_text(record, scene, kernel, view, seen));
}

function tell(text) {
    at("first-wrong").hidden = false;
    at("first-wrong").textContent += text + "\n";
}

function conformity_of(record) {
    return record.outside ? "writes outside its output" : record.has_wrong_sums ? "wrong sums of tets" : record.wrong ? `${record.wrong.toLocaleString("en")} ray${record.wrong === 1 ? "" : "s"} wrong` : "bit-exact";
}

// records: one for each kernel, in the order of the result's rows. Those of rows in error stay.
function begin_records() {
    const rows = DATA.result.tetrace.rows, before = found.records;
    let number = 0;
    found.records = DATA.scenes.flatMap(scene => scene.kernels.map(kernel => ({
        hit_share: rows[number++].counts?.hit_share,
        kernel: kernel.name, scene: scene.name, rays: kernel.views.reduce((sum, view) => sum + view.rays, 0), wrong: 0, conformity: "",
        samples_s: [], passes: 1, compile_ms: 0, first_kernel_s: 0, first_wall_s: 0, download_s: 0 }))).map((record, i) => before[i]?.conformity === "error" ? before[i] : record);
}

async function verify_row(gpu, row) {
    const { record, scene, kernel } = row;
    row.session = new Session(gpu, kernel, scene);
    await row.session.open();
    record.compile_ms = row.session.compile_ms;
    for (const view of kernel.views) {
        const begin = performance.now(), seen = await row.session.verified(view);
        record.first_kernel_s += seen.kernel_s;
        record.first_wall_s += (performance.now() - begin) * 1e-3 - seen.download_s;
        record.download_s += seen.download_s;
        record.wrong += seen.wrong;
        record.outside = record.outside || seen.outside;
        record.has_wrong_sums = record.has_wrong_sums || seen.has_wrong_sums;
        if (kernel === scene.kernels[0] && view === kernel.views[0] && view.given_rays === undefined) draw(seen.words, scene, `${scene.name}, view ${view.number}`);
        await tell_first_wrong(record, scene, kernel, view, seen);
    }
    record.conformity = conformity_of(record);
}

async function verify(gpu, rows) {
    let number = 0;
    for (const scene of DATA.scenes) for (const kernel of scene.kernels) {
        if (stopped) return;
        const row = { record: found.records[number++], scene, kernel };
        if (row.record.conformity === "error") { // it lost the device
            show_row(row);
            continue;
        }
        found.running = row.record;
        at("state").textContent = `compiling and verifying ${kernel.name} on ${scene.name}`;
        await next_frame();
        try {
            gpu.errors.length = 0;
            await verify_row(gpu, row);
        } catch (error) {
            row.record.conformity = "error";
            row.record.error = error.message;
            tell(`${kernel.name}, ${scene.name}: ${error.message}`);
            if (error instanceof LostDevice) throw error;
        }
        rows.push(row);
        show_row(row);
    }
}

// Rows in turn, so that what disturbs the machine disturbs all.
async function measure(rows, seconds) {
    const timed = rows.filter(row => row.record.conformity === "bit-exact"), end = performance.now() + 1000 * seconds;
    for (let round = 0; timed.length && !stopped && (round < 6 || performance.now() < end); ++round) {
        for (const row of timed) {
            await while_hidden();
            if (stopped) return;
            let sum = 0;
            found.running = row.record;
            for (const view of row.kernel.views) sum += await row.session.trace(view, row.record.passes);
            if (round > 0) row.record.samples_s.push(sum);
            else row.record.passes = Math.max(1, Math.min(1000, Math.ceil(MIN_SAMPLE_S / sum)));
            show_row(row);
        }
        at("state").textContent = `measuring, ${Math.max(0, (end - performance.now()) / 1000).toFixed(0)} s left`;
        await next_frame();
    }
}

// The answers of the last sample: a device may compute otherwise once it is hot.
async function verify_again(rows) {
    for (const row of rows.filter(row => row.record.samples_s.length)) {
        const view = row.kernel.views.at(-1), seen = await row.session.judged(view, true);
        row.record.wrong += seen.wrong;
        row.record.outside = row.record.outside || seen.outside;
        row.record.conformity = conformity_of(row.record);
        if (row.record.conformity !== "bit-exact") row.record.samples_s = []; // no rate of wrong answers
        await tell_first_wrong(row.record, row.scene, row.kernel, view, seen);
        show_row(row);
    }
}

// A result of tetrace: DATA.result, which has all that does not depend on the device, and what was found.
function result_of() {
    const section = structuredClone(DATA.result.tetrace);
    section.date = new Date().toISOString().slice(0, 19) + "Z";
    section.host.system = navigator.userAgent;
    section.host.threads = section.threads = navigator.hardwareConcurrency || 1;
    if (at("label").value) section.label = at("label").value;
    if (stopped) section.interrupted = true;
    if (found.timed_s > 0) section.timed_s = found.timed_s;
    Object.assign(section.devices[0], found.device);
    if (found.self_test) Object.assign(section.devices[0].self_test.exact, found.self_test);
    else delete section.devices[0].self_test;
    section.rows.forEach((row, number) => fill_row(row, found.records[number]));
    section.samples_a_row = Math.max(...section.rows.map(row => row.times?.samples_s?.length || 0));
    return { tetrace: section };
}

// row: as if it were right.
function fill_row(row, record) {
    Object.assign(row.device, found.device);
    if (found.self_test) Object.assign(row.self_test, found.self_test);
    if (record?.conformity === "bit-exact") {
        const samples = record.samples_s;
        row.times = { ...row.times, clock: found.clock, first_kernel_s: record.first_kernel_s, first_wall_s: record.first_wall_s, download_s: record.download_s };
        if (record.compile_ms > 0) row.times.compile_s = record.compile_ms * 1e-3;
        if (!samples.length) return;
        const [low, median, high] = [0.25, 0.5, 0.75].map(share => quantile(samples, share)), spread = (high - low) / median;
        Object.assign(row.times, { samples_s: samples, median_s: median, lower_quartile_s: low, upper_quartile_s: high, spread, noisy: spread > 0.05 });
        if (record.passes > 1) row.times.passes = record.passes;
        row.rates = { mrays_per_s: record.rays / median * 1e-6 };
        return;
    }
    for (const key of ["counts", "visits", "verification", "hit_hash", "views_hash", "times"]) delete row[key];
    const [status, reason] = !record?.conformity ? ["skipped", "the page ended before it"] :
        record.conformity === "error" ? ["error", record.error] : ["wrong", `${record.conformity}: not the answers of openmp`];
    Object.assign(row, { status, reason });
}

function offer_result() {
    const save = at("save");
    save.href = "data:application/json," + encodeURIComponent(JSON.stringify(result_of(), null, 1));
    save.download = "tetrace-webgpu.json";
    save.hidden = false;
}

function finish() {
    const done = found.records.filter(record => record.conformity), bad = done.filter(record => record.conformity !== "bit-exact").length;
    const exact = found.self_test && found.self_test.exact, all = found.records.length;
    const verdict = found.error ? "error" : bad || !exact ? "failed" : done.length < all ? "stopped" : "conforms";
    at("state").textContent = stopped ? "stopped" : "done";
    at("verdict").textContent = found.error ? "Stopped by an error: " + found.error :
        verdict === "conforms" ? `Conforms: every ray of ${all} rows has the right answer, bit for bit.` :
        verdict === "stopped" ? `Stopped: ${done.length} of ${all} rows were verified.` :
        `FAILED: ${bad} of ${done.length} rows${exact ? "" : ", and the self-test"}.`;
    at("verdict").className = verdict === "conforms" ? "good" : "bad";
    offer_result();
    at("label").oninput = offer_result;
    at("stop").hidden = true;
    document.body.dataset.verdict = verdict;
}

// As results name devices. Browsers tell little of the GPU, and some nothing.
function device_of(adapter) {
    const info = adapter.info || {}, agent = navigator.userAgent;
    const browser = (agent.match(/(Edg|CriOS|FxiOS)\/[\d.]+/) || agent.match(/(Firefox|HeadlessChrome|Chrome|Version)\/[\d.]+/) || ["a browser"])[0];
    const name = [...new Set([info.vendor, info.architecture, info.device, info.description].filter(Boolean))].join(" ") || "a GPU that the browser does not name";
    const is_emulated = Boolean(info.isFallbackAdapter) || /swiftshader|llvmpipe/i.test(name);
    const library = /Firefox/.test(browser) ? "wgpu" : /Version|CriOS|FxiOS/.test(browser) ? "webkit" : "dawn";
    const implementation = /swiftshader/i.test(name) ? library + "-swiftshader" : /llvmpipe/i.test(name) ? library + "-lavapipe" : library;
    return { name, id: name, type: is_emulated ? "emulated" : "gpu", driver: browser.replace("Version", "Safari"), implementation };
}

async function run() {
    at("start").disabled = true;
    at("stop").hidden = false;
    at("stop").onclick = () => { stopped = true; };
    const seconds = Number(query.get("seconds") ?? 10);
    for (let attempt = 0; attempt < 2; ++attempt) {
        begin_records();
        at("rows").tBodies[0].replaceChildren();
        at("pictures").replaceChildren();
        delete found.error;
        try {
            const gpu = await Gpu.open();
            found.device = device_of(gpu.adapter);
            found.clock = gpu.is_timed ? "WebGPU timestamps" : "browser clock";
            at("device").textContent = `${found.device.name}${found.device.type === "emulated" ? ", emulated by the processor" : ""}; times by ${found.clock}`;
            found.self_test = await self_test(gpu);
            at("self-test").textContent = "Self-test: " + found.self_test.text;
            const rows = [];
            await verify(gpu, rows);
            const begin = performance.now();
            await measure(rows, seconds);
            found.timed_s = (performance.now() - begin) * 1e-3;
            await verify_again(rows);
            break;
        } catch (error) {
            found.error = error.message;
            if (!(error instanceof LostDevice)) break;
            if (found.running) Object.assign(found.running, { conformity: "error", error: error.message, samples_s: [] });
        }
    }
    finish();
}

at("version").textContent = DATA.version;
at("scenes").textContent = DATA.scenes.map(scene => `${scene.name} (${scene.triangles.toLocaleString("en")} triangles)`).join(", ");
at("start").onclick = run;
if (query.has("start")) {
    // A document in an iframe that stays open holds the load event until the run has ended, for --dump-dom.
    const frame = document.createElement("iframe");
    frame.hidden = true;
    document.body.append(frame);
    frame.contentDocument.open();
    run().finally(() => frame.contentDocument.close());
}
