// Reference: the definition. On a phone one finger scrolls the page and does not change the view; two fingers rotate
// and zoom the view and do not move the page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open_viewer, page, settle, use_page } from "./browser.mjs";

let client;

use_page(async () => {
    const shown = await open_viewer(process.env.PBS_VIEWER_PAGE, "", { width: 390, height: 844, touch: true });
    client = await shown.page.context().newCDPSession(shown.page);
    await shown.page.evaluate(() => { document.body.style.paddingBottom = "2000px"; });
    return shown;
});

function state() {
    return page.evaluate(() => {
        const { camera, target } = window.viewer.viewer.views, eye = camera.position.clone().sub(target);
        return { scrolled: scrollY, scale: visualViewport.scale, away: eye.length(), up: eye.y / eye.length(),
                 around: Math.atan2(eye.x, eye.z), target: target.toArray() };
    });
}

function touch(type, points) {
    return client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
}

// Moves each finger from one place to another, relative to the middle of the first panel [px]; returns the state before
// and after.
async function gesture(from, to, steps = 12) {
    await page.evaluate(() => document.querySelector("#frame-viewer .vw-view").scrollIntoView({ block: "center" }));
    await settle(page);
    const { x, y, width, height } = await page.locator("#frame-viewer .vw-view").first().boundingBox();
    const place = (share) => from.map((start, finger) => [0, 1].map((axis) =>
        [x + width / 2, y + height / 2][axis] + start[axis] + share * (to[finger][axis] - start[axis])));
    const first = await state();
    for (let fingers = 1; fingers <= from.length; ++fingers) await touch("touchStart", place(0).slice(0, fingers));
    for (let step = 1; step <= steps; ++step) {
        await touch("touchMove", place(step / steps));
        await page.waitForTimeout(16);
    }
    await touch("touchEnd", []);
    await page.waitForTimeout(500);  // until scrolling has ended
    await settle(page);
    return [first, await state()];
}

function assert_near(value, expected, within) {
    assert.ok(Math.abs(value - expected) <= within, `${value}, expected ${expected}`);
}

test("one finger upwards scrolls the page and leaves the view level", async () => {
    const [before, after] = await gesture([[0, 0]], [[0, -120]]);
    assert.ok(after.scrolled > before.scrolled + 60, `from ${before.scrolled} to ${after.scrolled} px`);
    assert_near(after.up, before.up, 1e-6);
    assert_near(after.away, before.away, 1e-6);
});

test("one finger sideways turns the view about the vertical", async () => {
    const [before, after] = await gesture([[0, 0]], [[60, 0]]);
    assert.equal(after.scrolled, before.scrolled);
    assert.ok(Math.abs(after.around - before.around) > 0.2);
    assert_near(after.up, before.up, 1e-6);
});

test("two fingers drawn apart come nearer by as much; the page keeps its size", async () => {
    const [before, after] = await gesture([[-30, 0], [30, 0]], [[-60, 0], [60, 0]]);
    assert_near(after.away / before.away, 0.5, 0.05);
    assert.deepEqual([after.scrolled, after.scale], [before.scrolled, before.scale]);
});

test("two fingers shift the view once the button says so, and turn it after", async () => {
    const button = page.locator("#frame-viewer button", { hasText: "two fingers shift" });
    await page.locator("#frame-viewer .vw-more > summary").tap();
    const upwards = () => gesture([[-30, 10], [30, 10]], [[-30, -15], [30, -15]]);
    await button.tap();
    assert.equal(await button.getAttribute("aria-pressed"), "true");
    const [before, after] = await upwards();
    // The body moves up with them.
    assert.ok(after.target[1] < before.target[1] - 0.005, `from ${before.target} to ${after.target} m`);
    for (const kept of ["up", "around"]) assert_near(after[kept], before[kept], 1e-3);
    assert.equal(after.scrolled, before.scrolled);
    await button.tap();
    const [first, second] = await upwards();
    assert.deepEqual(second.target, first.target);
    assert.ok(Math.abs(second.up - first.up) > 0.05, `from ${first.up} to ${second.up}`);
});
