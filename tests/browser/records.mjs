// The records from which a report was made, to be compared with the page.
import fs from "node:fs";
import path from "node:path";

export const file = process.env.PBS_REPORT_PAGE, pictures = process.env.PBS_VIEWER_PICTURES;
export const results = path.dirname(file);

const { PBS_VIEWER_TRUTH } = process.env;
// Figures that do not exist.
export const undrawn = PBS_VIEWER_TRUTH ? JSON.parse(fs.readFileSync(PBS_VIEWER_TRUTH)).undrawn : [];

// A figure's CSV: for each row its numbers, an array of [column, number] pairs, and its texts; "1654 / 1716" is two
// numbers of one column.
export function rows_of(name) {
    const [header, ...rows] = cells_of(fs.readFileSync(path.join(results, "figures", `${name}.csv`), "utf8"));
    const numbers_of = (row) => row.flatMap((cell, at) => numbers_in(cell).map((number) => [header[at], number]));
    return rows.map((row) => ({ texts: new Set(row), numbers: numbers_of(row) }));
}

function numbers_in(cell) {
    return cell.split(" / ").filter((part) => part.trim() !== "").map(Number).filter((number) => !Number.isNaN(number));
}

// The cells of each line; a cell in quotes may contain commas.
function cells_of(text) {
    return text.trim().split("\n").map((line) => [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)]
        .map(([, quoted, plain]) => (quoted ?? plain).replaceAll('""', '"')));
}

// Checks that the points of a line are in the CSV of its figure: each point's numbers in one row, each axis in one
// column and one unit. The number on one axis may also be part of the name of the column for the other axis
// ("change_24_pct").

const units = [1, 1000, 0.001, 100, 0.01];  // the CSV has the units of the record
const digits = 2e-5;  // values are shown to six digits

function same(number, said) {
    return Math.abs(number - said) <= digits * Math.abs(said) + 1e-15;
}

// For each point the rows that contain it, for every column and unit that contains all points.
function readings(rows, said) {
    const columns = new Set(rows.flatMap(({ numbers }) => numbers.map(([column]) => column)));
    return [...columns].flatMap((column) => units.map((unit) => rows_with(rows, said, column, unit))).filter(Boolean);
}

function rows_with(rows, said, column, unit) {
    const found = [];
    for (const value of said) {
        const standing = new Set(rows.filter(({ numbers }) => numbers.some(([of, number]) => of === column
                                                                           && same(unit * number, value))));
        if (standing.size === 0) return null;
        found.push(standing);
    }
    return found;
}

// names: for each point the number that is part of the column's name; values: the number in that column.
function stand_under_names(rows, names, values) {
    const stands = (names_of, value, unit) => rows.some(({ numbers }) => numbers.some(([column, number]) =>
        column.includes(`_${names_of}_`) && same(unit * number, value)));
    return units.some((unit) => values.every((value, at) => stands(names[at], value, unit)));
}

// The rows that contain all of those words that occur in any row; all rows if none of the words does.
export function rows_about(rows, words) {
    const known = words.filter((word) => rows.some(({ texts }) => texts.has(word)));
    const about = rows.filter(({ texts }) => known.every((word) => texts.has(word)));
    return about.length ? about : rows;
}

// rows: see rows_of; points: for each the shown numbers, equally many for all.
export function stand_in(rows, points) {
    const axes = points[0].map((_, axis) => points.map((point) => point[axis]));
    if (axes.length === 1) return readings(rows, axes[0]).length > 0;
    const [across, up] = axes.map((said) => readings(rows, said));
    return across.some((of_x) =>
                           up.some((of_y) =>
                                       of_x.every((standing, at) => [...standing].some((row) => of_y[at].has(row)))))
        || stand_under_names(rows, axes[0], axes[1]) || stand_under_names(rows, axes[1], axes[0]);
}
