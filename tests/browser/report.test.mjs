// Reference: the definition of the report. It opens from disk, without other files, in a desktop and a phone window, and contains the
// viewer.
import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { settle, test_in_windows } from "./browser.mjs";

const file = process.env.PBS_REPORT_PAGE, pictures = process.env.PBS_VIEWER_PICTURES;

test("the report stays below 25 MB and carries the licence of three.js", () => {
    assert.ok(fs.statSync(file).size < 25e6, `${fs.statSync(file).size} bytes`);
    assert.match(fs.readFileSync(file, "utf8"), /three\.js authors[^]*Permission is hereby granted, free of charge/);
});

test_in_windows("the report", file, "", async (page, name, width, height) => {
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "it scrolls sideways");
    if (pictures) await page.screenshot({ path: `${pictures}/report_${name}.png` });
    await page.evaluate(() => { location.hash = "claim=C01"; });
    await page.waitForFunction(() => window.viewer.state.now.claim === "C01");
    await page.waitForTimeout(1500);  // smooth scrolling
    await settle(page);
    const { top, bottom } = await page.evaluate(() => document.getElementById("frame-viewer").getBoundingClientRect().toJSON());
    assert.ok(top < height && bottom > 0, `the viewer is at ${top} to ${bottom} px`);
    const ids = await page.evaluate(() => [...document.querySelectorAll("[id]")].map((one) => one.id));
    assert.ok(await page.locator("h2").count() > 3);
    assert.equal(new Set(ids).size, ids.length, "an id twice");
    if (pictures) await page.screenshot({ path: `${pictures}/report_viewer_${name}.png` });
});
