// Reference: the definition. The whole first screen is visible in a desktop window.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, page, use_page } from "./browser.mjs";

use_page(() => open(process.env.PBS_REPORT_PAGE));

test("all four answers are seen before anything is scrolled", async () => {
    assert.deepEqual(page.viewportSize(), { width: 1280, height: 900 });
    const ends = await page.locator(".first-screen > .card").evaluateAll((all) => all.map((one) =>
        [one.className, one.getBoundingClientRect().bottom + scrollY, one.scrollHeight - one.clientHeight]));
    assert.equal(ends.length, 4);
    for (const [name, bottom, hidden] of ends) assert.ok(bottom <= 900 && hidden <= 0, `${name} ends at ${bottom} px, ${hidden} px hidden`);
});
