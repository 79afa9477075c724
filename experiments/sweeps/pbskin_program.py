"""Where pbskin is, unless --pbskin tells: built in this checkout, installed beside these scripts, or on the PATH."""
import pathlib
import shutil

HERE = pathlib.Path(__file__).resolve().parent


def found(here=HERE):
    """Of an installation these scripts are PREFIX/share/pbskin/sweeps, of a checkout experiments/sweeps."""
    installed = here.parent.name == "pbskin" and here.parents[1].name == "share"
    place = here.parents[2] / "bin/pbskin" if installed else here.parents[1] / "build/release/bin/pbskin"
    return place if place.is_file() else pathlib.Path(shutil.which("pbskin") or place)
