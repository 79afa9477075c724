// Numbers as the page shows them.

// Three significant digits; a dash if nothing is recorded.
export function shown(value) {
    if (value === null || value === undefined || Number.isNaN(value)) return "\u2013";
    if (value === 0) return "0";
    const text = Math.abs(value) >= 100 ? String(Math.round(value)) : String(Number(value.toPrecision(3)));
    return text.replace("-", "\u2212");
}

export function signed(value) {
    return value > 0 ? `+${shown(value)}` : shown(value);
}
