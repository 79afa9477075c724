"""Recorded frames of a run in the layout of the study `frames`: two tets that grow, so that every number can be foreseen."""
import csv
import json

rest = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)]
tets = [(0, 1, 2, 3), (1, 2, 3, 4)]
labels = {"snh_p1": 1.0, "lbs": 1.1, "dqs": 1.2, "pbs": 1.05}  # how fast each grows
vtu = """<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="5" NumberOfCells="2">
<PointData><DataArray type="Float64" Name="rest_position" NumberOfComponents="3" format="ascii">{rest}</DataArray></PointData>
<CellData><DataArray type="Float64" Name="volume_ratio" format="ascii">{ratios}</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{positions}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">{corners}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
"""


def positions_of(label, frame):
    """Five points [m]; they grow by the label's rate and move along x."""
    scale = 1 + 0.1 * labels[label] * frame
    return [(scale * x + 0.3 * frame, scale * y, scale * z) for x, y, z in rest]


def ratios_of(label, frame):
    """The first tet turns inside out in frame 2 of LBS."""
    return (-0.25 if (label, frame) == ("lbs", 2) else 1 + 0.1 * frame, 0.5)


def write_frame(file, label, frame):
    def text(rows):
        return " ".join(str(value) for row in rows for value in row)

    file.write_text(vtu.format(rest=text(rest), ratios=text([ratios_of(label, frame)]), positions=text(positions_of(label, frame)),
                               corners=text(tets)))


def error_m(label, frame):
    return max(sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5 for p, q in zip(positions_of(label, frame), positions_of("snh_p1", frame)))


def write_frames(results, scene="limb_twist", frames=4):
    """DIR/frames/SCENE; volume_change_pct of LBS is smallest in frame 2."""
    folder = results / "frames" / scene
    (folder / "frames").mkdir(parents=True)
    (folder / "run.json").write_text(json.dumps({"scene": {
        "character": {"body": "limb"}, "motion": {}, "reference": {"name": "snh_p1"},
        "runs": [{"label": label, "name": label, "variant": "default"} for label in labels]}}))
    columns = ["scene", "deformer", "variant", "iterations", "frame", "time_s", "volume_change_pct", "inverted_tets", "j_min",
               "error_joint_pct", "error_linf_m", "min_section_pct", "angle_deg"]
    with open(folder / "metrics.csv", "w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(columns)
        for frame in range(frames):
            for label in labels:
                ratios = ratios_of(label, frame)
                inverted = sum(ratio <= 0 for ratio in ratios)
                table.writerow([scene, label, "default", 24 if label == "pbs" else "", frame, frame / 100, -abs(frame - 2) or -9, inverted,
                                min(ratios), 10 * frame, error_m(label, frame), 100 - frame, 10 * frame])
                write_frame(folder / "frames" / f"{label}_{frame:06}.vtu", label, frame)
    with open(folder / "bones.csv", "w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["frame", "time_s", "bone", "parent", *(f"{end}_{axis}_m" for end in ("head", "tail") for axis in "xyz")])
        for frame in range(frames):
            for bone, at in (("upper", 0), ("forearm", 1)):
                table.writerow([frame, frame / 100, bone, "", at, 0, frame, at + 1, 0, frame])
