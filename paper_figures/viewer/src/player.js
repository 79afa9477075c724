// Plays the recorded frames at a given rate, in a loop.

const frames_per_second = 12;

export class Player {
    constructor(state, count) {
        this.state = state;
        this.count = count;
        state.on_change((now, changed) => { if (changed.has("playing") && now.playing) this.run(performance.now()); });
    }

    run(since) {
        requestAnimationFrame((time) => {
            if (!this.state.now.playing) return;
            const due = time - since >= 1000 / frames_per_second;
            if (due) this.state.set({ at: (this.state.now.at + 1) % this.count() });
            this.run(due ? time : since);
        });
    }
}
