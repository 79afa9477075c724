// Reference: the records. The rendered surface of the viewer lies where the tets carry it, and a cut shows the tets in its place.
import assert from "node:assert/strict";
import { test } from "node:test";
import { page, settle, test_that_nothing_was_reported } from "./browser.mjs";
import { apart, drawn_positions, legend_words, pictures, roundings, show_sample, truth } from "./viewer_page.mjs";

function rendered_button() {
    return page.locator("#frame-viewer button", { hasText: "rendered skin" });
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
    const shown = async () => [await button.isDisabled(), await button.getAttribute("aria-pressed"), await button.getAttribute("title"),
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
