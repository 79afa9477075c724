"""Error against run time of each method, and the share of the poses that it solves within a time per frame. Methods
that take flesh are given that of each reference (the table `known`)."""
import textwrap

import records
from drawing import style
from words import compared_methods, looks
from words.number_words import figure

curve_columns = {"table", "method", "budget_ms", "setting", "ms", "share", "share_low", "share_high"}
solved_columns = {"table", "target_pct", "method", "budget_ms", "solved_pct"}
clock_words = {"own": "time as the program states it", "wall": "wall time of the program over its poses"}


def look_of(method, takes):
    """Dashed: the method takes flesh."""
    return style.as_of(method, linestyle=looks.lines["dashed"] if takes else "-", markersize=2.6, linewidth=1.0)


def known(rows):
    return [row for row in rows if row["table"] == "known"]


def takes_of(compared):
    return {row["method"]: row["takes"] for row in known(compared.methods)}


# Error against run time: one point per setting that is chosen for a time, and a bar over the reference variants.

def draw_curve(axes, rows, takes):
    """A dotted line leads from the last point to the right end, since more time changes nothing. Returns it."""
    look = look_of(rows[0]["method"], takes)
    style.plot(axes, rows, "ms", "share_pct", **look)
    axes.vlines(records.numbers(rows, "ms"), *(records.numbers(rows, f"share_{end}_pct") for end in ("low", "high")),
                color=look["color"], linewidth=0.6, alpha=0.5)
    return look["color"], float(rows[-1]["ms"]), float(rows[-1]["share_pct"])


def curve_rows(rows, takes):
    """The curve of each method in per cent of LBS's error. A setting that is chosen for several times is one point."""
    shown = {}
    for row in rows:
        if row["ms"] != "nan" and row["share"] != "nan":
            of_row = style.taken([row], ("method", "setting", "ms"), shown="curve",
                                 takes=takes.get(row["method"], ""))[0]
            shown.setdefault((row["method"], row["setting"]), of_row | {
                f"share{end}_pct": 100.0 * float(row[f"share{end}"]) for end in ("", "_low", "_high")})
    return sorted(shown.values(), key=lambda row: float(row["ms"]))


def error_against_time(results):
    folder = results / "work_precision"
    compared = compared_methods.Compared(folder)
    rows = curve_rows(known(records.table(folder / "curves.csv", curve_columns)), takes_of(compared))
    records.need(rows, f"{folder / 'curves.csv'}: no method with known flesh")
    drawn, ((axes,),) = style.panels(1, 1, height_in=3.2)
    ends = {method: draw_curve(axes, [row for row in rows if row["method"] == method], takes)
            for method, takes in {row["method"]: row["takes"] for row in rows}.items()}
    axes.set(xscale="log", xlabel="time per frame [ms]", ylabel="error [% of LBS's error]")
    last_ms = 1.15 * max(*compared.times_ms, *(ms for _, ms, _ in ends.values()))
    axes.set_xlim(right=last_ms)
    labels = {axes.plot([ms, last_ms], [share, share], color=color, linewidth=0.5, linestyle=(0, (1, 2)),
                        gid="guide")[0]:
              compared_methods.name(method) for method, (color, ms, share) in ends.items()}
    for ms in compared.times_ms:
        axes.axvline(ms, color=style.grey, linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
    style.decades(axes.xaxis)
    style.log_scale(axes.yaxis, [10, 15, 20, 30, 50, 70, 100, 150, 200])
    axes.set_title("dashed: the method is given the flesh", loc="left")
    style.label_ends(axes, labels)
    return drawn, rows + facts_rows(compared, folder)


def facts_rows(compared, folder):
    """What the caption states: the sentences, the number of poses, and the clocks of deformers of the user's own."""
    rows = [{"shown": "answer", "text": text} for text in [*compared.own_answers(), *compared.answers()]]
    rows.append({"shown": "poses", "text": max(int(row["poses"]) for row in compared.methods)})
    return rows + [{"shown": "clock", "method": method, "text": clock_words[clock]}
                   for method, clock in compared_methods.own_clocks(folder).items() if clock in clock_words]


def error_against_time_facts(rows):
    def texts(shown):
        return [row["text"] for row in rows if row["shown"] == shown]

    clocks = "".join(f" {row['method']}: {row['text']}." for row in rows if row["shown"] == "clock")
    of_a_played_frame = next((text for text in texts("answer")
                              if text.startswith(f"Within {compared_methods.played_ms:g} ms")), "")
    title = of_a_played_frame.partition(" (")[0].replace(" %", " % of LBS's error", 1)
    return {"title": title, "answer": " ".join(texts("answer")), "poses": " ".join(texts("poses")), "clocks": clocks}


# The share of the poses that are solved within a time (data profiles: More and Wild 2009).

def draw_solved(axes, rows, takes, last_ms):
    """Methods that solve no pose are named together at the bottom."""
    labels, none = {}, []
    for method in looks.in_order({row["method"] for row in rows}):
        steps = [row for row in rows if row["method"] == method]
        solved = records.numbers(steps, "solved_pct")
        if not any(solved):
            none.append(compared_methods.name(method))
            continue
        ms = records.numbers(steps, "budget_ms")
        look = look_of(method, takes.get(method, "")) | {"marker": None}
        axes.step(ms, solved, where="post", **look)
        to_the_end, = axes.plot([ms[-1], last_ms], [solved[-1]] * 2, gid="guide", **look | {"label": None})
        labels[to_the_end] = compared_methods.name(method)
    if none:
        line, = axes.plot([last_ms], [0], color=style.grey, linestyle="none", gid="guide")
        labels[line] = textwrap.fill(f"none: {', '.join(none)}", 26)
    return labels


def solved_within_time(results):
    folder = results / "work_precision"
    compared = compared_methods.Compared(folder)
    rows = known(records.table(folder / "profiles.csv", solved_columns))
    records.need(rows, f"{folder / 'profiles.csv'}: no method with known flesh")
    takes, last_ms = takes_of(compared), 1.15 * max(records.numbers(rows, "budget_ms"))
    targets = sorted({float(row["target_pct"]) for row in rows})
    drawn, panels = style.panels(len(targets), 1, height_in=1.75, sharex=True)
    labels = {}
    for (axes,), target in zip(panels, targets):
        labels[axes] = draw_solved(axes, [row for row in rows if float(row["target_pct"]) == target], takes, last_ms)
        axes.set(xscale="log", ylim=(-4, 104), ylabel="solved poses [%]")
        axes.set_title(f"error at most {target:g} % of LBS's", loc="left")
    panels[0][0].set_title(f"error at most {targets[0]:g} % of LBS's; dashed: given the flesh", loc="left")
    panels[-1][0].set(xlabel="time per frame [ms]", xlim=(None, last_ms))
    style.decades(panels[-1][0].xaxis)
    for axes, texts in labels.items():
        style.label_ends(axes, texts)
    poses = max(int(row["poses"]) for row in compared.methods)
    return drawn, [row | {"poses": poses} for row in style.taken(rows, sorted(solved_columns - {"table"}))]


def solved_within_time_facts(rows):
    targets = [figure(target) for target in sorted({float(row["target_pct"]) for row in rows})]
    return {"solved": compared_methods.solved_sentence(rows).rstrip("."), "poses": rows[0]["poses"],
            "targets": compared_methods.conjoined(targets, "and")}
