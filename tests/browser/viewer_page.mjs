// The viewer's page for the tests of one file. browser_test.py names the page and a file with samples of the records.
import assert from "node:assert/strict";
import fs from "node:fs";
import { open_viewer, page, settle, use_page } from "./browser.mjs";

export const file = process.env.PBS_VIEWER_PAGE;
export const truth = JSON.parse(fs.readFileSync(process.env.PBS_VIEWER_TRUTH));
export const pictures = process.env.PBS_VIEWER_PICTURES;
use_page(async () => {
    const shown = await open_viewer(file);
    await shown.page.evaluate(() => { document.querySelector(".vw-more").open = true; });
    return shown;
});

// The number of colours in the panel without its ground, and the share of its pixels that differ from the most frequent
// one.
export function colours_of(panel) {
    return page.evaluate((at) => {
        const ground = window.viewer.viewer.panels[at].ground.mesh;
        ground.visible = false;
        const bytes = window.viewer.pixels(at), counts = new Map();
        ground.visible = true;
        for (let i = 0; i < bytes.length; i += 4) {
            const key = (bytes[i] << 16) | (bytes[i + 1] << 8) | bytes[i + 2];
            counts.set(key, (counts.get(key) ?? 0) + 1);
        }
        return { colours: counts.size, drawn: 1 - Math.max(...counts.values()) / (bytes.length / 4) };
    }, panel);
}

export async function show(changes) {
    await page.evaluate((wanted) => window.viewer.state.set(wanted), changes);
    await settle(page);
}

// x y z of each vertex [m] in the first panel; nan where no face is visible.
export function drawn_positions() {
    return page.evaluate(() => [...window.viewer.drawn_positions(0)]);
}

export async function show_sample({ run, frame, label }, colour = "skin", { rendered = false, cut = null } = {}) {
    const also = (rendered ? "&surface=rendered" : "") + (cut ? `&cut=${cut},0.01,below` : "");
    await page.evaluate((hash) => { location.hash = hash; },
                        `run=${run}&frame=${frame}&colour=${colour}&panels=${label}${also}`);
    await page.waitForFunction((wanted) => {
        const { viewer, state: { now } } = window.viewer;
        return now.run === wanted.run && now.panels[0] === wanted.label && now.colour === wanted.colour
            && viewer.run.frames[now.at] === wanted.frame && now.rendered === wanted.rendered
            && (now.cut?.axis ?? null) === wanted.cut;
    }, { run, frame, label, colour, rendered, cut });
    await settle(page);
}

// The largest distance of a drawn coordinate from the record's [m], and the number of coordinates.
export function apart(drawn, recorded) {
    const known = drawn.map((value, i) => Math.abs(value - recorded[i])).filter((value) => !Number.isNaN(value));
    return { count: known.length, largest_m: Math.max(...known) };
}

// The rounding of single precision, in multiples of 2 ** -24 of the largest coordinate [m].
export function roundings(recorded, many) {
    return many * Math.max(...recorded.map(Math.abs)) * 2 ** -24;
}

// The rendered surface is drawn where the tets carry it: half a step of each corner times the absolute weights. The
// record, the weights, the corners, four products and four sums are rounded.
export async function assert_carried({ skin_m, positions_m }) {
    const { step_m, points, largest_sum } = await page.evaluate(() => {
        const { step_m: step, surface } = window.viewer.viewer.run;
        return { step_m: step, points: surface.points, largest_sum: surface.largest_sum };
    });
    const drawn = await drawn_positions(), { count, largest_m } = apart(drawn, skin_m);
    assert.deepEqual([drawn.length, count], [skin_m.length, 3 * points]);
    assert.ok(largest_m <= largest_sum * (step_m / 2 + roundings(positions_m, 12)), `${largest_m} m apart`);
}

export function legend_words() {
    return page.locator("#frame-viewer .vw-caption").textContent();
}
