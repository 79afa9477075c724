// Keys, buttons, links and the slider of the viewer do what their labels state, on a desktop and on a phone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { in_window, open, page, settle, test_in_windows, test_that_nothing_was_reported } from "./browser.mjs";
import { drawn_positions, file, pictures, show, show_sample, truth } from "./viewer_page.mjs";

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
        // Camera and target each round their sum with the step once, and so do the two differences: six roundings of
        // half an epsilon.
        const farthest = Math.max(...[first, second].map(({ target, eye }) => Math.hypot(...target)
                                                         + Math.hypot(...eye)));
        second.eye.forEach((part, at) => assert.ok(Math.abs(part - first.eye[at]) <= 3 * Number.EPSILON * farthest,
                                                   key));
    }
});

test("the slider moves the vertices, the clock and the address", async () => {
    await show_sample({ run: truth.samples[0].run, frame: 0, label: "lbs" });
    const before_move = await drawn_positions();
    await page.locator('#frame-viewer input[aria-label="frame"]').focus();
    await page.keyboard.press("End");
    await settle(page);
    const after_move = await drawn_positions();
    const moved_m = Math.max(...after_move.map((value, i) => Math.abs(value - before_move[i]))
                                 .filter((value) => !Number.isNaN(value)));
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
    await show({ cut: null, bones: false, panels: ["lbs", "pbs"] });
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
        const stated = await page.locator("#frame-viewer .vw-claim").textContent();
        assert.ok(stated.startsWith(`${pose.claim}.`));
        assert.match(stated,
                     new RegExp(
                         `Colour: ${{ skin: "skin", ratio: "volume ratio", error: "difference" }[pose.colour]}\\.$`));
        const { drawn, known } = await page.evaluate(() => {
            const { viewer, state: { now } } = window.viewer;
            return { drawn: viewer.panels[0].body.tets.length, known: viewer.run.surface?.corners.length };
        });
        if (known) assert.equal(drawn, known / 3, `${pose.claim}: not the rendered surface`);
        if (pose.panels) assert.deepEqual(await page.evaluate(() => window.viewer.state.now.panels),
                                          pose.panels.split(","));
    }
});

test("without an address LBS, PBS and the reference play by themselves, unless the reader prefers less motion",
     async () => {
    const { page: other, problems, close } = await open(file);
    try {
        await other.evaluate(() => window.viewer.ready);
        await other.waitForFunction(() => window.viewer.state.now.playing && window.viewer.state.now.at > 2);
        const { labels, reference, colour } = await other.evaluate(() => {
            const { viewer, state: { now } } = window.viewer;
            return { labels: now.panels, reference: viewer.run.reference, colour: now.colour };
        });
        assert.deepEqual([labels, colour], [["lbs", "pbs", reference], "error"]);
        await other.emulateMedia({ reducedMotion: "reduce" });
        await other.reload();
        await other.evaluate(() => window.viewer.ready);
        assert.equal(await other.evaluate(() => window.viewer.state.now.playing), false);
        assert.deepEqual(problems, []);
    } finally {
        await close();
    }
});

test("the copied link opens the same view again", async () => {
    await show({ at: 2, colour: "error" });
    await page.evaluate(() => {
        const { turn, zoom, shift } = window.viewer.viewer.actions();
        turn(30, 12);
        zoom(0.7);
        shift(0.1, -0.05);
    });
    await page.locator("#frame-viewer button", { hasText: "copy link" }).click();
    await page.waitForFunction(() => /[?#].*view=/.test(location.href));
    const seen = (on) => on.evaluate(() => ({ at: window.viewer.state.now.at, colour: window.viewer.state.now.colour,
                                              panels: window.viewer.state.now.panels,
                                              view: window.viewer.viewer.views.seen() }));
    const here = await seen(page);
    await in_window(file, new URL(page.url()).hash, {}, async (other) => {
        const there = await seen(other);
        assert.deepEqual({ ...there, view: [] }, { ...here, view: [] });
        // The link has four digits.
        there.view.forEach((one, at) => assert.ok(Math.abs(one - here.view[at]) <= 1e-3 * Math.max(1, Math.abs(one)),
                                                  `${one}`));
    });
});

test_in_windows("nothing is wider than the window, every control can be pressed", file, "#claim=C09a",
                async (other, name) => {
    const wide = await other.evaluate(() => [...document.querySelectorAll("#frame-viewer, #frame-viewer *")]
        .filter((one) => one.getBoundingClientRect().right > innerWidth + 0.5)
            .map((one) => one.className || one.tagName));
    assert.deepEqual(wide, []);
    assert.ok(await other.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    const controls = other.locator("#frame-viewer").locator("button, select, input");
    const faulty = await controls.evaluateAll((all) => all.filter((one) => !one.getAttribute("aria-label")
        || (one.offsetParent && one.getBoundingClientRect().height < 30)).map((one) => one.outerHTML));
    assert.deepEqual(faulty, []);
    const cut = await other.locator("#frame-viewer .vw-panel select").evaluateAll((all) => all.filter((one) => {
        const pen = document.createElement("canvas").getContext("2d");
        pen.font = getComputedStyle(one).font;
        // Plus the width of the arrow.
        return pen.measureText(one.selectedOptions[0].text).width + 20 > one.clientWidth;
    }).map((one) => one.selectedOptions[0].text));
    assert.deepEqual(cut, []);
    if (pictures) await other.screenshot({ path: `${pictures}/viewer_${name}.png`, fullPage: true });
});

test_that_nothing_was_reported();
