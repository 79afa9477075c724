"""The recorded frame that shows a claim best: the one in which a recorded number of a deformer is at its extreme. The viewer opens it by a
link, `#run=limb_twist&frame=18&colour=ratio&claim=C01`."""
import math

# claim, run, deformer and its column, which extreme, colouring, panels, description of the frame
poses = (
    ("C01", "limb_twist", "lbs", "volume_change_pct", min, "ratio", "", "LBS loses most volume"),
    ("C02", "human_jump", "pbs", "volume_change_pct", "far", "ratio", "", "PBS is farthest from the volume at rest"),
    ("C03", "human_jump", "pbs_increment", "error_linf_m", max, "error", "lbs,pbs,pbs_increment,nh_p1",
     "PBS without the start from LBS is farthest from FEM"),
    ("C04", "limb_twist", "lbs", "min_section_pct", min, "skin", "", "LBS has its thinnest section"),
    ("C05", "limb_bend", "dqs", "error_joint_pct", max, "error", "", "DQS errs most at the joint"),
    ("C09", "human_walk", "pbs_jiggle", "error_linf_m", max, "error", "lbs,pbs_no_zone,pbs_jiggle,nh_p1",
     "jiggling flesh is farthest from FEM; for comparison, the same stiffness without a jiggling zone"),
    ("C12", "human_jump", "pbs", "error_joint_pct", max, "error", "", "PBS with 24 iterations errs most at the joints"),
)


def position_of(values, extreme):
    """The index of the extreme among the recorded values; None without values."""
    known = [(abs(value) if extreme == "far" else value, at) for at, value in enumerate(values) if value is not None]
    known = [(value, at) for value, at in known if math.isfinite(value)]
    if not known:
        return None
    return (max if extreme == "far" else extreme)(known, key=lambda pair: pair[0])[1]


def poses_of(runs):
    """The poses whose run and deformer are packed, in the format of the viewer."""
    named = {run["name"]: run for run in runs}
    found = []
    for claim, run, label, column, extreme, colour, panels, what in poses:
        known = {deformer["label"]: deformer for deformer in named[run]["deformers"]} if run in named else {}
        if label not in known:
            continue
        panels = ",".join(panel for panel in panels.split(",") if panel in known)
        at = position_of(known[label]["figures"][column], extreme)
        if at is not None:
            found.append({"claim": claim, "run": run, "frame": named[run]["frames"][at], "colour": colour, "panels": panels, "what": what})
    return found


def link_of(pose):
    panels = f"&panels={pose['panels']}" if pose["panels"] else ""
    return f"#run={pose['run']}&frame={pose['frame']}&colour={pose['colour']}{panels}&claim={pose['claim']}"
