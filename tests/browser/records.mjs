// The records that a report was made of, to hold the page against them.
import fs from "node:fs";
import path from "node:path";

export const file = process.env.PBS_REPORT_PAGE, pictures = process.env.PBS_VIEWER_PICTURES;
export const results = path.dirname(file);
export const claims = JSON.parse(fs.readFileSync(path.join(results, "claims.json"), "utf8")).claims;

// A figure's CSV: its header and all its numbers.
export function table_of(name) {
    const text = fs.readFileSync(path.join(results, "figures", `${name}.csv`), "utf8");
    const cells = text.split(/[\n,"]/).filter((cell) => cell.trim() !== "");
    return { header: text.split("\n")[0], numbers: cells.map(Number).filter((value) => !Number.isNaN(value)) };
}

export function drawn_figures() {
    const folder = path.join(results, "figures");
    return fs.existsSync(folder) ? fs.readdirSync(folder).filter((name) => name.endsWith(".svg")).map((name) => name.slice(0, -4)) : [];
}
