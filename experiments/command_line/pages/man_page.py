"""pbskin(1) in the man macros (man(7)), dated today, or by SOURCE_DATE_EPOCH if a build has to repeat to the bit."""
import datetime
import os
import time

statuses = (("0", "finished, whatever the verdicts"),
            ("1", "a bound does not hold (measure), or a verdict could not be computed (reproduce); an internal error"),
            ("2", "bad input or usage"),
            ("3", "numerical breakdown in a run that was expected to finish"),
            ("130", "interrupted; what was finished is kept"))
variables = (("PBSKIN_MODULES", "folder of the program's modules; beside the program by default"),
             ("NO_COLOR", "set: no colours"))


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def shown(option):
    """An option's names and value as the synopsis and the list have them."""
    value = f"\\fI{escaped(option['value'])}\\fR" if option["value"] else ""
    if not option["names"]:
        return f"\\fI{escaped(option['name'].upper())}\\fR" + (" ..." if option["repeated"] else "")
    names = ", ".join(f"\\fB{escaped(name)}\\fR" for name in option["names"])
    return f"{names} {value}".rstrip()


def entry(option):
    meaning = option["meaning"] + (f" (one of {', '.join(option['choices'])})" if option["choices"] else "")
    return [".TP", shown(option), escaped(meaning)]


def synopsis(program, verb):
    words = [f"\\fB{program['name']} {verb['name']}\\fR"]
    for option in verb["options"]:
        if not option["names"]:
            words.append(shown(option) if option["required"] else f"[{shown(option)}]")
    return " ".join(words + ["[\\fIOPTION\\fR ...]"])


def title_line(name, section, version, manual):
    date = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())),
                                           datetime.timezone.utc).date()
    return f'.TH {name} {section} "{date}" "pbskin {version}" "{manual}"'


def text(program, version):
    lines = [title_line("PBSKIN", 1, version, "User Commands"), ".SH NAME",
             f"pbskin \\- {escaped(program['meaning'].removeprefix('pbskin: '))}", ".SH SYNOPSIS"]
    for number, verb in enumerate(program["verbs"]):
        lines += ([".br"] if number else []) + [synopsis(program, verb)]
    lines += [".SH OPTIONS"]
    for option in program["options"]:
        lines += entry(option)
    lines += [".SH VERBS"]
    for verb in program["verbs"]:
        lines += [f".SS {verb['name']}", escaped(verb["meaning"])]
        for option in verb["options"]:
            lines += entry(option)
    lines += [".SH EXIT STATUS"]
    for status, meaning in statuses:
        lines += [".TP", status, escaped(meaning)]
    lines += [".SH ENVIRONMENT"]
    for name, meaning in variables:
        lines += [".TP", f"\\fB{name}\\fR", escaped(meaning)]
    lines += [".SH SEE ALSO", "\\fBpbskin\\-scene\\fR(5)"]
    return "\n".join(lines) + "\n"
