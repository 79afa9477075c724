// What is shown, and who wants to know when it changes.
//
// run, at        the run's name, the frame's place in it
// panels         labels of the deformers shown
// colour         skin, ratio, error or inverted
// rendered       the rendered surface in place of the tets' boundary, where the run has one and nothing is cut
// bones, cut     skeleton shown; { axis, at_m, above } or null
// claim          whose pose this is, or null
// playing, follow, shifting: two fingers shift the view rather than turn it

export class State {
    constructor(first) {
        this.now = first;
        this.listeners = [];
    }

    on_change(listener) {
        this.listeners.push(listener);
    }

    set(changes) {
        const changed = Object.keys(changes).filter((key) => this.now[key] !== changes[key]);
        if (changed.length === 0) return;
        this.now = { ...this.now, ...changes };
        for (const listener of this.listeners) listener(this.now, new Set(changed));
    }
}

// Why the rendered surface cannot be shown; null where it can.
export function no_surface_because(run, now) {
    if (!run.surface) return "this body has no rendered surface but its tets' boundary";
    return now.cut ? "no rendered surface while the tets are cut" : null;
}

// Whether the rendered surface is what is drawn.
export function draws_surface(run, now) {
    return now.rendered && no_surface_because(run, now) === null;
}

// The panels that a run can show: those wanted where it has them, filled up to four with its own in order.
export function panels_for(run, wanted) {
    const usual = ["lbs", "dqs", "pbs", run.reference].filter((label) => run.labels.includes(label));
    const kept = (wanted ?? usual).filter((label) => run.labels.includes(label));
    const rest = [...usual, ...run.labels].filter((label) => !kept.includes(label));
    return [...new Set([...kept, ...rest])].slice(0, 4);
}
