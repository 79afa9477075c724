"""Each body's jiggling zone, its response to a jolt at each setting, and how far it lags in a walk."""
import pages
import records


def of_jolts(folder):
    zone = records.table(folder / "zone.csv", {"share_of_vertices", "share_on_skin", "pieces", "bone", "share_of_zone"})
    text = (f"The zone is {100 * float(zone[0]['share_of_vertices']):.0f} % of the vertices, {100 * float(zone[0]['share_on_skin']):.0f} % "
            f"of it skin, in {zone[0]['pieces']} pieces: "
            + ", ".join(f"{row['bone']} {100 * float(row['share_of_zone']):.0f} %" for row in zone[:5]) + ".\n\n")
    return text + pages.table(records.table(folder / "responses.csv", {"deformer", "outcome", "frequency_hz"}), {
        **pages.own_names("deformer k_stretch"), "step [ms]": ("time_step_ms", "g"), **pages.own_names("iterations masses k_bind outcome"),
        "frequency [Hz]": ("frequency_hz", 2), "damping ratio": ("damping_ratio", 3),
        "overshoot / jolt": ("overshoot_over_jolt", 2), "left / peak": ("left_over_peak", 3)})


def of_walk(folder):
    return pages.table(records.table(folder / "walk.csv", {"k_stretch", "moving_lag_rms_mm"}), {
        "k_stretch": "k_stretch", "lag, rms [mm]": ("moving_lag_rms_mm", 2), "most [mm]": ("most_lag_rms_mm", 2),
        "share of speed left after 1 s": ("last_speed_share", 4)})


def page(folder):
    written = {file.parent: of for name, of in (("responses.csv", of_jolts), ("walk.csv", of_walk)) for file in pages.files(folder, name)}
    return "# Jiggle\n" + "".join(f"\n## {run.name}\n\n" + of(run) for run, of in written.items())
