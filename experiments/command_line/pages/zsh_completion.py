"""The completion of zsh, by its own _arguments."""


def quoted(text):
    """Inside single quotes, and inside the brackets and colons of _arguments."""
    for special in "\\[]:":
        text = text.replace(special, "\\" + special)
    return text.replace("'", "'\\''")


def action(option):
    if option["choices"]:
        return "(" + " ".join(option["choices"]) + ")"
    if option.get("listed"):
        names = f"$(pbskin list {option['listed']} 2>/dev/null | awk '\\''/^  / {{ print $1 }}'\\'')"
        return "{_alternative \"names\\:name\\:($names)\" \"files\\:file\\:_files\"}".replace("$names", names)
    return "_files" if option["value"] == "TEXT" else " "


def specifications(option):
    meaning = quoted(option["meaning"])
    value = f":{quoted(option['value'].lower())}:{action(option)}" if option["value"] else ""
    if not option["names"]:
        place = "*" if option["repeated"] else "" if option["required"] else ":"
        return [f"'{place}:{quoted(option['name'])}:{action(option)}'"]
    return [f"'{'*' if option['repeated'] else ''}{name}[{meaning}]{value}'" for name in option["names"]]


def arguments(options):
    return " ".join(specification for option in options for specification in specifications(option))


def text(program):
    lines = ["#compdef pbskin", "# zsh completion of pbskin; written from its own command line",
             "local -a verbs=(" + " ".join(f"'{verb['name']}:{quoted(verb['meaning'])}'"
                                           for verb in program["verbs"]) + ")",
             "local context state state_descr line", "typeset -A opt_args",
             f"_arguments -C {arguments(program['options'])} '1:verb:->verb' '*::argument:->argument'",
             "case $state in", "    verb) _describe verb verbs ;;", "    argument)", "        case $line[1] in"]
    for verb in program["verbs"]:
        lines.append(f"            {verb['name']}) _arguments {arguments(verb['options'])} ;;")
    return "\n".join(lines + ["        esac ;;", "esac"]) + "\n"
