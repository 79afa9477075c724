#!/usr/bin/env python3
"""Solves the problems of experiments/studies/verification/calculix.cpp with CalculiX and keeps its displacements, with
which the study `verification` compares the reference at every node. It needs `ccx` (Debian: calculix-ccx) and takes
some minutes.

    python3 experiments/references/keep_calculix.py

Each problem is set up here from its definition: the tets of the cantilever, the tets that the limb's bones hold, the
springs of the smooth attachment, the search for their points and the shape functions share no code with the program.
The tets of the limb are the kept ones. calculix/NAME.f64 has three displacements [m] per node, in double: of the
vertices and, with quadratic elements, of the middles of the edges, sorted by the vertices at their ends.
calculix/answers.csv states for each problem the number of nodes, the version of CalculiX, the SHA-256 of its deck and
the hash of the file.
"""
import csv
import dataclasses
import functools
import hashlib
import itertools
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
from keep_tets import KEPT as TETS, content_hash
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

KEPT = pathlib.Path(__file__).resolve().parent / "calculix"
YOUNG_PA, POISSON = 1e5, 0.3
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))  # of the middle nodes of C3D10
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER",
                                     "NUMBER_OF_CPUS")}
# Orders of the elements, vertices, how the bones hold the flesh, the motion of the forearm [deg], whether strains are
# large.
LIMBS = (
    ((1, 2), 1775, "held", "bent", 10, False),
    ((1, 2), 1775, "held", "bent", 90, False),
    ((1, 2), 1775, "held", "twisted", 90, False),
    ((1, 2), 1775, "held", "bent", 30, True),
    ((1,), 1775, "held", "twisted", 30, True),
    ((2,), 600, "held", "bent", 30, True),
    ((1, 2), 400, "smooth", "bent", 10, False),
    ((1, 2), 400, "smooth", "bent", 30, True),
    ((1, 2), 400, "smooth", "twisted", 30, True),
)


@dataclasses.dataclass
class Problem:
    nodes: np.ndarray  # at rest [m], #N x 3
    tets: np.ndarray  # #T x 4, or #T x 10 with the middles of EDGES after the corners
    held: np.ndarray = None  # numbers of nodes
    held_at: np.ndarray = None  # their displacements [m]
    forces: np.ndarray = None  # [N], #N x 3
    gravity: np.ndarray = None  # [N/kg]; the density is 1000 kg/m3
    # X_s at rest and t_s [m], #S x 3, and k_s [N/m], #S: springs with the energy sum_s k_s / 2 |X_s + u(X_s) - t_s|^2
    springs: tuple = None
    is_large: bool = False  # large strain: the law of St Venant and Kirchhoff
    residual: float = 1e-9  # at which Newton's method stops at large strain, relative to the mean force


# The meshes.

def box(size, divisions):
    """Cells that are split into six tets about one diagonal (Kuhn): a tet is a way from the lowest corner to the
    highest one."""
    nx, ny, nz = divisions
    grid = np.array(list(itertools.product(range(nz + 1), range(ny + 1), range(nx + 1))))[:, ::-1]
    strides = np.array([1, nx + 1, (nx + 1) * (ny + 1)])
    lowest = grid[(grid < divisions).all(axis=1)] @ strides
    tets = []
    for way in itertools.permutations(range(3)):
        corners = np.cumsum([np.zeros_like(lowest), *(np.full_like(lowest, strides[axis]) for axis in way)],
                            axis=0) + lowest
        is_odd = way in ((0, 2, 1), (1, 0, 2), (2, 1, 0))
        tets.append(corners[[0, 1, 3, 2] if is_odd else [0, 1, 2, 3]].T)
    return grid / divisions * size, np.concatenate(tets)


def limb(vertices):
    reader = vtkXMLUnstructuredGridReader()
    file, = TETS.glob(f"limb-{vertices}-*.vtu")
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float), vtk_to_numpy(
        grid.GetCells().GetConnectivityArray()).reshape(-1, 4)


def with_middles(nodes, tets):
    ends = np.sort(tets[:, EDGES], axis=2)
    edges, numbers = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    return np.concatenate([nodes, nodes[edges].mean(axis=1)]), np.hstack([tets, len(nodes) + numbers.reshape(-1, 6)])


# The problems.

def cantilever(order):
    """A bar under its weight, whose nodes at the one end are held and at the other end share a force."""
    nodes, tets = box((10.0, 1.0, 1.0), (48, 6, 6))
    if order == 2:
        nodes, tets = with_middles(nodes, tets)
    held, loaded = np.flatnonzero(nodes[:, 0] == 0.0), np.flatnonzero(nodes[:, 0] == 10.0)
    forces = np.zeros_like(nodes)
    forces[loaded] = np.array([0.3, 0.0, -0.5]) / len(loaded)
    return Problem(nodes, tets, held, np.zeros((len(held), 3)), forces, np.array([0.0, 1e-3, -1e-2]))


def turn(axis, degrees):
    """Rotates about x or z."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]] if axis == "x" else [[c, -s, 0], [s, c, 0], [0, 0, 1]])


def bones(nodes, tets, core_radius):
    """Per bone of the limb, which lies along x and has its joint at 0: both ends of the cylinder by which it holds the
    flesh, the middle two thirds of it, and its radius, core_radius times the mean distance of the skin there."""
    faces = np.sort(tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1)
    faces, counts = np.unique(faces, axis=0, return_counts=True)
    skin = nodes[np.unique(faces[counts == 1])]
    for head in (-1.0, 0.0):
        start, end = head + 1.0 / 6.0, head + 5.0 / 6.0
        on_middle = skin[(skin[:, 0] >= start) & (skin[:, 0] <= end)]
        yield start, end, core_radius * np.hypot(on_middle[:, 1], on_middle[:, 2]).mean()


def held_by_tets(nodes, tets, motions):
    """The nodes of whole tets in the cylinders, and their displacements: a middle of an edge is halfway between its
    ends."""
    corners, held, held_at = tets[:, :4], [], []
    for (start, end, radius), motion in zip(bones(nodes, corners, 0.6), motions):
        inside = (nodes[:, 0] >= start) & (nodes[:, 0] <= end) & (np.hypot(nodes[:, 1], nodes[:, 2]) <= radius)
        held.append(np.unique(tets[inside[corners].all(axis=1)]))
        held_at.append(nodes[held[-1]] @ (motion - np.eye(3)).T)
    return np.concatenate(held), np.concatenate(held_at)


def smooth_springs(nodes, tets, motions):
    """40 discs along each bone, each with its centre and 24 points on each of 8 rings. The density of the springs is 10
    E / R^2 on the axis and decreases by (1 - s^2)^2 across the bone and by the step 3 t^2 - 2 t^3 over one radius at
    its ends."""
    n, angle = np.repeat(np.arange(8), 24), np.tile(2.0 * np.pi * np.arange(24) / 24.0, 8)
    s = np.concatenate([[0.0], np.sqrt((1.0 + 24.0 * (n + 0.5)) / 193.0)])
    disc = s[:, None] * np.concatenate([[[1.0, 0.0]], np.column_stack([np.cos(angle), np.sin(angle)])])
    points, targets, stiffness = [], [], []
    for (start, end, radius), motion in zip(bones(nodes, tets, 0.7), motions):
        along = (np.arange(40) + 0.5) / 40.0 * (end - start)
        t = np.minimum(1.0, np.minimum(along, end - start - along) / min(radius, (end - start) / 2.0))
        density = np.outer((3.0 - 2.0 * t) * t * t, (1.0 - s * s) ** 2)
        points.append(np.column_stack([np.repeat(start + along, 193), np.tile(radius * disc, (40, 1))]))
        targets.append(points[-1] @ motion.T)
        stiffness.append(10.0 * YOUNG_PA * np.pi * (end - start) / (40 * 193) * density.ravel())
    return tuple(map(np.concatenate, (points, targets, stiffness)))


def posed_limb(order, vertices, motion, is_smooth, is_large):
    vertices, corners = limb(vertices)
    nodes, tets = (vertices, corners) if order == 1 else with_middles(vertices, corners)
    motions = (np.eye(3), motion)
    if is_smooth:
        return Problem(nodes, tets, springs=smooth_springs(vertices, corners, motions), is_large=is_large,
                       residual=1e-12)
    return Problem(nodes, tets, *held_by_tets(nodes, tets, motions), is_large=is_large)


def problems():
    """Functions that make the problems, by name."""
    made = {f"cantilever_p{order}": lambda order=order: cantilever(order) for order in (1, 2)}
    turns = {"bent": "z", "twisted": "x"}
    for orders, vertices, attachment, way, degrees, is_large in LIMBS:
        for order in orders:
            made[f"limb_{vertices}_{attachment}_{way}_by_{degrees}_p{order}"] = functools.partial(
                posed_limb, order, vertices, turn(turns[way], degrees), attachment == "smooth", is_large)
    return made


# The springs of each tet as a few springs to ground.

def shape_functions(barycentric, nodes_per_tet):
    if nodes_per_tet == 4:
        return barycentric
    middles = [4.0 * barycentric[:, i] * barycentric[:, j] for i, j in EDGES]
    return np.hstack([barycentric * (2.0 * barycentric - 1.0), np.column_stack(middles)])


def located(nodes, tets, points):
    """The tet in which each point lies deepest, and its barycentric coordinates there."""
    corners = np.concatenate([np.ones((len(tets), 1, 4)), np.swapaxes(nodes[tets[:, :4]], 1, 2)], axis=1)
    every = np.einsum("tij,pj->pti", np.linalg.inv(corners), np.column_stack([np.ones(len(points)), points]))
    deepest = every.min(axis=2).argmax(axis=1)
    return deepest, every[np.arange(len(points)), deepest]


def springs_to_ground(problem):
    """With the shape functions N of a tet, its springs have the energy u^T Q u / 2 - f^T u except for a constant, Q =
    sum_s k_s N N^T and f = sum_s k_s N (t_s - X_s). Each eigenvector v of Q is one spring, whose end moves by
    sqrt(lambda / k) v . u; k is the largest eigenvalue of all tets. Returns k, the tet and the coefficients of each
    spring, and the dead load f, #N x 3."""
    points, targets, stiffness = problem.springs
    width = problem.tets.shape[1]
    parts = [located(problem.nodes, problem.tets, part) for part in np.array_split(points, 40)]
    tet, barycentric = map(np.concatenate, zip(*parts))
    if barycentric.min() < -1e-10:  # a point on a face may be outside by rounding
        sys.exit("keep_calculix: a spring lies outside the tets")
    shapes = shape_functions(barycentric, width)
    Q = np.zeros((len(problem.tets), width, width))
    np.add.at(Q, tet, stiffness[:, None, None] * shapes[:, :, None] * shapes[:, None, :])
    load = np.zeros_like(problem.nodes)
    np.add.at(load, problem.tets[tet], (stiffness[:, None] * shapes)[:, :, None] * (targets - points)[:, None, :])
    value, vector = np.linalg.eigh(Q)
    k = value.max()
    spring_tet, m = np.nonzero(value > np.finfo(float).eps * k)
    return k, spring_tet, np.sqrt(value[spring_tet, m] / k)[:, None] * vector[spring_tet, :, m], load


# The deck: the cards of CalculiX's manual (G. Dhondt, CalculiX CrunchiX User's Manual, version 2.20).

def number(value):
    """The nearest number with at most 20 characters, because CalculiX cuts what is longer."""
    value = float(value)
    texts = [repr(value), *(f"{value:.{digits}{form}}" for form in "ef" for digits in range(17, 11, -1))]
    return min((text for text in texts if len(text) <= 20), key=lambda text: abs(float(text) - value))


def line(*fields):
    return ", ".join(number(field) if isinstance(field, float) else str(field) for field in fields)


def spring_cards(problem, k, tets, coefficients):
    first, springs = len(problem.nodes) + 1, range(len(tets))
    yield from ("*NODE, NSET=ENDS", *(line(first + m, 0, 0, 0) for m in springs))
    for axis in (1, 2, 3):
        number_of_first = len(problem.tets) + (axis - 1) * len(tets) + 1
        yield from (f"*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS{axis}",
                    *(line(number_of_first + m, first + m) for m in springs))
        yield from (f"*SPRING, ELSET=SPRINGS{axis}", str(axis), number(k))
    for m, axis in itertools.product(springs, (1, 2, 3)):
        terms = [line(first + m, axis, 1)]
        terms += [line(node + 1, axis, -float(c)) for node, c in zip(problem.tets[tets[m]], coefficients[m])]
        yield from ("*EQUATION", str(len(terms)), *(", ".join(terms[i:i + 4]) for i in range(0, len(terms), 4)))


def cards(problem):
    yield from ("*NODE, NSET=NODES", *(line(n + 1, *map(float, node)) for n, node in enumerate(problem.nodes)))
    kind = "C3D4" if problem.tets.shape[1] == 4 else "C3D10"
    yield from (f"*ELEMENT, TYPE={kind}, ELSET=TETS", *(line(t + 1, *(tet + 1)) for t, tet in enumerate(problem.tets)))
    yield from ("*MATERIAL, NAME=FLESH", "*ELASTIC", line(YOUNG_PA, POISSON), "*DENSITY", "1000")
    yield "*SOLID SECTION, ELSET=TETS, MATERIAL=FLESH"
    forces = problem.forces
    if problem.springs:
        *few, forces = springs_to_ground(problem)
        yield from spring_cards(problem, *few)
    yield from ("*STEP, NLGEOM, INC=10000" if problem.is_large else "*STEP", "*STATIC")
    if problem.is_large:
        yield from ("0.1, 1.", "*CONTROLS, PARAMETERS=FIELD", line(problem.residual, 1e-9))
    if problem.held is not None:
        yield "*BOUNDARY"
        for node, at in zip(problem.held, problem.held_at):
            yield from (line(node + 1, axis + 1, axis + 1, float(at[axis])) for axis in range(3))
    if problem.gravity is not None:
        size = float(np.linalg.norm(problem.gravity))
        yield from ("*DLOAD", line("TETS", "GRAV", size, *map(float, problem.gravity / size)))
    if forces is not None:
        yield "*CLOAD"
        yield from (line(n + 1, axis + 1, float(forces[n, axis])) for n, axis in np.argwhere(forces != 0.0))
    yield from ("*RESTART, WRITE", "*NODE PRINT, NSET=NODES, FREQUENCY=100000", "U", "*END STEP")


# CalculiX's files.

def displacements(folder, nodes):
    """CalculiX prints 7 digits. Its restart file holds all, in one of Fortran's records of raw memory, which stand
    between their lengths. The record is recognised: it agrees with every printed number to the last digit."""
    printed = [text.split() for text in (folder / "deck.dat").read_text().splitlines()]
    printed = np.array([list(map(float, words)) for words in printed if len(words) == 4])
    if not np.array_equal(printed[:, 0], np.arange(nodes) + 1):
        sys.exit(f"keep_calculix: {folder}/deck.dat: expected a line for every node")
    restart = (folder / "deck.rout").read_bytes()
    at = 0
    while at < len(restart):
        length = int.from_bytes(restart[at:at + 4], "little", signed=True)
        if length < 0:
            break
        record = restart[at + 4:at + 4 + length]
        if length % 32 == 0 and length >= 32 * nodes:  # per node a temperature and three displacements
            found = np.frombuffer(record).reshape(-1, 4)[:nodes, 1:]
            if (np.abs(found - printed[:, 1:]) <= 5.01e-7 * np.abs(printed[:, 1:])).all():
                return found
        at += length + 8
    sys.exit(f"keep_calculix: {folder}/deck.rout: expected a record that agrees with deck.dat")


def run(problem):
    """The row of a problem except for its name, and the displacements as bytes."""
    environment = os.environ | ONE_THREAD
    deck = "\n".join(cards(problem)) + "\n"
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "deck.inp").write_text(deck, encoding="ascii")
        version = subprocess.run(["ccx", "-v"], cwd=folder, env=environment, capture_output=True, text=True,
                                 check=False).stdout
        done = subprocess.run(["ccx", "-i", "deck"], cwd=folder, env=environment, capture_output=True, text=True,
                              check=False)
        if done.returncode != 0 or "*ERROR" in done.stdout:
            sys.exit(f"keep_calculix: ccx ended with status {done.returncode}: {done.stdout[-400:]}")
        content = displacements(folder, len(problem.nodes)).astype("<f8").tobytes()
    program = "CalculiX " + re.search(r"Version\s+([\w.]+)", version)[1]
    return (len(problem.nodes), program, hashlib.sha256(deck.encode()).hexdigest(), content_hash(content)), content


def main():
    KEPT.mkdir(exist_ok=True)
    with (KEPT / "answers.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("problem", "nodes", "program", "deck_sha256", "content_hash"))
        for name, make in problems().items():
            row, content = run(make())
            writer.writerow((name, *row))
            (KEPT / f"{name}.f64").write_bytes(content)
            print(name, *row, flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    main()
