"""Recorded frames of a run in the layout of the study `frames`: two tets that grow, so that every number can be
predicted."""
import json
import pathlib

from synthetic_records import write_table

rest = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)]
tets = [(0, 1, 2, 3), (1, 2, 3, 4)]
labels = {"nh_p1": 1.0, "lbs": 1.1, "dqs": 1.2, "pbs": 1.05}  # the rate at which each grows
vtu = pathlib.Path(__file__).with_name("synthetic.vtu").read_text()
skin = pathlib.Path(__file__).with_name("synthetic.vtp").read_text()
# The tet and the weights of each point of the skin.
carriers = [(0, (0.25, 0.25, 0.25, 0.25)), (1, (-0.5, 0.5, 0.5, 0.5)), (0, (1.0, 0.0, 0.0, 0.0))]


def positions_of(label, frame):
    """Five points [m]; they grow by the label's rate and move along x."""
    scale = 1 + 0.1 * labels[label] * frame
    return [(scale * x + 0.3 * frame, scale * y, scale * z) for x, y, z in rest]


def skin_of(positions):
    """Three points [m], carried by the tets."""
    return [tuple(sum(share * positions[corner][axis] for share, corner in zip(shares, tets[tet])) for axis in range(3))
            for tet, shares in carriers]


def ratios_of(label, frame):
    """The first tet is inverted in frame 2 of LBS."""
    return (-0.25 if (label, frame) == ("lbs", 2) else 1 + 0.1 * frame, 0.5)


def text(rows):
    return " ".join(str(value) for row in rows for value in row)


def error_m(label, frame):
    return max(sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5
               for p, q in zip(positions_of(label, frame), positions_of("nh_p1", frame)))


def write_skin(folder):
    """The rendered surface at rest, and the tets that carry it."""
    (folder / "surface_rest.vtp").write_text(skin.format(positions=text(skin_of(rest))))
    write_table(folder / "embedding.csv", [
        {"point": point, "tet": tet} | {f"barycentric_{corner}": share for corner, share in enumerate(shares)}
        for point, (tet, shares) in enumerate(carriers)])


def write_bones(folder, frames):
    """bones.csv: two bones along x, in frame f at z = f; bones_rest.csv: the same at z = 0."""
    columns = [f"{end}_{axis}_m" for end in ("head", "tail") for axis in "xyz"]

    def bones_at(z):
        return [{"bone": bone, "parent": ""} | dict(zip(columns, (at, 0, z, at + 1, 0, z)))
                for bone, at in (("upper", 0), ("forearm", 1))]

    write_table(folder / "bones_rest.csv", bones_at(0))
    write_table(folder / "bones.csv",
                [{"frame": frame, "time_s": frame / 100} | bone for frame in range(frames) for bone in bones_at(frame)])


def write_frames(results, scene="limb_twist", frames=4, body="limb", not_reached=()):
    """DIR/frames/SCENE; volume_change_pct of LBS is smallest in frame 2. not_reached: (label, frame) whose solve did
    not converge."""
    folder = results / "frames" / scene
    (folder / "frames").mkdir(parents=True)
    (folder / "run.json").write_text(json.dumps({"scene": {
        "character": {"body": body}, "motion": {}, "reference": {"name": "nh_p1"},
        "runs": [{"label": label, "name": label, "variant": "default"} for label in labels]}}))
    rows = []
    for frame in range(frames):
        for label in labels:
            ratios = ratios_of(label, frame)
            rows.append({"scene": scene, "deformer": label, "variant": "default",
                         "iterations": 24 if label == "pbs" else "", "frame": frame, "time_s": frame / 100,
                         "volume_change_pct": -abs(frame - 2) or -9,
                         "inverted_tets": sum(ratio <= 0 for ratio in ratios), "j_min": min(ratios),
                         "error_joint_pct": 10 * frame, "error_linf_m": error_m(label, frame),
                         "min_section_pct": 100 - frame, "angle_deg": 10 * frame,
                         "outcome": "not_converged" if (label, frame) in not_reached else "finished"})
            (folder / "frames" / f"{label}_{frame:06}.vtu").write_text(vtu.format(
                rest=text(rest), ratios=text([ratios]), positions=text(positions_of(label, frame)), corners=text(tets)))
    write_table(folder / "metrics.csv", rows)
    write_bones(folder, frames)
    if body != "limb":
        write_skin(folder)
