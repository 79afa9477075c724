// Reference: the records and the definition of the page. It opens from disk, without other files, in a desktop and a
// phone window, and contains the viewer. The values under the pointer are in each figure's CSV, nothing overlaps or
// exceeds the window, every part is reachable by keyboard, and the page can be printed. Tests whose names begin with
// "the report" need no figures (browser_test.py).
import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { in_window, open_viewer, page, settle, test_figures_on_a_phone, test_in_windows, test_that_nothing_was_reported,
         use_page } from
    "./browser.mjs";
import { file, pictures, rows_about, rows_of, stand_in, undrawn } from "./records.mjs";

// Opens the sections, not the lines of the claims.
function unfold(on) {
    return on.evaluate(() => document.querySelectorAll("section > details:not(.claim)")
                           .forEach((part) => { part.open = true; }));
}

use_page(async () => {
    const shown = await open_viewer(file);
    // Otherwise it scrolls for a while, which hides the values under the pointer.
    await shown.page.emulateMedia({ reducedMotion: "reduce" });
    await unfold(shown.page);
    return shown;
});

test("the report stays below 12 MB and carries the licence of three.js", () => {
    assert.ok(fs.statSync(file).size < 12e6, `${fs.statSync(file).size} bytes`);
    assert.match(fs.readFileSync(file, "utf8"), /three\.js authors[^]*Permission is hereby granted, free of charge/);
});

test_in_windows("the report", file, "", async (other, name, width, height) => {
    assert.ok(await other.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "it scrolls sideways");
    if (pictures) await other.screenshot({ path: `${pictures}/report_${name}.png` });
    await other.evaluate(() => { location.hash = "claim=C01"; });
    await other.waitForFunction(() => window.viewer.state.now.claim === "C01");
    await other.waitForTimeout(1500);  // smooth scrolling
    await settle(other);
    const { top, bottom } = await other.evaluate(() => document.getElementById("frame-viewer").getBoundingClientRect()
                                                     .toJSON());
    assert.ok(top < height && bottom > 0, `the viewer is at ${top} to ${bottom} px`);
    const ids = await other.evaluate(() => [...document.querySelectorAll("[id]")].map((one) => one.id));
    assert.ok(await other.locator("h2").count() > 3);
    assert.equal(new Set(ids).size, ids.length, "an id twice");
    if (pictures) await other.screenshot({ path: `${pictures}/report_viewer_${name}.png` });
});

test("the verdicts are seen before anything is scrolled, and then the moving character with the answers", async () => {
    assert.deepEqual(page.viewportSize(), { width: 1280, height: 900 });
    const questions = await page.locator(".card > h2, .first-screen .answer > h2").allTextContents();
    assert.deepEqual(questions, [
        "Do the paper\u2019s claims hold?", "How far is PBS from simulated flesh?", "Which method for which time?",
    ]);
    const chips = await page.locator(".claims .chip")
        .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().bottom + scrollY));
    assert.ok(chips.filter((end) => end <= 900).length >= 10, `they end at ${chips} px`);
    assert.deepEqual((await page.locator(".claims .chip").allTextContents()).filter((words) => !/[a-z]{4}/.test(words)),
                     []);
});

test("each claim is a line that opens, with its units, bound and controls on an axis", async () => {
    const lines = page.locator("details.claim"), judged = await page.locator(".claims .chip").count();
    assert.equal(await lines.count(), judged);
    const line = page.locator("#C01"), axis = line.locator("svg.axis");
    for (const part of ["circle", "rect.threshold", "path.control"])
        assert.ok(await axis.locator(part).count() > 0, part);
    assert.match(await axis.getAttribute("aria-label"), /^mean volume loss: .*threshold: 12 to 16/);
    assert.ok(await line.locator("table").first().isHidden());
    await page.locator('.claims a[href="#C01"]').click();
    await page.waitForFunction(() => document.getElementById("C01").open);
    assert.ok(await line.locator("table").first().isVisible());
    await page.evaluate(() => { document.getElementById("C01").open = false; });
});

test("every drawn figure is there, inline; of the others, and of no more, why not", async () => {
    const there = await page.locator("#figures figure")
        .evaluateAll((all) => all.map((one) => one.id.replace("figure-", "")));
    for (const name of there) assert.equal(await page.locator(`#figure-${name} svg.plot`).count(), 1, name);
    const reasons = await page.locator("#figures .not-drawn li").allTextContents();
    const refused = reasons.map((reason) => reason.match(/^figure (\w+): .{10}/)?.[1] ?? reason);
    assert.deepEqual(refused.sort(), undrawn);
    assert.deepEqual(there.filter((name) => undrawn.includes(name)), []);
    assert.ok(there.length >= 8, `${there.length} figures`);
});

// The lines of a plot: the numbers of their points, by label; bars at a named place have one number each, by both
// names.
function lines_of(values) {
    const lines = new Map();
    for (const value of values) {
        const [, label = "", said] = value.match(/^(?:(.*): )?(.*)$/);
        const parts = said.split(", "), is_number = (part) => part.trim() !== "" && !Number.isNaN(Number(part));
        const names = parts.filter((part) => !is_number(part)), numbers = parts.filter(is_number).map(Number);
        const key = JSON.stringify(numbers.length > 1 ? [label] : [...label.split(", "), ...names]);
        if (numbers.length) lines.set(key, [...(lines.get(key) ?? []), numbers]);
    }
    return lines;
}

test("the values under the pointer are the figure's CSV's", async () => {
    const plots = page.locator("svg.plot:has(.values circle)");
    assert.ok(await plots.count() >= 5, `${await plots.count()} plots with values`);
    for (let at = 0; at < await plots.count(); ++at) {
        const plot = plots.nth(at),
            name = await plot.evaluate((one) => one.closest("figure").id.replace("figure-", ""));
        const panels = await plot.locator(".values").evaluateAll((all) => all.map((panel) =>
            [...panel.querySelectorAll("circle")].map((circle) => circle.dataset.value)));
        const rows = rows_of(name), lines = panels.flatMap((values) => [...lines_of(values)]);
        assert.ok(lines.length > 0, `${name}: no number to be checked`);
        for (const [label, points] of lines) {
            const about = points[0].length > 1 ? rows : rows_about(rows, JSON.parse(label));
            assert.ok(stand_in(about, points),
                      `${name}: ${label} is not in its CSV: ${JSON.stringify(points.slice(0, 3))}`);
            // A wrong number may equal that of another row by chance, so that one of the three wrong sets may be found.
            const found = [[1.0137, 0.0211], [1.0291, -0.0137], [1.0473, 0.0319]].filter(([factor, more]) =>
                stand_in(about, points.map((numbers) => numbers.map((number) => factor * number + more))));
            assert.ok(found.length <= 1, `${name}: ${label} would be found in its CSV with any numbers`);
        }
    }
});

test("a value is shown under the pointer, with the names of its axes", async () => {
    const plots = page.locator("svg.plot:has(.values circle)");
    for (let at = 0; at < await plots.count(); ++at) {
        const plot = plots.nth(at), circles = plot.locator(".values circle"), count = await circles.count();
        for (const place of new Set([0, count >> 1, count - 1])) {
            await circles.nth(place).scrollIntoViewIfNeeded();
            await settle(page);  // scrolling hides the values
            await circles.nth(place).hover({ force: true });
            assert.ok(await page.locator("#readout").isVisible(), `plot ${at}: nothing shown`);
            const value = await page.locator(".values circle.shown").getAttribute("data-value");
            assert.ok((await page.locator("#readout").textContent()).startsWith(`${value} (`), `plot ${at}: ${value}`);
        }
    }
});

// The nearest value by the boxes of the circles; the algorithm of page.js itself would prove nothing.
function nearest_value(plot, x, y) {
    return plot.locator(".values circle").evaluateAll((all, [px, py]) => {
        const away = (circle) => {
            const box = circle.getBoundingClientRect();
            return Math.hypot((box.left + box.right) / 2 - px, (box.top + box.bottom) / 2 - py);
        };
        const least = Math.min(...all.map(away));
        return { least, values: all.filter((circle) => away(circle) < least + 0.5)
                     .map((circle) => circle.dataset.value) };
    }, [x, y]);
}

// The first plot with a place next to a value and one far from all values, both in the window [px].
async function plot_with_places(on) {
    for (const plot of await on.locator("svg.plot:has(.values circle)").all()) {
        await plot.scrollIntoViewIfNeeded();
        await on.waitForTimeout(300);  // until scrolling has ended
        const places = await plot.evaluate((one) => {
            const middles = [...one.querySelectorAll(".values circle")].map((circle) => circle.getBoundingClientRect())
                .map((box) => [(box.left + box.right) / 2, (box.top + box.bottom) / 2]);
            const found = {};
            for (let x = 10; x < innerWidth - 10; x += 4)
                for (let y = 10; y < innerHeight - 10; y += 4) {
                    if (document.elementFromPoint(x, y)?.closest("svg.plot") !== one) continue;
                    const least = Math.min(...middles.map(([across, down]) => Math.hypot(across - x, down - y)));
                    if (least > 8 && least < 17) found.beside ??= [x, y];
                    if (least > 24) found.away ??= [x, y];
                }
            return found;
        });
        if (places.beside && places.away) return { plot, ...places };
    }
    return null;
}

test("a value is shown within 20 px of the pointer, the nearest; beyond there is none", async () => {
    const { plot, beside, away } = await plot_with_places(page), shown = page.locator(".values circle.shown");
    await page.mouse.move(...beside);
    const { least, values } = await nearest_value(plot, ...beside);
    assert.ok(least > 7 && least < 18, `${least} px away`);
    assert.ok(values.includes(await shown.getAttribute("data-value")), `none of ${values}`);
    await page.mouse.move(...away);
    assert.equal(await shown.count(), 0);
    assert.ok(await page.locator("#readout").isHidden());
});

test("a finger beside a value shows it, one away from all hides it", async () => {
    await in_window(file, "", { width: 390, height: 844, touch: true }, async (phone) => {
        await unfold(phone);
        const { plot, beside, away } = await plot_with_places(phone), shown = phone.locator(".values circle.shown");
        await phone.touchscreen.tap(...beside);
        await settle(phone);
        const { values } = await nearest_value(plot, ...beside);
        assert.ok(values.includes(await shown.getAttribute("data-value")), `none of ${values}`);
        assert.ok(await phone.locator("#readout").isVisible());
        await phone.touchscreen.tap(...away);
        await settle(phone);
        assert.equal(await shown.count(), 0);
    });
});

test("the arrow keys lead from value to value in a plot", async () => {
    const plot = page.locator("svg.plot:has(.values circle)").first();
    await plot.focus();
    await settle(page);
    const texts = [];
    for (const key of ["ArrowRight", "ArrowRight", "ArrowLeft"]) {
        await page.keyboard.press(key);
        texts.push(await page.locator(".values circle.shown").evaluate((circle) => circle.outerHTML));
    }
    assert.notEqual(texts[0], texts[1]);
    assert.equal(texts[0], texts[2]);
    await page.keyboard.press("Escape");
    assert.ok(await page.locator("#readout").isHidden());
});

test("keys alone get to the viewer, move its time and play", async () => {
    await page.evaluate(() => { window.scrollTo(0, 0); document.activeElement.blur(); });
    let pressed = 0;
    const on_slider = () =>
        page.evaluate(() => document.activeElement.matches('#frame-viewer input[aria-label="frame"]'));
    while (!await on_slider() && ++pressed < 300) await page.keyboard.press("Tab");
    assert.ok(await on_slider(), `not reached by ${pressed} tabs`);
    const at = () => page.evaluate(() => window.viewer.state.now.at);
    await page.keyboard.press("Home");
    await page.keyboard.press("ArrowRight");
    await settle(page);
    assert.equal(await at(), 1);
    await page.keyboard.press("Space");
    await page.waitForFunction(() => window.viewer.state.now.at !== 1);
    await page.keyboard.press("Space");
    assert.equal(await page.evaluate(() => window.viewer.state.now.playing), false);
});

test("a claim's link to its pose takes the focus along", async () => {
    const link = page.locator("details.claim a.pose").first();
    const id = await link.evaluate((one) => {
        one.closest("details").open = true;
        return one.closest("details").id;
    });
    await link.focus();
    await page.keyboard.press("Enter");
    await page.waitForFunction((claim) => window.viewer.state.now.claim === claim, id);
    assert.ok(await page.evaluate(() => document.getElementById("frame-viewer").contains(document.activeElement)));
});

// Elements with text outside the window, except those in a box that scrolls (nothing scrolls on paper); cells of one
// row that overlap; cells whose content is wider than they are.
function faults_of_layout(boxes) {
    const scrolls = (one) => one.closest(`${boxes}.unseen, .skip, #readout, details:not([open])`);
    const seen = (one) => one.getClientRects().length > 0;
    const name = (one) => `${one.tagName} ${one.className} "${one.textContent.slice(0, 40)}"`;
    const beyond = [...document.querySelectorAll("body *")].filter((one) => seen(one) && !scrolls(one)
        && (one.getBoundingClientRect().right > innerWidth + 0.5 || one.getBoundingClientRect().left < -0.5)).map(name);
    const over = [];
    for (const row of document.querySelectorAll("details.claim > summary")) {
        const cells = [...row.children].map((cell) => [cell, cell.getBoundingClientRect()]);
        cells.forEach(([cell, one], at) => cells.slice(at + 1).forEach(([, other]) => {
            const across = Math.min(one.right, other.right) - Math.max(one.left, other.left);
            const down = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
            if (across > 1 && down > 1) over.push(name(cell));
        }));
        over.push(...cells.filter(([cell]) => cell.scrollWidth > cell.clientWidth + 1)
                      .map(([cell]) => `too narrow: ${name(cell)}`));
    }
    return { beyond, over };
}

test_in_windows("nothing is beyond the window or lies over another", file, "", async (other, name) => {
    await unfold(other);
    assert.deepEqual(await other.evaluate(faults_of_layout, ".scroll, pre, "), { beyond: [], over: [] });
    if (pictures) {
        await other.locator("#verdicts").screenshot({ path: `${pictures}/page_verdicts_${name}.png` });
        await other.locator("#figures figure:has(svg)").last()
            .screenshot({ path: `${pictures}/page_figure_${name}.png` });
    }
});

test_figures_on_a_phone(file);

test("on paper the tables are whole, without what can only be pressed", async () => {
    await page.emulateMedia({ media: "print", reducedMotion: "reduce" });
    for (const hidden of ["nav", "#frame-viewer .vw-bars", ".skip"])
        assert.ok(await page.locator(hidden).first().isHidden(), hidden);
    await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
    const printed = page.locator("#frame-viewer .vw-printed");
    await page.waitForFunction(() => document.querySelector(".vw-printed").complete);
    assert.ok(await printed.isVisible() && await printed.evaluate((image) => image.naturalWidth) > 300,
              "no picture of the viewer");
    const clipped = await page.locator(".scroll").evaluateAll((all) => all.filter((one) => one.getClientRects().length
        && getComputedStyle(one).overflowY !== "visible").length);
    assert.equal(clipped, 0);
    const { width, height } = page.viewportSize();
    // A4 at 96 points per inch within Chromium's margins of 1 cm.
    await page.setViewportSize({ width: 718, height: 1046 });
    await settle(page);
    assert.deepEqual(await page.evaluate(faults_of_layout, "pre, "), { beyond: [], over: [] });
    if (pictures) await page.screenshot({ path: `${pictures}/page_paper.png` });
    if (pictures) await page.locator("#verdicts").screenshot({ path: `${pictures}/page_paper_verdicts.png` });
    await page.setViewportSize({ width, height });
    const paper = await page.pdf({ format: "A4", ...(pictures ? { path: `${pictures}/report.pdf` } : {}) });
    assert.ok((paper.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length >= 3);
    await page.emulateMedia({ media: "screen", reducedMotion: "reduce" });
});

test_that_nothing_was_reported();
