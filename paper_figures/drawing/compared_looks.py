"""The colour, marker and name of each group of deformers in the figures of error against run time."""
import itertools

from drawing import style

brown, grey, olive, violet, crimson = "#8B5A2B", "#999999", "#7F7F00", "#5B2A86", "#B0123B"
groups = {"lbs": ("LBS", style.vermillion, "v"), "lbs_diffused": ("LBS, diffused weights", style.vermillion, "1"),
          "dqs": ("DQS", style.orange, "s"), "dqs_diffused": ("DQS, diffused weights", style.orange, "2"),
          "delta_mush": ("delta mush", style.green, "^"), "delta_mush_diffused": ("delta mush, diffused weights", style.green, "3"),
          "direct_delta_mush": ("direct delta mush", "#4B9B00", "<"),
          "direct_delta_mush_diffused": ("direct delta mush, diffused weights", "#4B9B00", "4"),
          "pbs": ("PBS", style.blue, "o"), "pbs_author": ("first author\u2019s later code", style.sky, "p"),
          "xpbd": ("XPBD", style.purple, "D"), "xpbd_neo_hookean": ("neo-Hookean XPBD", violet, "d"),
          "quasi_newton": ("quasi-Newton", brown, "P"), "vbd": ("vertex block descent", olive, "*"),
          "projective_dynamics": ("projective dynamics", crimson, "h"), "linear_fem": ("linear FEM", grey, "x"),
          "nonlinear_fem": ("nonlinear FEM", style.black, "+")}
group_of_deformer = {"xpbd_small_steps": "xpbd", "fem_linear": "linear_fem", "fem_corotational": "nonlinear_fem",
                     "fem_neo_hookean": "nonlinear_fem", "fem_stable_neo_hookean": "nonlinear_fem"}


own_looks_in_order = list(itertools.product(("#E0218A", "#00857C", "#6A6A00"), ("X", "H", ">", "8", "|", "_")))  # colour, marker
own_looks = {}  # of deformers of the user's own, in the order in which they are drawn


def of(group):
    """Name, colour and marker. A group that is not listed here is a deformer of the user's own, with its name and the next free look."""
    if group in groups:
        return groups[group]
    if group not in own_looks:
        own_looks[group] = (group, *own_looks_in_order[len(own_looks) % len(own_looks_in_order)])
    return own_looks[group]


def short(group):
    """The name on one or two short lines."""
    return of(group)[0].replace(", diffused weights", " diffused")


def group_of(deformer):
    return group_of_deformer.get(deformer, deformer)


def in_order(names):
    """The groups that occur, in the order of the list."""
    return [name for name in groups if name in names] + sorted(set(names) - set(groups))
