// Reference: the records. The whole first screen is visible in a desktop window; its distances and times are those of the tables from which
// they come.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, page, use_page } from "./browser.mjs";
import { file, json, runs_with, table } from "./records.mjs";

use_page(() => open(file));

// Every number in a text, in the format of the page.
function numbers_in(text) {
    return [...text.replaceAll("\u2212", "-").matchAll(/-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g)].map(([number]) => Number(number));
}

// Compares to three digits.
function assert_stated(stated, recorded, what) {
    assert.ok(Math.abs(stated - recorded) <= 0.00501 * Math.abs(recorded), `${what}: ${stated}, on record ${recorded}`);
}

test("all four answers are seen before anything is scrolled", async () => {
    assert.deepEqual(page.viewportSize(), { width: 1280, height: 900 });
    const ends = await page.locator(".first-screen > .card").evaluateAll((all) => all.map((one) =>
        [one.className, one.getBoundingClientRect().bottom + scrollY, one.scrollHeight - one.clientHeight]));
    assert.equal(ends.length, 4);
    for (const [name, bottom, hidden] of ends) assert.ok(bottom <= 900 && hidden <= 0, `${name} ends at ${bottom} px, ${hidden} px hidden`);
});

// The rows that the first screen states for a pose: LBS and the paper's PBS on the same tets, and the reference.
function pose_on_record(run) {
    const rows = table(`work_precision/${run}/points.csv`), reference = rows.find((row) => row.outcome === "reference");
    const k_stretch = json(`work_precision/${run}/run.json`).work?.settings?.scene?.pbs?.k_stretch ?? 0.2;
    const lbs = rows.find((row) => row.deformer === "lbs"), own = rows.filter((row) => row.vertices === lbs?.vertices);
    const pbs = own.find((row) => row.deformer === "pbs" && row.iterations === "24" && row.order === "ordered" && row.precision === "f32"
        && Number(row.k_stretch) === k_stretch && ["", "1"].includes(row.substeps));
    const { body, motion, pose, angle_deg } = rows[0];
    const place = angle_deg ? `${motion} ${Number(angle_deg)}\u00b0` : `clip ${motion}, ${pose.replaceAll("_", " ")}`;
    return { name: `${body}, ${place}`, reference, lbs, pbs };
}

function poses_on_record() {
    return runs_with("work_precision", "points.csv").map(pose_on_record).filter(({ pbs }) => pbs?.error_joint_pct);
}

test("how far from the finite elements is what points.csv says, pose by pose", async () => {
    const poses = poses_on_record(), card = page.locator(".card.far");
    assert.ok(poses.length >= 2, `${poses.length} poses on record`);
    const rows = await card.locator("tbody tr").evaluateAll((all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
    assert.deepEqual(rows.map(([name]) => name).sort(), poses.map(({ name }) => name).sort());
    for (const { name, lbs, pbs, reference } of poses) {
        const recorded = [lbs.error_joint_pct, pbs.error_joint_pct, pbs.reference_error_joint_pct, reference.masked_share_pct];
        const stated = rows.find(([first]) => first === name).slice(1);
        recorded.forEach((value, at) => assert_stated(numbers_in(stated[at])[0], Number(value), `${name}, column ${at + 1}`));
    }
    const ends = ["pbs", "lbs"].flatMap((deformer) => {
        const errors = poses.map((pose) => Number(pose[deformer].error_joint_pct));
        return [Math.min(...errors), Math.max(...errors)];
    });
    const sentence = await card.locator(".answer").textContent();
    assert.match(sentence, new RegExp(`in ${poses.length} poses`));
    numbers_in(sentence.split("is ")[1]).forEach((stated, at) => assert_stated(stated, ends[at], sentence));
});

test("planned poses that are not on record are named", async () => {
    const there = runs_with("work_precision", "points.csv");
    const absent = json("work_precision/plan.json").runs.map(({ name }) => name).filter((name) => !there.includes(name));
    const stated = await page.locator(".card.far .missing").allTextContents();
    assert.equal(stated.length, absent.length ? 1 : 0);
    for (const name of absent) assert.ok(stated[0].includes(name.replaceAll("_", " ")), name);
});

test("the cost is what timing.csv and points.csv say", async () => {
    const [frame, pose] = await page.locator(".card.cost li").allTextContents();
    const of = (variant, precision) => table("timing/timing.csv").filter((row) => row.variant === variant
        && row.precision === precision && row.paper_frames_per_s);
    const ends = (rows, column) => {
        const values = rows.map((row) => Number(row[column]));
        return [Math.min(...values), Math.max(...values)];
    };
    const quick = of("ordered", "f32"), plain = of("plain", "f64");
    const stated = numbers_in(frame.split("): ").slice(1).join("): ").replace("Table 1 prints", "prints"));
    const recorded = [...ends(quick, "total_wall_ms"), ...ends(quick, "frames_per_s"), ...ends(plain, "total_wall_ms"),
                      ...ends(plain, "frames_per_s"), ...ends(plain, "paper_frames_per_s")];
    assert.equal(stated.length, recorded.length, frame);
    stated.forEach((value, at) => assert_stated(value, recorded[at], frame));
    const poses = poses_on_record();
    const times = ["lbs", "pbs", "reference"].flatMap((of_pose) => ends(poses.map((one) => one[of_pose]), "ms_median"));
    const times_stated = numbers_in(pose);
    assert.equal(times_stated.length, times.length, pose);
    times_stated.forEach((value, at) => assert_stated(value, times[at], pose));
});
