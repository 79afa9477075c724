// Checks that the points of a line are in the CSV of its figure: each point's numbers in one row, each axis in one column and one unit. The
// number on one axis may also be part of the name of the column for the other axis ("change_24_pct").

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
        const standing = new Set(rows.filter(({ numbers }) => numbers.some(([of, number]) => of === column && same(unit * number, value))));
        if (standing.size === 0) return null;
        found.push(standing);
    }
    return found;
}

// names: for each point the number that is part of the column's name; values: the number in that column.
function stand_under_names(rows, names, values) {
    return units.some((unit) => values.every((value, at) => rows.some(({ numbers }) => numbers.some(([column, number]) =>
        column.includes(`_${names[at]}_`) && same(unit * number, value)))));
}

// The rows that contain all of those words that occur in any row; all rows if none of the words does.
export function rows_about(rows, words) {
    const known = words.filter((word) => rows.some(({ texts }) => texts.has(word)));
    const about = rows.filter(({ texts }) => known.every((word) => texts.has(word)));
    return about.length ? about : rows;
}

// rows: see records.mjs; points: for each the shown numbers, equally many for all.
export function stand_in(rows, points) {
    const axes = points[0].map((_, axis) => points.map((point) => point[axis]));
    if (axes.length === 1) return readings(rows, axes[0]).length > 0;
    const [across, up] = axes.map((said) => readings(rows, said));
    return across.some((of_x) => up.some((of_y) => of_x.every((standing, at) => [...standing].some((row) => of_y[at].has(row)))))
        || stand_under_names(rows, axes[0], axes[1]) || stand_under_names(rows, axes[1], axes[0]);
}
