// Reference: the records. The viewer in a real browser draws and states what the study `frames` wrote, within the stated quantisation.
// browser_test.py starts this test and names the page and a file with samples of the records.
import assert from "node:assert/strict";
import fs from "node:fs";
import { after, before, test } from "node:test";
import { open_viewer, settle } from "./browser.mjs";

const file = process.env.PBS_VIEWER_PAGE;
const truth = JSON.parse(fs.readFileSync(process.env.PBS_VIEWER_TRUTH));
const pictures = process.env.PBS_VIEWER_PICTURES;
let opened, page;

before(async () => {
    opened = await open_viewer(file);
    page = opened.page;
});
after(() => opened?.close());

// The number of colours in the panel, and the share of its pixels that differ from the most frequent one.
function colours_of(panel) {
    return page.evaluate((at) => {
        const bytes = window.viewer.pixels(at), counts = new Map();
        for (let i = 0; i < bytes.length; i += 4) {
            const key = (bytes[i] << 16) | (bytes[i + 1] << 8) | bytes[i + 2];
            counts.set(key, (counts.get(key) ?? 0) + 1);
        }
        return { colours: counts.size, drawn: 1 - Math.max(...counts.values()) / (bytes.length / 4) };
    }, panel);
}

async function show(changes) {
    await page.evaluate((wanted) => window.viewer.state.set(wanted), changes);
    await settle(page);
}

// x y z of each vertex [m] in the first panel; nan where no face is visible.
function drawn_positions() {
    return page.evaluate(() => [...window.viewer.drawn_positions(0)]);
}

async function show_sample({ run, frame, label }, colour = "skin", { rendered = false, cut = null } = {}) {
    const also = (rendered ? "&surface=rendered" : "") + (cut ? `&cut=${cut},0.01,below` : "");
    await page.evaluate((hash) => { location.hash = hash; }, `run=${run}&frame=${frame}&colour=${colour}&panels=${label}${also}`);
    await page.waitForFunction((wanted) => {
        const { viewer, state: { now } } = window.viewer;
        return now.run === wanted.run && now.panels[0] === wanted.label && now.colour === wanted.colour
            && viewer.run.frames[now.at] === wanted.frame && now.rendered === wanted.rendered && (now.cut?.axis ?? null) === wanted.cut;
    }, { run, frame, label, colour, rendered, cut });
    await settle(page);
}

// The largest distance of a drawn coordinate from the record's [m], and the number of coordinates.
function apart(drawn, recorded) {
    const known = drawn.map((value, i) => Math.abs(value - recorded[i])).filter((value) => !Number.isNaN(value));
    return { count: known.length, largest_m: Math.max(...known) };
}

// The rounding of single precision, in multiples of 2 ** -24 of the largest coordinate [m].
function roundings(recorded, many) {
    return many * Math.max(...recorded.map(Math.abs)) * 2 ** -24;
}

test("the page opens from disk, alone and without a word on the console", () => assert.deepEqual(opened.problems, []));

test("every panel is drawn", async () => {
    const panels = await page.locator("#frame-viewer .vw-panel").count();
    assert.equal(panels, 4);
    for (let panel = 0; panel < panels; ++panel) {
        const { colours, drawn } = await colours_of(panel);
        assert.ok(colours > 20, `panel ${panel}: ${colours} colours`);
        assert.ok(drawn > 0.01, `panel ${panel}: ${drawn} of it drawn`);
    }
});

for (const sample of truth.samples) {
    const name = `${sample.run}, ${sample.label}, frame ${sample.frame}`;
    test(`drawn vertices are the record's: ${name}`, async () => {
        await show_sample(sample);
        const drawn = await drawn_positions(), step_m = await page.evaluate(() => window.viewer.viewer.run.step_m);
        const { count, largest_m } = apart(drawn, sample.positions_m);
        assert.ok(count > sample.positions_m.length / 3, `${count} coordinates drawn`);
        // the rounding of the record, and that on the way to the graphics card
        const most_m = step_m / 2 + roundings(sample.positions_m, 2);
        assert.ok(largest_m <= most_m, `${largest_m} m apart, half a step is ${step_m / 2} m`);
    });
    test(`numbers under the panel are the record's: ${name}`, async () => {
        await show_sample(sample);
        for (const [column, recorded] of Object.entries(sample.figures)) {
            const shown = page.locator(`#frame-viewer .vw-panel dd[data-column="${column}"]`).first();
            assert.equal(Number(await shown.getAttribute("data-value")), Number(recorded), column);
        }
    });
    test(`inverted tets are as many as on record: ${name}`, async () => {
        await show_sample(sample, "inverted");
        const behind = await page.evaluate(() => window.viewer.viewer.panels[0].inverted.tets.length);
        assert.equal(behind / 4, Number(sample.figures.inverted_tets));
    });
}

// The index of the shade with which each corner of the first panel is painted, with its vertex and the tet behind it.
function painted() {
    return page.evaluate(() => {
        const { geometry, vertices, tets } = window.viewer.viewer.panels[0].body;
        return { colours: [...geometry.attributes.colour.array.subarray(0, 3 * vertices.length)], vertices: [...vertices],
                 tets: [...tets] };
    });
}

const rgb_of = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
const is_same = (one, other) => one.every((part, at) => Math.abs(part - other[at]) < 1e-3);

// Each corner's shade is one of those for the recorded value after rounding; -1: a shade that is not in the table.
function assert_shades({ colours, vertices }, shades, allowed, fewest) {
    const table = shades.map(rgb_of), used = new Set();
    vertices.forEach((_, corner) => {
        const shade = table.findIndex((one) => is_same(one, colours.slice(3 * corner, 3 * corner + 3)));
        const [low, high] = allowed(corner);
        assert.ok(shade >= low && shade <= high, `corner ${corner}: shade ${shade}, on record ${low} to ${high}`);
        used.add(shade);
    });
    assert.ok(used.size >= fewest, `${used.size} shades`);
}

for (const sample of truth.samples.filter(({ frame }) => frame > 0)) {
    const name = `${sample.run}, ${sample.label}, frame ${sample.frame}`;
    test(`tets have the colour of the record's ratio: ${name}`, async () => {
        await show_sample(sample, "ratio");
        const { low, high, shades } = truth.colours.ratio, made = await painted(), last = shades.length - 1;
        const place = (ratio) => Math.round(last * Math.min(1, Math.max(0, (ratio - low) / (high - low))));
        const inverted = rgb_of(truth.colours.inverted), rounding = 0.5 / 127 + 1e-6;
        const is_inverted = (corner) => sample.ratios[made.tets[Math.floor(corner / 3)]] <= 0;
        made.vertices.forEach((_, corner) => assert.equal(is_same(inverted, made.colours.slice(3 * corner, 3 * corner + 3)),
                                                          is_inverted(corner), `corner ${corner}`));
        const shown = made.vertices.map((_, corner) => corner).filter((corner) => !is_inverted(corner));
        const kept = { colours: shown.flatMap((corner) => made.colours.slice(3 * corner, 3 * corner + 3)), vertices: shown };
        assert_shades(kept, shades, (at) => {
            const ratio = sample.ratios[made.tets[Math.floor(shown[at] / 3)]];
            return [place(ratio - rounding), place(ratio + rounding)];
        }, 5);
    });
    if (sample.label === sample.reference) continue;
    test(`vertices have the colour of their distance on record: ${name}`, async () => {
        await show_sample(sample, "error");
        const { shades } = truth.colours.error, made = await painted(), last = shades.length - 1;
        const most_m = truth.largest_error_m[sample.run], step_m = await page.evaluate(() => window.viewer.viewer.run.step_m);
        const place = (distance_m) => Math.round(last * Math.sqrt(Math.min(1, Math.max(0, distance_m) / most_m)));
        const rounding_m = Math.sqrt(3) * (step_m + roundings(sample.positions_m, 4));  // rounding of both bodies
        assert_shades(made, shades, (corner) => {
            const distance_m = sample.distances_m[made.vertices[corner]];
            return [place(distance_m - rounding_m), place(distance_m + rounding_m)];
        }, 5);
    });
}

// Red, green and blue of the darkest pixel around a place [m] in the first panel.
function darkest_at(place) {
    return page.evaluate(([x, y, z]) => {
        const { viewer } = window.viewer, bytes = window.viewer.pixels(0), { camera, renderer } = viewer.views;
        const box = viewer.panel_elements[0].view.getBoundingClientRect(), ratio = renderer.getPixelRatio();
        const seen = camera.position.clone().set(x, y, z).project(camera), width = Math.round(box.width * ratio);
        const [across, up] = [(seen.x + 1) / 2 * box.width * ratio, (seen.y + 1) / 2 * box.height * ratio].map(Math.round);
        let darkest = 255;
        for (let dx = -1; dx <= 1; ++dx)
            for (let dy = -1; dy <= 1; ++dy) {
                const at = 4 * ((up + dy) * width + across + dx);
                darkest = Math.min(darkest, Math.max(bytes[at], bytes[at + 1], bytes[at + 2]));
            }
        return darkest;
    }, place);
}

for (const sample of truth.samples.filter(({ bones }) => bones)) {
    test(`the skeleton is drawn where bones.csv has it: ${sample.run}, frame ${sample.frame}`, async () => {
        await show_sample(sample, "skin");
        await show({ bones: false });
        await page.locator('#frame-viewer button[aria-label="the camera where it began"]').click();
        const without = [];
        for (const middle of sample.bones) without.push(await darkest_at(middle));
        await show({ bones: true });
        for (const middle of sample.bones) assert.ok(await darkest_at(middle) < 70, `no bone at ${middle} m`);
        assert.ok(without.every((brightness) => brightness > 70), `dark without bones: ${without}`);
        await show({ bones: false });
    });
}

test("a pose that was not reached is marked, and nothing is painted against it", async () => {
    const [sample] = truth.samples.filter(({ label, frame, reference }) => frame > 0 && label !== reference);
    await show_sample(sample, "error");
    const marks = () => page.locator("#frame-viewer .vw-mark").evaluateAll((all) => all.map((one) => one.getClientRects().length > 0));
    const shades = async () => new Set((await painted()).colours.map((part) => part.toFixed(3))).size;
    assert.deepEqual(await marks(), [false, false, false, false]);
    assert.ok(await shades() > 9);
    const at = await page.evaluate(() => {
        const { run, state } = window.viewer.viewer;
        run.deformer(run.reference).not_reached = [state.now.at];
        return state.now.at;
    });
    await show({ at: at - 1 });
    await show({ at });
    const labels = await page.evaluate(() => window.viewer.state.now.panels);
    assert.deepEqual(await marks(), labels.map((label) => label === sample.reference));
    assert.equal(await shades(), 3);  // red, green and blue of one grey
    assert.match(await legend_words(), /grey: no distance/);
    await page.evaluate(() => { const { run } = window.viewer.viewer; run.deformer(run.reference).not_reached = []; });
    await show({ at: at - 1 });
});

test("in a panel shift and the arrows shift the view, without turning it", async () => {
    const seen = () => page.evaluate(() => {
        const { camera, target } = window.viewer.viewer.views;
        return { target: target.toArray(), eye: camera.position.clone().sub(target).toArray() };
    });
    await page.locator("#frame-viewer .vw-view").first().focus();
    for (const [key, axis] of [["Shift+ArrowUp", 1], ["Shift+ArrowRight", 0]]) {
        const first = await seen();
        await page.keyboard.press(key);
        await settle(page);
        const second = await seen();
        assert.ok(second.target[axis] > first.target[axis] + 0.005, `${key}: from ${first.target} to ${second.target}`);
        second.eye.forEach((part, at) => assert.ok(Math.abs(part - first.eye[at]) < 1e-6, key));
    }
});

function rendered_button() {
    return page.locator("#frame-viewer button", { hasText: "rendered skin" });
}

function legend_words() {
    return page.locator("#frame-viewer .vw-caption").textContent();
}

// The same bound as in surface.js: half a step of each corner times the absolute weights. The record, the weights, the corners, four
// products and four sums are rounded.
for (const sample of truth.skins) {
    const name = `${sample.run}, ${sample.label}, frame ${sample.frame}`;
    test(`points of the rendered surface are the record's: ${name}`, async () => {
        await show_sample(sample, "skin", { rendered: true });
        const { step_m, surface } = await page.evaluate(() => {
            const { step_m, surface: { points, largest_sum } } = window.viewer.viewer.run;
            return { step_m, surface: { points, largest_sum } };
        });
        const drawn = await drawn_positions(), { count, largest_m } = apart(drawn, sample.skin_m);
        assert.deepEqual([drawn.length, count], [sample.skin_m.length, 3 * surface.points]);
        const most_m = surface.largest_sum * (step_m / 2 + roundings(sample.positions_m, 12));
        assert.ok(largest_m <= most_m, `${largest_m} m apart, expected within ${most_m} m`);
        assert.match(await legend_words(), /^the rendered surface, carried by the tets/);
        if (pictures) await page.locator("#frame-viewer").screenshot({ path: `${pictures}/viewer_${sample.run}_${sample.label}.png` });
    });
    test(`a cut shows the tets in place of the rendered surface: ${name}`, async () => {
        await show_sample(sample, "error", { rendered: true, cut: "z" });
        const drawn = await drawn_positions(), step_m = await page.evaluate(() => window.viewer.viewer.run.step_m);
        assert.equal(drawn.length, sample.positions_m.length);
        const { count, largest_m } = apart(drawn, sample.positions_m);
        assert.ok(count > 300 && count < drawn.length, `${count} coordinates drawn`);
        assert.ok(largest_m <= step_m / 2 + roundings(sample.positions_m, 2), `${largest_m} m apart`);
        assert.match(await legend_words(), /^distance of a vertex to FEM/);
    });
}

test("k and the button show the rendered surface or the tets; legend and address follow", async () => {
    await show_sample(truth.skins[0], "ratio", { rendered: true });
    const button = rendered_button();
    const told = async () => [await button.getAttribute("aria-pressed"), /surface=rendered/.test(page.url()),
                              /carries the skin/.test(await legend_words())];
    assert.deepEqual(await told(), ["true", true, true]);
    await page.locator("#frame-viewer .vw-view").first().focus();
    await page.keyboard.press("k");
    await settle(page);
    assert.deepEqual(await told(), ["false", false, false]);
    await button.click();
    await settle(page);
    assert.deepEqual(await told(), ["true", true, true]);
});

test("the button is dead, looks dead and says why under a cut and on a body without a rendered surface", async () => {
    const button = rendered_button();
    const told = async () => [await button.isDisabled(), await button.getAttribute("aria-pressed"), await button.getAttribute("title"),
                              await button.evaluate((one) => Number(getComputedStyle(one).opacity))];
    const [skin] = truth.skins, [limb] = truth.samples.filter(({ run }) => run.startsWith("limb"));
    await show_sample(skin, "skin", { rendered: true });
    assert.deepEqual(await told(), [false, "true", "show the rendered surface in place of the tets' boundary", 1]);
    await show_sample(skin, "skin", { rendered: true, cut: "z" });
    assert.deepEqual(await told(), [true, "false", "no rendered surface while the tets are cut", 0.45]);
    await page.locator("#frame-viewer .vw-view").first().focus();
    await page.keyboard.press("k");
    assert.equal(await page.evaluate(() => window.viewer.state.now.rendered), true);
    await show_sample(limb, "skin", { rendered: true });
    assert.deepEqual(await told(), [true, "false", "this body has no rendered surface but its tets' boundary", 0.45]);
});

test("the legend's numbers are the record's", async () => {
    for (const [run, largest_m] of Object.entries(truth.largest_error_m)) {
        await show_sample({ run, frame: 0, label: "lbs" }, "error");
        const end = page.locator("#frame-viewer .vw-marks span").last(), text = await end.textContent();
        assert.equal(Number(await end.getAttribute("data-value")), 1000 * largest_m);
        assert.ok(Math.abs(Number(text) - 1000 * largest_m) <= 0.005 * 1000 * largest_m, text);
    }
    await show({ colour: "ratio" });
    assert.deepEqual(await page.locator("#frame-viewer .vw-marks span").allTextContents(), ["0.5", "1", "1.5"]);
});

test("the slider moves the vertices, the clock and the address", async () => {
    await show_sample({ run: truth.samples[0].run, frame: 0, label: "lbs" });
    const before_move = await drawn_positions();
    await page.locator('#frame-viewer input[aria-label="frame"]').focus();
    await page.keyboard.press("End");
    await settle(page);
    const after_move = await drawn_positions();
    const moved_m = Math.max(...after_move.map((value, i) => Math.abs(value - before_move[i])).filter((value) => !Number.isNaN(value)));
    assert.ok(moved_m > 0.05, `${moved_m} m`);
    const last = await page.evaluate(() => window.viewer.viewer.run.frames.at(-1));
    assert.match(await page.locator("#frame-viewer .vw-time").textContent(), new RegExp(`^frame ${last} \\(last\\),`));
    assert.match(await page.evaluate(() => location.hash), new RegExp(`frame=${last}&`));
});

test("play moves on and stops", async () => {
    await page.locator('#frame-viewer button[aria-label="play the frames"]').click();
    await page.waitForFunction(() => window.viewer.state.now.at > 0 && window.viewer.state.now.at < 5);
    await page.locator('#frame-viewer button[aria-label="pause"]').click();
    const stopped = await page.evaluate(() => window.viewer.state.now.at);
    await page.waitForTimeout(400);
    assert.equal(await page.evaluate(() => window.viewer.state.now.at), stopped);
});

function camera_position() {
    return page.evaluate(() => window.viewer.viewer.views.camera.position.toArray());
}

test("keys: a frame on, colours, bones, cut, turn; the focus is seen", async () => {
    await show({ at: 0, colour: "skin", bones: false, cut: null });
    await page.locator("#frame-viewer .vw-panel select").first().focus();
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.className), "vw-view");
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
    await page.keyboard.press(".");
    const camera = await camera_position();
    for (const key of ["e", "b", "c", "ArrowLeft"]) await page.keyboard.press(key);
    const now = await page.evaluate(() => window.viewer.state.now);
    assert.deepEqual([now.at, now.colour, now.bones, now.cut.axis, outline], [1, "error", true, "z", "solid"]);
    assert.notDeepEqual(await camera_position(), camera);
});

test("a cut shows fewer tets, cut open", async () => {
    await show({ cut: null });
    const whole = await page.evaluate(() => window.viewer.viewer.panels.map((panel) => panel.body.tets.length));
    await page.locator('#frame-viewer select[aria-label="cut the tets by a plane"]').selectOption("y");
    await settle(page);
    const { faces, kept, tets } = await page.evaluate(() => {
        const { viewer } = window.viewer;
        const kept = viewer.meshes.mesh.kept.reduce((a, b) => a + b, 0);
        return { faces: viewer.panels.map((panel) => panel.body.tets.length), kept, tets: viewer.run.tets };
    });
    assert.ok(kept > 0 && kept < tets);
    assert.ok(faces.every((count) => count === faces[0]) && faces[0] !== whole[0]);
});

test("dragging one panel turns all", async () => {
    await show({ cut: null, bones: false });
    const box = await page.locator("#frame-viewer .vw-view").nth(1).boundingBox();
    const drawn = () => page.evaluate(() => window.viewer.viewer.panels.map((_, at) =>
        window.viewer.pixels(at).reduce((sum, byte, i) => (sum * 31 + byte * (i % 7)) % 1e9, 0)));
    const first = await drawn();
    await page.mouse.move(box.x + 40, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 120, box.y + 80, { steps: 4 });
    await page.mouse.up();
    await settle(page);
    (await drawn()).forEach((sum, panel) => assert.notEqual(sum, first[panel], `panel ${panel}`));
});

test("a claim's link opens its pose", async () => {
    for (const pose of truth.poses) {
        await page.locator("#frame-viewer .vw-poses a", { hasText: pose.claim }).click();
        await page.waitForFunction((claim) => window.viewer.state.now.claim === claim, pose.claim);
        const { run, frame, colour } = await page.evaluate(() => {
            const { now } = window.viewer.state;
            return { run: now.run, frame: window.viewer.viewer.run.frames[now.at], colour: now.colour };
        });
        assert.deepEqual({ run, frame, colour }, { run: pose.run, frame: pose.frame, colour: pose.colour });
        const told = await page.locator("#frame-viewer .vw-claim").textContent();
        assert.ok(told.startsWith(`${pose.claim}.`));
        assert.match(told, new RegExp(`Colour: ${{ skin: "skin", ratio: "volume ratio", error: "distance to FEM" }[pose.colour]}\\.$`));
        const { drawn, known } = await page.evaluate(() => {
            const { viewer, state: { now } } = window.viewer;
            return { drawn: viewer.panels[0].body.tets.length, known: viewer.run.surface?.corners.length };
        });
        if (known) assert.equal(drawn, known / 3, `${pose.claim}: not the rendered surface`);
        if (pose.panels) assert.deepEqual(await page.evaluate(() => window.viewer.state.now.panels), pose.panels.split(","));
    }
});

test("without an address the first claim's pose is open", async () => {
    const other = await open_viewer(file);
    try {
        const [pose] = truth.poses;
        const { run, frame, claim, rendered } = await other.page.evaluate(() => {
            const { viewer, state: { now } } = window.viewer;
            return { run: now.run, frame: viewer.run.frames[now.at], claim: now.claim, rendered: now.rendered };
        });
        assert.deepEqual({ run, frame, claim, rendered }, { run: pose.run, frame: pose.frame, claim: pose.claim, rendered: true });
    } finally {
        await other.close();
    }
});

for (const [name, width, height] of [["desktop", 1280, 900], ["phone", 390, 844]]) {
    test(`nothing is wider than ${width} px, every control can be pressed`, async () => {
        const other = await open_viewer(file, "#claim=C09", { width, height, touch: width < 500 });
        try {
            const wide = await other.page.evaluate(() => [...document.querySelectorAll("#frame-viewer, #frame-viewer *")]
                .filter((one) => one.getBoundingClientRect().right > innerWidth + 0.5).map((one) => one.className || one.tagName));
            assert.deepEqual(wide, []);
            assert.ok(await other.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
            const controls = other.page.locator("#frame-viewer").locator("button, select, input");
            const faulty = await controls.evaluateAll((all) => all.filter((one) => !one.getAttribute("aria-label")
                || (one.offsetParent && one.getBoundingClientRect().height < 30)).map((one) => one.outerHTML));
            assert.deepEqual(faulty, []);
            const cut = await other.page.locator("#frame-viewer .vw-panel select").evaluateAll((all) => all.filter((one) => {
                const pen = document.createElement("canvas").getContext("2d");
                pen.font = getComputedStyle(one).font;
                return pen.measureText(one.selectedOptions[0].text).width + 20 > one.clientWidth;  // plus the width of the arrow
            }).map((one) => one.selectedOptions[0].text));
            assert.deepEqual(cut, []);
            if (pictures) await other.page.screenshot({ path: `${pictures}/viewer_${name}.png`, fullPage: true });
            assert.deepEqual(other.problems, []);
        } finally {
            await other.close();
        }
    });
}

test("nothing was reported on the way", () => assert.deepEqual(opened.problems, []));
