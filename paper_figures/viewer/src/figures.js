// Shows the recorded numbers of the frame under each panel.
import { shown, signed } from "./numbers.js";

const lines = [
    { column: "volume_change_pct", name: "volume change", unit: "%", text: signed },
    { column: "inverted_tets", name: "inverted tets", unit: "", text: shown },
    { column: "j_min", name: "smallest ratio", unit: "", text: shown },
    { column: "error_joint_pct", name: "error at joints", unit: "%", text: shown },
    { column: "error_linf_m", name: "largest distance", unit: "mm", text: (value) => shown(value === null ? null : 1000 * value) },
];

export function draw_figures(element, run, label, at) {
    const is_reference = label === run.reference;
    element.replaceChildren(...lines.flatMap(({ column, name, unit, text }) => {
        const value = run.figure(label, column, at);
        const term = document.createElement("dt"), number = document.createElement("dd");
        term.textContent = name;
        const mark = column.startsWith("error") && run.masked_share_pct(at) > 0 ? " *" : "";
        const recorded = text(value) + (unit && value !== null ? `\u202f${unit}` : "") + mark;
        number.textContent = is_reference && column.startsWith("error") ? "reference" : recorded;
        number.dataset.column = column;
        number.dataset.value = value ?? "";
        return [term, number];
    }));
}
