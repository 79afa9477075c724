// The records from which a report was made, to be compared with the page.
import fs from "node:fs";
import path from "node:path";

export const file = process.env.PBS_REPORT_PAGE, pictures = process.env.PBS_VIEWER_PICTURES;
export const results = path.dirname(file);
export const claims = JSON.parse(fs.readFileSync(path.join(results, "claims.json"), "utf8")).claims;

export const undrawn = JSON.parse(fs.readFileSync(process.env.PBS_VIEWER_TRUTH)).undrawn;  // figures that do not exist

// A figure's CSV: for each row its numbers, an array of [column, number] pairs, and its texts; "1654 / 1716" is two numbers of one column.
export function rows_of(name) {
    const [header, ...rows] = cells_of(fs.readFileSync(path.join(results, "figures", `${name}.csv`), "utf8"));
    const numbers_of = (row) => row.flatMap((cell, at) => numbers_in(cell).map((number) => [header[at], number]));
    return rows.map((row) => ({ texts: new Set(row), numbers: numbers_of(row) }));
}

function numbers_in(cell) {
    return cell.split(" / ").filter((part) => part.trim() !== "").map(Number).filter((number) => !Number.isNaN(number));
}

// Rows of a study's CSV as objects, column -> text.
export function table(name) {
    const [header, ...rows] = cells_of(fs.readFileSync(path.join(results, name), "utf8"));
    return rows.map((row) => Object.fromEntries(header.map((column, at) => [column, row[at]])));
}

// Folders of a study that contain this file.
export function runs_with(study, name) {
    const there = (run) => fs.existsSync(path.join(results, study, run, name));
    return fs.readdirSync(path.join(results, study)).filter(there);
}

export function json(name) {
    return JSON.parse(fs.readFileSync(path.join(results, name), "utf8"));
}

// The cells of each line; a cell in quotes may contain commas.
function cells_of(text) {
    return text.trim().split("\n").map((line) => [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)]
        .map(([, quoted, plain]) => (quoted ?? plain).replaceAll('""', '"')));
}
