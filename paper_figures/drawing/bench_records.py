"""The timings of `pbskin bench` (DIR/timing/bench/bench.json), for the figures that show them."""
import records
from drawing import style

schema = 2  # `memory` in place of `copy`

# The colour and line style of each order.
orders = {"plain": (style.vermillion, (0, (4, 1.5))), "plain_native": (style.orange, (0, (2, 1))),
          "plain_spread": (style.black, (0, (1, 1))),
          "ordered": (style.blue, "-"), "grouped": (style.green, (0, (5, 1.2, 1, 1.2))), "poses": (style.purple, (0, (4, 1, 1, 1, 1, 1)))}
markers = {"plain": "v", "plain_native": "s", "plain_spread": "x", "ordered": "o", "grouped": "^", "poses": "D"}
names = {"plain": "plain", "plain_native": "plain, native build", "plain_spread": "plain, native, spread", "ordered": "ordered",
         "grouped": "grouped", "poses": "16 poses, each"}


def read(results):
    file = results / "timing" / "bench" / "bench.json"
    record = records.read_json(file)
    if record.get("schema") != schema:
        raise records.RecordsMissing(f"{file}: schema {record.get('schema')}, expected {schema}; repeat "
                                     "`pbskin reproduce timing --full --only bench`")
    for key in ("context", "meshes"):
        if key not in record:
            raise records.RecordsMissing(f"{file}: no {key}")
    return record


def timings(mesh):
    """The timings of the orders and of the reference operations."""
    return mesh["results"] + mesh.get("yardsticks", [])


def constraints(mesh):
    return mesh["mesh"]["vertices"] + mesh["mesh"]["edges"] + mesh["mesh"]["tets"]
