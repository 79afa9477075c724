"""A substitute for pbskin that a sweep starts, with known metrics. As a program: `run SCENE --quiet -o DIR --set
k=v...`; pbs.iterations determines the metrics (100: refused, 101: a breakdown), and every start appends a line to the
file that STARTS names."""
import json
import os
import pathlib
import sys

COLUMNS = ("scene,deformer,variant,order,precision,iterations,threads,frame,time_s,volume_change_pct,bind_rms_m,"
           "step_ms,outcome")


def write(folder, iterations, step_ms=1.0, status=0, volumes=(0.1, 0.2, 0.6)):
    """Records of a run of deformers lbs and pbs, with volumes times the iterations; step_ms and memory differ from run
    to run."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    lines = [COLUMNS]
    for frame, volume in enumerate(volumes):
        for deformer in ("lbs", "pbs"):
            value = volume * iterations if deformer == "pbs" else -volume
            lines.append(f"s,{deformer},default,ordered,f32,{iterations},1,{frame},{frame / 100},{value!r},,"
                         f"{step_ms + frame},finished")
    (folder / "metrics.csv").write_text("\n".join(lines) + "\n")
    runs = [{"name": name, "label": name, "variant": "default", "kind": name} for name in ("lbs", "pbs")]
    failed = {"breakdown": "pbs ceased to be finite", "breakdowns": {"pbs": [1, 2]}, "not_converged": {},
              "broken_frames": {"pbs": [{"frame": 1, "what": "inverted"}]}}
    sound = {"breakdown": "", "breakdowns": {}, "not_converged": {}, "broken_frames": {}}
    record = {"scene": {"runs": runs}, "state_hash": {"lbs": "aa", "pbs": f"{iterations:04d}"},
              "cost": {"peak_memory_mb": 10 * step_ms, "seconds": {"total": step_ms},
                       "cpu_seconds": {"total": step_ms}},
              "outcome": failed if status == 3 else sound,
              "provenance": {"git_revision": "abc", "threads": 1}}
    (folder / "run.json").write_text(json.dumps(record))


def main(arguments):
    folder = arguments[arguments.index("-o") + 1]
    iterations = next(int(part.split("=")[1]) for part in arguments if part.startswith("pbs.iterations="))
    with open(os.environ["STARTS"], "a", encoding="utf-8") as file:
        file.write(f"{iterations}\n")
    if iterations == 100:
        print("pbskin: --set: pbs.iterations = 100: refused", file=sys.stderr)
        return 2
    status = 3 if iterations == 101 else 0
    write(folder, iterations, status=status)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
