// The state of the view, and the functions that are called when it changes.
//
// run, at        the name of the run, and the index of the frame
// panels         labels of the deformers that are shown
// colour         skin, ratio, error or inverted
// rendered       the rendered surface instead of the tets' boundary, if the run has one and nothing is cut
// bones, cut     whether the skeleton is shown; { axis, at_m, above } or null
// claim          the claim whose pose this is, or null
// playing, follow, shifting: two fingers shift the view instead of turning it

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

// The reason why the rendered surface cannot be shown; null if it can.
export function no_surface_because(run, now) {
    if (!run.surface) return "this body has no rendered surface but its tets' boundary";
    return now.cut ? "no rendered surface while the tets are cut" : null;
}

// Whether the rendered surface is drawn.
export function draws_surface(run, now) {
    return now.rendered && no_surface_because(run, now) === null;
}

// The panels that a run can show: the wanted ones that it has, filled up to four with its others in order.
export function panels_for(run, wanted) {
    const usual = ["lbs", "dqs", "pbs", run.reference].filter((label) => run.labels.includes(label));
    const kept = (wanted ?? usual).filter((label) => run.labels.includes(label));
    const rest = [...usual, ...run.labels].filter((label) => !kept.includes(label));
    return [...new Set([...kept, ...rest])].slice(0, 4);
}
