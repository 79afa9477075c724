// Reference: the records. The viewer in a real browser draws and states what the study `frames` wrote, within the
// stated quantisation. The rendered surface lies where the tets carry it, and a cut shows the tets in its place.
import assert from "node:assert/strict";
import { test } from "node:test";
import { opened, page, settle, test_that_nothing_was_reported } from "./browser.mjs";
import {
    apart, assert_carried, colours_of, drawn_positions, legend_words, pictures, roundings, show, show_sample, truth,
} from "./viewer_page.mjs";

test("the page opens from disk, alone and without a word on the console", () => assert.deepEqual(opened.problems, []));

test("every panel is drawn", async () => {
    const panels = await page.locator("#frame-viewer .vw-panel").count();
    assert.equal(panels, 3);
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
        return { colours: [...geometry.attributes.colour.array.subarray(0, 3 * vertices.length)],
                 vertices: [...vertices], tets: [...tets] };
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
        made.vertices.forEach((_, corner) =>
                                  assert.equal(is_same(inverted, made.colours.slice(3 * corner, 3 * corner + 3)),
                                               is_inverted(corner), `corner ${corner}`));
        const shown = made.vertices.map((_, corner) => corner).filter((corner) => !is_inverted(corner));
        const kept = { colours: shown.flatMap((corner) => made.colours.slice(3 * corner, 3 * corner + 3)),
                       vertices: shown };
        assert_shades(kept, shades, (at) => {
            const ratio = sample.ratios[made.tets[Math.floor(shown[at] / 3)]];
            return [place(ratio - rounding), place(ratio + rounding)];
        }, 5);
    });
    if (sample.label === sample.reference) continue;
    test(`vertices have the colour of their distance on record: ${name}`, async () => {
        await show_sample(sample, "error");
        const { shades } = truth.colours.error, made = await painted(), last = shades.length - 1;
        const { step_m, most_mm } = await page.evaluate(() => {
            const { step_m: step, difference_mm } = window.viewer.viewer.run;
            return { step_m: step, most_mm: difference_mm };
        });
        const place = (distance_m) =>
            Math.round(last * Math.min(1, Math.max(0, sample.mm_per_m * distance_m) / most_mm));
        const rounding_m = Math.sqrt(3) * (step_m + roundings(sample.positions_m, 4));  // rounding of both bodies
        assert_shades(made, shades, (corner) => {
            const distance_m = sample.distances_m[made.vertices[corner]];
            return [place(distance_m - rounding_m), place(distance_m + rounding_m)];
        }, 5);
    });
}

test("overlap and touching skin have the colours of the recorded depths", async () => {
    const [sample] = truth.samples.filter(({ depths_um }) => depths_um.some((depth) => depth > 0));
    await show_sample(sample, "contact");
    const made = await painted(), { touching, shades } = truth.colours.contact, skin = rgb_of(truth.colours.skin);
    const deepest_mm = await page.evaluate(() => window.viewer.viewer.run.deepest_mm), last = shades.length - 1;
    const shade_at = (mm) => shades[Math.round(last * Math.min(1, Math.max(0, mm / deepest_mm)))];
    made.vertices.forEach((v, corner) => {
        const shade = made.colours.slice(3 * corner, 3 * corner + 3), depth = sample.depths_um[v];
        const expected = depth === 0 ? [skin] : depth < 0 ? [rgb_of(touching)] :
            [-0.25, 0.25].map((off_mm) => rgb_of(shade_at(1e-6 * sample.mm_per_m * depth + off_mm)));
        assert.ok(expected.some((one) => is_same(one, shade)), `vertex ${v}, depth ${depth} um`);
    });
});

test("the first number under a panel is the frame's distance of the skin on record", async () => {
    const [sample] = truth.samples.filter(({ figures: { skin_rms_mm }, label, reference }) => skin_rms_mm > 0
                                          && label !== reference);
    await show_sample(sample, "error");
    const words = await page.locator("#frame-viewer .vw-first").first().textContent();
    assert.match(words, /mm from the reference, volume/);
    assert.ok(Math.abs(parseFloat(words) / sample.figures.skin_rms_mm - 1) <= 0.005, words);
});

// Red, green and blue of the darkest pixel around a place [m] in the first panel.
function darkest_at(place) {
    return page.evaluate(([x, y, z]) => {
        const { viewer } = window.viewer, bytes = window.viewer.pixels(0), { camera, renderer } = viewer.views;
        const box = viewer.panel_elements[0].view.getBoundingClientRect(), ratio = renderer.getPixelRatio();
        const seen = camera.position.clone().set(x, y, z).project(camera), width = Math.round(box.width * ratio);
        const [across, up] = [(seen.x + 1) / 2 * box.width * ratio,
                              (seen.y + 1) / 2 * box.height * ratio].map(Math.round);
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
    const marks = () => page.locator("#frame-viewer .vw-mark")
        .evaluateAll((all) => all.map((one) => one.getClientRects().length > 0));
    const shades = async () => new Set((await painted()).colours.map((part) => part.toFixed(3))).size;
    assert.deepEqual(await marks(), [false]);
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

test("the legend's numbers are the record's", async () => {
    // One in a hundred recorded distances is larger than the end of the scale before it is rounded up to 1, 2 or 5; of
    // the packed frames.
    for (const [run, distance_mm] of Object.entries(truth.distance_of_99_pct_mm)) {
        await show_sample({ run, frame: 0, label: "lbs" }, "error");
        const end = Number(await page.locator("#frame-viewer .vw-marks span").last().getAttribute("data-value"));
        assert.ok(end >= 0.9 * distance_mm && end <= 2.6 * distance_mm,
                  `${run}: ${end} mm, on record ${distance_mm} mm`);
    }
    await show({ colour: "ratio" });
    assert.deepEqual(await page.locator("#frame-viewer .vw-marks span").allTextContents(), ["0.5", "1", "1.5"]);
});

function rendered_button() {
    return page.locator("#frame-viewer button", { hasText: "rendered skin" });
}

for (const sample of truth.skins) {
    const name = `${sample.run}, ${sample.label}, frame ${sample.frame}`;
    test(`points of the rendered surface are the record's: ${name}`, async () => {
        await show_sample(sample, "skin", { rendered: true });
        await assert_carried(sample);
        assert.match(await legend_words(), /^the rendered surface, carried by the tets/);
        if (pictures) await page.locator("#frame-viewer")
            .screenshot({ path: `${pictures}/viewer_${sample.run}_${sample.label}.png` });
    });
    test(`a cut shows the tets in place of the rendered surface: ${name}`, async () => {
        await show_sample(sample, "error", { rendered: true, cut: "z" });
        const drawn = await drawn_positions(), step_m = await page.evaluate(() => window.viewer.viewer.run.step_m);
        assert.equal(drawn.length, sample.positions_m.length);
        const { count, largest_m } = apart(drawn, sample.positions_m);
        assert.ok(count > 300 && count < drawn.length, `${count} coordinates drawn`);
        assert.ok(largest_m <= step_m / 2 + roundings(sample.positions_m, 2), `${largest_m} m apart`);
        assert.match(await legend_words(), /^distance of a vertex from the reference/);
    });
}

test("k and the button show the rendered surface or the tets; legend and address follow", async () => {
    await show_sample(truth.skins[0], "ratio", { rendered: true });
    const button = rendered_button();
    const shown = async () => [await button.getAttribute("aria-pressed"), /surface=rendered/.test(page.url()),
                              /carries the skin/.test(await legend_words())];
    assert.deepEqual(await shown(), ["true", true, true]);
    await page.locator("#frame-viewer .vw-view").first().focus();
    await page.keyboard.press("k");
    await settle(page);
    assert.deepEqual(await shown(), ["false", false, false]);
    await button.click();
    await settle(page);
    assert.deepEqual(await shown(), ["true", true, true]);
});

test("the button is dead, looks dead and says why under a cut and on a body without a rendered surface", async () => {
    const button = rendered_button();
    const shown = async () => [await button.isDisabled(), await button.getAttribute("aria-pressed"),
                               await button.getAttribute("title"),
                               await button.evaluate((one) => Number(getComputedStyle(one).opacity))];
    const [skin] = truth.skins, [limb] = truth.samples.filter(({ run }) => run.startsWith("limb"));
    await show_sample(skin, "skin", { rendered: true });
    assert.deepEqual(await shown(), [false, "true", "show the rendered surface in place of the tets' boundary", 1]);
    await show_sample(skin, "skin", { rendered: true, cut: "z" });
    assert.deepEqual(await shown(), [true, "false", "no rendered surface while the tets are cut", 0.45]);
    await page.locator("#frame-viewer .vw-view").first().focus();
    await page.keyboard.press("k");
    assert.equal(await page.evaluate(() => window.viewer.state.now.rendered), true);
    await show_sample(limb, "skin", { rendered: true });
    assert.deepEqual(await shown(), [true, "false", "this body has no rendered surface but its tets' boundary", 0.45]);
});

test_that_nothing_was_reported();
