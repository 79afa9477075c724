# Doxygen reads `///`, and the headers use `//`: a comment before or after a declaration becomes its documentation, the first
# comment that of the file, and an indented line in it code. Lines keep their numbers; \file takes the line of #pragma once.
BEGIN { several = "^ *[A-Za-z_][A-Za-z_0-9:<>, ]* +[a-z_0-9]+( = [^(){},]*)?(, *[a-z_0-9]+( = [^(){},]*)?)+;  +// " }

# Splits `TYPE a = 1.0, b = 2.0;` into single declarations, each with the comment, which Doxygen would give only to the last one. If there
# is another comment above, it belongs to the first declaration, and the one behind to the last.
function each_declared(code, text,    start, type, rest, names, n, i, line) {
    match(code, /^ *(const )?[A-Za-z_][A-Za-z_0-9:]*(<[^=;()]*>)?[&*]? +/)
    type = substr(code, 1, RLENGTH)
    rest = substr(code, RLENGTH + 1, length(code) - RLENGTH - 1)
    n = split(rest, names, /, */)
    for (i = 1; i <= n; ++i) line = line (i == 1 ? type : substr(type, match(type, /[^ ]/))) names[i] ";  /**< " text " */ "
    return line
}

function escaped(text) { gsub(/[\\@#<>%&$]/, "\\\\&", text); gsub(/::/, "\\::", text); return text }

function flush(closing) { if (held != "") print held closing; held = "" }

FNR == 1 { print "/// \\file"; in_head = 1 }
/^#pragma once/ { in_head = 0; flush(in_code ? " \\endcode" : ""); in_code = 0; next }

/^ *\/\// {
    start = index($0, "//")
    text = substr($0, start + 2)
    is_code = text ~ /^   /
    flush(in_code && !is_code ? " \\endcode" : "")
    is_told = 1
    held = substr($0, 1, start - 1) "///" (is_code ? (in_code ? "" : " \\code{.cpp}") text : escaped(text))
    in_code = is_code
    next
}

{
    flush(in_code ? " \\endcode" : "")
    in_code = 0
    place = match($0, /[;,{}]  +\/\/ /)
    if (place && !is_told && $0 ~ several && $0 !~ /^ *(using|return) /)
        print each_declared(substr($0, 1, place), escaped(substr($0, RLENGTH + place)))
    else if (place && $0 !~ /^#|namespace /) print substr($0, 1, place) "  ///< " escaped(substr($0, place + RLENGTH))
    else if (match($0, /^[ A-Za-z_0-9]+  \/\/ /)) print substr($0, 1, RLENGTH - 5) "  ///< " escaped(substr($0, RLENGTH + 1))
    else print
    is_told = 0
}
END { flush(in_code ? " \\endcode" : "") }
