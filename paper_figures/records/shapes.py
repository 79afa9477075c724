"""The shapes of the JSON records that are read. A record of another shape is refused with the file, field, value and
rule.

    run = record_shapes.read(folder / "run.json", record_shapes.run)

A shape is a Rule for a single value; {"key": shape, "other?": shape} for an object in which `other` may be missing and
members that are not named here are ignored; {"*": shape} for an object of any keys; [shape] for a list; (shape, shape)
for a list of that length; a function for a shape that depends on the value.
"""
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass

import records

most_shown = 60  # characters of a value shown in a message


@dataclass(frozen=True)
class Rule:
    words: str
    holds: Callable


def one_of(*words):
    return Rule(f"one of {', '.join('null' if word is None else word for word in words)}", lambda value: value in words)


def is_number(value):
    return type(value) in (int, float) and abs(value) <= sys.float_info.max


def with_member(member, having, other):
    """An object of one shape if it has this member, otherwise of another shape."""
    return lambda value: having if isinstance(value, dict) and member in value else other


anything = Rule("anything", lambda value: True)
text = Rule("a text", lambda value: isinstance(value, str) and not any("\ud800" <= letter <= "\udfff"
                                                                       for letter in value))
text_or_none = Rule("a text or null", lambda value: value is None or text.holds(value))
truth = Rule("true or false", lambda value: isinstance(value, bool))
number = Rule("a number", is_number)
figure = Rule("a number or null", lambda value: value is None or is_number(value))  # null: not finite
whole = Rule("a whole number", lambda value: is_number(value) and isinstance(value, int))


def refuse(file, field, value, words):
    shown = json.dumps(value)
    shown = shown if len(shown) <= most_shown else shown[:most_shown] + "..."
    raise records.RecordsMissing(f"{file}: {field + ' = ' if field else ''}{shown}: expected {words}")


def check(file, value, shape, field=""):
    """Raises RecordsMissing if a record's value, or one inside it, is not of this shape."""
    if isinstance(shape, Rule):
        if not shape.holds(value):
            refuse(file, field, value, shape.words)
    elif callable(shape):
        check(file, value, shape(value), field)
    elif isinstance(shape, dict):
        if not isinstance(value, dict):
            refuse(file, field, value, "an object")
        for key, inner in members(file, value, shape, field):
            check(file, value[key], inner, f"{field}.{key}" if field else key)
    else:
        if not isinstance(value, list):
            refuse(file, field, value, "a list")
        if isinstance(shape, tuple) and len(value) != len(shape):
            refuse(file, field, value, f"a list of {len(shape)}")
        for place, one in enumerate(value):
            check(file, one, shape[place] if isinstance(shape, tuple) else shape[0], f"{field}[{place}]")


def members(file, value, shape, field):
    """(value, its shape) of each existing member; RecordsMissing if a required one is missing."""
    for name, inner in shape.items():
        if name == "*":
            yield from ((key, inner) for key in value)
        elif (key := name.removesuffix("?")) in value:
            yield key, inner
        elif key == name:
            raise records.RecordsMissing(f"{file}: {field + '.' if field else ''}{key}: missing")


def read(file, shape):
    record = records.read_json(file)
    check(file, record, shape)
    return record


first_schema = Rule("1", lambda value: value == 1)  # of repeated.json
third_schema = Rule("3", lambda value: value == 3)
fourth_schema = Rule("4", lambda value: value == 4)  # of claims.json
provenance = {"version?": text, "git_revision?": text, "git_dirty?": truth, "compiler?": text, "flags?": text,
              "build_type?": text, "cpu_model?": text, "logical_cpus?": whole, "threads?": whole,
              "libraries?": {"*": text}, "input_hashes?": {"*": text}}
deformer = {"label": text, "name": text, "variant": text,
            "options?": {"k_stretch?": number,  # XPBD records whether it jiggles, PBS with which stiffness
                         "jiggle?": lambda value: {"k_stretch": number} if isinstance(value, dict) else truth}}
scene = {"reference?": {"name?": text}, "fem?": [{"name": text, "model": text, "element_order": whole}],
         "character?": {"body?": text}, "motion?": {"clip?": text}, "runs?": [deformer]}
run = {"schema?": third_schema, "provenance?": provenance, "scene?": scene, "work?": {},
       "outcome?": {"frames?": whole, "frames_with_overlap?": whole}}
shown_run = {"scene": {"character": {"body": text}, "motion": {}, "runs": [deformer]}}  # a run shown frame by frame
judged_run = {"outcome": {"frames": whole}}  # a run compared with a reference

plan = {"extent?": text, "runs": [{"name": text}], "left_out?": [{"scene": text, "reason": text}]}

verdict = one_of("holds", "fails", "mixed", "not_shown", "inconclusive", "untestable", "definition",
                 "inconsistent_in_print", "not_computable")
key = {name + "?": text for name in ("body", "motion", "pose", "joint", "deformer", "variant", "reference", "order",
                                     "precision", "masses", "constraint", "initial_guess", "tolerance", "load",
                                     "ladder", "factor", "second_factor", "model", "equation", "gradient_of",
                                     "reading")}
key |= {name + "?": number for name in ("angle_deg", "time_s", "vertices", "vertices_to", "k_stretch", "k_stretch_to",
                                        "k_bind", "young_pa", "iterations", "iterations_to", "time_step_s",
                                        "time_step_to_s")}
judged = {"value": figure, "threshold_low": figure, "threshold_high": figure, "threshold": text, "holds": truth}
excluded = one_of(None, "nothing_to_see", "no_control", "nothing_to_compare_with", "censored")
tested = key | judged | {"quantity?": text, "unit": text, "low": figure, "high": figure, "n": whole,
                         "excluded": excluded, "limit?": one_of("at_least", "at_most", "more_than"),
                       "parts?": [judged | {"quantity": text, "unit?": text, "low": figure, "high": figure}]}
printed = key | judged | {"quantity": text}
facts = {"held": whole, "n": whole, "share": figure, "least": figure, "median": figure, "most": figure,
         "excluded_cases": {"*": whole}, "quantities": [text], "of": key, "over": key,
         "thresholds": [key | {"low": figure, "high": figure, "threshold": text, "quantity?": text}]}
selection = facts | {"name": text, "role": one_of("negative_control", "positive_control", "comparison"),
                     "behaves": truth, "cases": [tested]}
difference = {"field": text, "least_at": text, "least": number, "most_at": text, "most": number}
claim = facts | {"id": text, "statement": text, "place": text, "study": text, "reason": text, "verdict": verdict,
                 "rule": one_of("cases", "single", "printed", "definition", "untestable"), "case_fields": [text],
                 "source": text, "why_inconclusive": one_of("none", "too_few_cases", "control_without_record",
                                                            "control_misbehaves", "chance"),
                 "range": text, "interval_low": figure, "interval_high": figure, "chance": figure, "q": figure,
                 "differs": lambda value: anything if value is None else difference, "fixed_at": text,
                 "thresholds_fixed_at": text, "short": text, "measured": text_or_none, "asked": text_or_none,
                 "without_body": [{"body": text, "verdict": verdict}],
                 "threshold_ranges": [key | {"end": one_of("low", "high"), "threshold": number, "low": figure,
                                             "high": figure, "quantity?": text}],
                 "held_out": lambda value: claim if isinstance(value, dict) else anything,
                 "cases": [with_member("unit", tested, printed)], "controls": [selection], "compared": [selection],
                 "readings": [selection], "excluded_scenes": [{"scene": text, "reason": text}], "missing": [text],
                 "runs": [text]}
claims = {"schema": fourth_schema, "quantities": {"*": {"title": text, "unit": text}}, "claims": [claim]}

# What this machine measured again of the record: how many numbers or frames agree. The record's verdicts stand beside
# it, in claims.json.
repeated = {"schema": first_schema, "text": text, "first": text,
            "claims": {"*": {"compared": whole, "agree": whole, "text": text}}}

reliability = {"name": text, "count": number, "of": number, "command": text, "revision": text, "note?": text}
