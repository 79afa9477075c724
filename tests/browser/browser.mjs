// Debian's Chromium without a screen, without a graphics card and without a network, driven by playwright-core.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const root = fileURLToPath(new URL("../..", import.meta.url));
const program = "/usr/bin/chromium";
const options = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                 "--disable-background-networking"];

// Opens the file in a window of this size; `problems` collects what the page reports, and every address it requests
// except itself.
export async function open(file, hash = "", { width = 1280, height = 900, scale = 1, touch = false,
                                              scheme = "light" } = {}) {
    const { chromium } = createRequire(path.join(root, "paper_figures/viewer/package.json"))("playwright-core");
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), "pbskin_browser_"));
    const context = await chromium.launchPersistentContext(profile, {
        executablePath: program, headless: true, args: options, viewport: { width, height }, deviceScaleFactor: scale,
        hasTouch: touch, colorScheme: scheme,
        timeout: 120000,
    });
    const page = await context.newPage(), problems = [];
    page.setDefaultTimeout(120000);
    page.on("console",
            (message) => { if (["error", "warning"].includes(message.type())) problems.push(message.text()); });
    page.on("pageerror", (error) => problems.push(String(error)));
    const address = pathToFileURL(file).href;
    page.on("request", (request) => {
        if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(address)) problems.push(request.url());
    });
    await page.goto(address + hash);
    const close = async () => {
        await context.close();
        fs.rmSync(profile, { recursive: true, force: true });
    };
    return { page, problems, close };
}

// Opens the file, waits until the viewer is drawn, and stops it.
export async function open_viewer(file, hash, size) {
    const opened = await open(file, hash, size);
    await opened.page.evaluate(() => window.viewer.ready);
    await opened.page.evaluate(() => window.viewer.state.set({ playing: false }));
    await settle(opened.page);
    return opened;
}

// Two frames later, everything requested is on the screen.
export async function settle(page) {
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

// The page of all tests of a file, which is open from before the first one until after the last one.
export let opened, page;

export function use_page(open_it) {
    before(async () => {
        opened = await open_it();
        page = opened.page;
    });
    after(() => opened?.close());
}

export function test_that_nothing_was_reported() {
    test("nothing was reported on the way", () => assert.deepEqual(opened.problems, []));
}

// Checks the file in a window of its own, in which nothing may be reported.
export async function in_window(file, hash, size, check) {
    const other = await open_viewer(file, hash, size);
    try {
        await check(other.page);
        assert.deepEqual(other.problems, []);
    } finally {
        await other.close();
    }
}

// A test in a window of a desktop and in one of a phone; check(page, name of the window, its width and height [px]).
export function test_in_windows(what, file, hash, check) {
    for (const [name, width, height] of [["desktop", 1280, 900], ["phone", 390, 844]])
        test(`${what}, at ${width} px`, () => in_window(file, hash, { width, height, touch: width < 500 },
                                                        (other) => check(other, name, width, height)));
}

// On a phone, in the light and in the dark form: no page scrolls sideways, every figure with all its labels is within
// its box and the window, its letters are large enough to be read, and the bar of the viewer's reference is visible.
const least_letter_px = 8;

export function test_figures_on_a_phone(file) {
    for (const scheme of ["light", "dark"])
        test(`every figure's labels are inside its box at 390 px, ${scheme}`, () =>
            in_window(file, "", { width: 390, height: 844, touch: true, scheme }, async (phone) => {
                await phone.evaluate(() => {
                    for (const part of document.querySelectorAll("section > details:not(.claim)")) part.open = true;
                });
                assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth <= innerWidth),
                          "it scrolls sideways");
                const { figures, faults } = await phone.evaluate(faults_of_figures, least_letter_px);
                assert.ok(figures > 0, "no figure");
                assert.deepEqual(faults, []);
                const bars = await phone.locator(".vw-panel")
                    .evaluateAll((all) => all.map((one) => getComputedStyle(one).borderTopColor));
                assert.ok(bars.length > 0 && (scheme === "light" || !bars.includes("rgb(0, 0, 0)")), `bars: ${bars}`);
            }));
}

function faults_of_figures(least_px) {
    const faults = [], plots = [...document.querySelectorAll("svg.plot")];
    for (const plot of plots) {
        const name = plot.closest("figure").id, box = plot.getBoundingClientRect();
        if (box.left < -0.5 || box.right > innerWidth + 0.5) faults.push(`${name}: wider than the window`);
        for (const label of plot.querySelectorAll("text")) {
            const { left, right, top, bottom } = label.getBoundingClientRect(),
                what = `${name}: ${label.textContent.trim().slice(0, 30)}`;
            if (left < box.left - 1 || right > box.right + 1 || top < box.top - 1 || bottom > box.bottom + 1) {
                const inside = [left - box.left, box.right - right, top - box.top, box.bottom - bottom];
                faults.push(`${what}: ${inside.map(Math.round)} px inside`);
            }
            const { a, b } = label.getScreenCTM(),
                letter_px = parseFloat(getComputedStyle(label).fontSize) * Math.hypot(a, b);
            if (letter_px < least_px) faults.push(`${what}: letters of ${letter_px.toFixed(1)} px`);
        }
    }
    return { figures: plots.length, faults };
}
