// Notes on the frame that is shown: the kind of FEM, the number of stored frames, their rounding, and the origin of the body.

const locking = "The FEM shown has linear elements (P1), which lock: they are stiffer than the material. The study "
    + "work_precision measures how far they are from quadratic ones, and the reference\u2019s own error. ";

export function note_of(run, every, at) {
    const masked_pct = run.masked_share_pct(at);
    const mark = masked_pct > 0 ? "* In this frame the FEM reference overlaps itself: distances leave out "
        + `${masked_pct.toPrecision(2)} % of the volume. ` : "";
    const kept = every === 1 ? "every recorded frame" : `one of ${every} recorded frames`;
    const step_um = (1e6 * run.step_m).toFixed(1);
    const of_reference = run.labels.includes(run.reference) ? locking : "";
    return `${mark}${of_reference}${run.vertices} vertices, ${run.tets} tets${carried_by(run)}; ${kept}. Positions are rounded to steps of `
        + `${step_um} \u00b5m: each coordinate of a vertex is within half a step of the record's; volume ratios to 1/127 up to 2; `
        + "the numbers are the records' own. A cut goes through the body at rest, so that every panel and frame shows the same tets. "
        + run.rights;
}

function carried_by({ surface, step_m }) {
    if (!surface) return "";
    const within_um = Math.ceil(0.5e6 * step_m * surface.largest_sum);
    const points = `, which carry the ${surface.points} points of the rendered surface`;
    return `${points}, each coordinate within ${within_um} \u00b5m of the record's`;
}
