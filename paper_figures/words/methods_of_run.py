"""Sentences on the methods of a single run: which one is nearest to the reference, how they change the volume, and what
they cost.

A method is a dict of name, error_pct (median over the frames; None without one), volume_pct (of the frame in which it
changes most, None where it is not judged), step_ms, nearest_in (frames), is_compared (False: a trial has excluded it
for its inverted tets) and inverted (the most tets that it turns inside out in a frame).
"""
from words.number_words import counted, figure, listed


def two_digits(value):
    return f"{value:.0f}" if value >= 99.5 else f"{value:.2g}"


def nearest_method(methods):
    """delta mush is nearest to FEM in all 19 frames, 15 %, before PBS, 28 %; it loses 3.7 % of the volume, PBS 1.1
    %."""
    known = sorted((method for method in methods if method["error_pct"] is not None and method["is_compared"]),
                   key=lambda method: method["error_pct"])
    if not known:
        return ""
    best, others = known[0], known[1:]
    # PBS is what is examined.
    other = next((method for method in others if method["name"] == "PBS"), next(iter(others), None))
    frames = sum(method["nearest_in"] for method in methods)
    extent = (f"all {counted(frames, 'frame')}" if best["nearest_in"] == frames
              else f"{best['nearest_in']} of {counted(frames, 'frame')}")
    text = f"{best['name']} is nearest to FEM in {extent}, {two_digits(best['error_pct'])} %"
    text += f", before {other['name']}, {two_digits(other['error_pct'])} %" if other else ""
    changes = [(method, method["volume_pct"]) for method in (best, other) if method
               and method["volume_pct"] is not None]
    words = [f"{'loses' if change < 0 else 'gains'} {two_digits(abs(change))} % of the volume" for _, change in changes]
    if len(words) == 2:
        is_same = (changes[0][1] < 0) == (changes[1][1] < 0)
        words[
            1] = f"{other['name']} {words[1].removesuffix(' of the volume').split(' ', 1)[1] if is_same else words[1]}"
    return f"{text}; it {', '.join(words)}." if words else f"{text}."


def largest_change(methods):
    """The volume changes most under LBS, by -3 %, and least under DQS, by -0.2 %. methods: without the reference."""
    ranked = sorted((method for method in methods if method["volume_pct"] is not None),
                    key=lambda method: abs(method["volume_pct"]))
    if len(ranked) < 2:
        return "The volume over the frames"
    most, least = (f"under {method['name']}, by {figure(round(method['volume_pct'], 3) + 0.0)} %"
                   for method in (ranked[-1], ranked[0]))
    return f"The volume changes most {most}, and least {least}"


def error_and_time(methods):
    """delta mush has the least error, 10.8 %, and takes 0.37 ms per frame; LBS is the fastest, with 31.2 % and 0.009
    ms.
    Empty if no method has an error, since the reference reached no pose."""
    known = [method for method in methods if method["error_pct"] is not None and method["step_ms"] is not None
             and method["is_compared"]]
    if not known:
        return ""
    best, fastest = (min(known, key=lambda method: method[name]) for name in ("error_pct", "step_ms"))
    text = (f"{best['name']} has the least error, {figure(best['error_pct'])} %, and takes {figure(best['step_ms'])} "
            "ms per frame")
    return text if fastest is best else (
        f"{text}; {fastest['name']} is the fastest, with {figure(fastest['error_pct'])} % and "
        f"{figure(fastest['step_ms'])} ms")
