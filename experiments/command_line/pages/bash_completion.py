"""The completion of bash: the verbs, each verb's options, an option's choices, files elsewhere."""

frame = """# bash completion of pbskin; written from its own command line
_pbskin()
{{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} verb='' index
    COMPREPLY=()
    for ((index = 1; index < COMP_CWORD; ++index)); do
        [[ ${{COMP_WORDS[index]}} == -* ]] || {{ verb=${{COMP_WORDS[index]}}; break; }}
    done
    local options='{options}' words='' files=no
    case $verb in
        '') words='{verbs}' ;;
{cases}
        *) return ;;
    esac
    case $verb:$before in
{values}
    esac
    [[ $word == -* ]] && words=$options
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"; [[ $files == no || $word == -* ]] || compgen -f -- "$word")
}}
complete -o filenames -F _pbskin pbskin
"""


def names_of(options):
    return [name for option in options for name in option["names"]]


def words_of(verb):
    """What may stand in place of the verb's positional words: choices, and names that the program lists."""
    positional = [option for option in verb["options"] if not option["names"]]
    words = " ".join(choice for option in positional for choice in option["choices"])
    kinds = " ".join(option["listed"] for option in positional if option["listed"])
    if kinds:
        words += f"$(pbskin list {kinds} 2>/dev/null | awk '/^  / {{ print $1 }}')"
    return words, "yes" if any(not option["choices"] for option in positional) else "no"


def text(program):
    cases, values = [], []
    for verb in program["verbs"]:
        words, files = words_of(verb)
        listed = f'; words="{words}"' if "$" in words else f"; words='{words}'" if words else ""
        cases.append(f"        {verb['name']}) options='{' '.join(names_of(verb['options']))}'; "
                     f"files={files}{listed} ;;")
        for option in verb["options"]:
            if option["names"] and option["value"]:
                patterns = "|".join(f"{verb['name']}:{name}" for name in option["names"])
                choices = " ".join(option["choices"])
                files = "yes" if option["value"] == "TEXT" and not choices else "no"
                values.append(f"        {patterns}) words='{choices}'; files={files} ;;")
    return frame.format(options=" ".join(names_of(program["options"])),
                        verbs=" ".join(verb["name"] for verb in program["verbs"]), cases="\n".join(cases),
                        values="\n".join(values))
