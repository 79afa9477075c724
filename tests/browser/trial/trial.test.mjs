// Reference: the records of the trial. Its page shows the sentence, the warnings, and the model's own surface as each
// deformer moves it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { page, settle, test_figures_on_a_phone, test_that_nothing_was_reported } from "../browser.mjs";
import { assert_carried, colours_of, file, pictures, truth } from "../viewer_page.mjs";

async function show(label, frame) {
    await page.evaluate(([panel, at]) => {
        location.hash = `run=${window.viewer.state.now.run}&frame=${at}&colour=skin&panels=${panel}&surface=rendered`;
    }, [label, frame]);
    await page.waitForFunction(([panel, at]) => {
        const { viewer, state: { now } } = window.viewer;
        return now.panels[0] === panel && viewer.run.frames[now.at] === at && now.rendered && now.colour === "skin";
    }, [label, frame]);
    await settle(page);
}

// The picture of the first panel as text.
function picture() {
    return page.evaluate(() => window.viewer.pixels(0).join());
}

test("the sentence and every warning and note are visible", async () => {
    assert.ok(truth.notes.length > 0);  // on the choice of the animation
    for (const words of [truth.summary, ...truth.warnings, ...truth.notes]) {
        const place = page.getByText(words, { exact: true }).first();
        assert.ok(await place.isVisible(), words);
    }
    assert.equal(await page.locator("#warnings li").count(), truth.warnings.length);
});

test("the table has a row for each deformer", async () => {
    const rows = await page.locator("#summary tbody tr").count();
    assert.equal(rows, truth.deformers.length);
});

test("the viewer begins with the model's surface", async () => {
    assert.ok(await page.evaluate(() => window.viewer.state.now.rendered));
    assert.equal(await page.evaluate(() => window.viewer.viewer.run.surface.points), truth.points);
    assert.equal(await page.evaluate(() => window.viewer.viewer.run.frames.length), truth.frames);
});

for (const sample of truth.samples) {
    const { label, frame } = sample;
    test(`the surface is where ${label} moves it in frame ${frame}`, async () => {
        await show(label, frame);
        await assert_carried(sample);
        if (pictures) await page.locator("#frame-viewer")
            .screenshot({ path: `${pictures}/trial_${label}_${frame}.png` });
    });
}

// A ball of the tube's thickness at the far end of the run's sphere covers this share of a panel. The tube is as thick
// and longer.
function least_share() {
    return page.evaluate(() => {
        const { views, run } = window.viewer.viewer, { camera, sphere: { middle, radius } } = views,
            [low, high] = run.rest_range("y");
        const height_m = 2 * (camera.position.distanceTo(middle) + radius) * Math.tan(camera.fov / 2 * Math.PI / 180);
        return Math.PI * ((high - low) / 2 / height_m) ** 2 / views.aspect();
    });
}

test("the moving body is in the picture from the first view, near by and from afar", async () => {
    for (const factor of [1, 0.5, 4]) {
        await page.evaluate((times) => {
            const { reset, zoom } = window.viewer.viewer.actions();
            reset();
            zoom(times);
        }, factor);
        for (const frame of [0, truth.frames - 1]) {
            await show("pbs", frame);
            const { drawn } = await colours_of(0);
            const least = await least_share();
            assert.ok(drawn > least,
                      `${factor} times the distance: ${drawn} of the pixels in frame ${frame}, at least ${least}`);
        }
    }
    await page.evaluate(() => window.viewer.viewer.actions().reset());
});

test("another frame is another picture, and the same frame the same", async () => {
    await show("pbs", 0);
    const first = await picture();
    await show("pbs", truth.frames - 1);
    const last = await picture();
    await show("pbs", 0);
    assert.notEqual(first, last);
    assert.equal(await picture(), first);
});

test("each deformer can be chosen", async () => {
    for (const label of truth.deformers) await show(label, truth.frames - 1);
});

test_figures_on_a_phone(file);

test_that_nothing_was_reported();
