// The elements of the viewer. Every control is a native one, with a name for screen readers.

export function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
        else if (value !== undefined && value !== false) made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children);
    return made;
}

export function select(name, options, on_choice) {
    return element("select", { "aria-label": name, onchange: (event) => on_choice(event.target.value) },
                   ...options.map(([value, text]) => element("option", { value }, text)));
}

export function button(text, name, on_press) {
    return element("button", { type: "button", "aria-label": name, title: name, onclick: on_press }, text);
}

export function slider(name, on_move) {
    return element("input", { type: "range", "aria-label": name, oninput: (event) => on_move(Number(event.target.value)) });
}

export function group(name, ...children) {
    return element("fieldset", {}, element("legend", {}, name), ...children);
}
