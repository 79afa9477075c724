"""A solver that shares nothing with the program which wrote the references: linear tets, Newton's method, no contact.

    python3 own_solver.py FOLDER POSE MEMBER FRAME.vtu
    python3 own_solver.py kit limb_twist_60 smooth mine.vtu
    pbskin measure kit/bodies/limb.vtu mine.vtu --reference kit/limb_twist_60/smooth.vtu

FOLDER is what `pbskin references export -o FOLDER` wrote; its README.md states the problem. The error must be the
member's linear_distance_pct where no skin touches. This takes some ten seconds."""
import os
import pathlib
import sys
import tomllib
import xml.etree.ElementTree as xml

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # OpenBLAS's idle threads would keep the processors busy
import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

# 1. The body, the pose and the member.
folder, pose_name, member_name, frame = pathlib.Path(sys.argv[1]), *sys.argv[2:]
pose = tomllib.loads((folder / pose_name / "pose.toml").read_text())
member = next(one for one in pose["member"] if one["name"] == member_name)
joints = tomllib.loads((folder / pose_name / pose["skeleton"]).read_text())["joint"]
names = [joint["name"] for joint in joints]
transforms = [np.array([*one["transform"], [0, 0, 0, 1]]) for one in pose["bone"]]
body = xml.parse(folder / pose_name / pose["tets"])
array = {node.get("Name"): np.array(node.text.split(), float) for node in body.iter("DataArray")}
rest, tets = array["points"].reshape(-1, 3), array["connectivity"].astype(int).reshape(-1, 4)
mu, lam, young = member["mu_pa"], member["lambda_pa"], member["young_pa"]

# 2. Gradients of the four shape functions of each tet, its volume, and the springs K of each tet and bone.
edges = np.swapaxes(rest[tets[:, 1:]] - rest[tets[:, :1]], 1, 2)
volume = np.linalg.det(edges) / 6
shape = np.linalg.inv(edges)
shape = np.concatenate([-shape.sum(1, keepdims=True), shape], 1)
rows = np.loadtxt(folder / pose_name / member["springs"], delimiter=",", skiprows=1)
held, bone = tets[rows[:, 0].astype(int)], rows[:, 1].astype(int)
K = np.empty((len(rows), 4, 4))
first, second = np.triu_indices(4)
K[:, first, second] = K[:, second, first] = young * rows[:, 2:]


def targets(share):
    """The held corners, moved by bones on their way to the pose (share 1): each turns about its head, relative to its
    parent."""
    moved = []
    for joint, transform in zip(joints, transforms):
        parent = names.index(joint["parent"]) if joint["parent"] else None
        relative = transform if parent is None else np.linalg.inv(transforms[parent]) @ transform
        turn = Rotation.from_rotvec(share * Rotation.from_matrix(relative[:3, :3]).as_rotvec()).as_matrix()
        head = np.array(joint["head_m"])
        shift = share * (relative[:3, :3] @ head + relative[:3, 3] - head)
        motion = np.block([[turn, (head + shift - turn @ head)[:, None]], [np.eye(4)[3:]]])
        moved.append(motion if parent is None else moved[parent] @ motion)
    moved = np.array(moved)[bone]
    return np.einsum("rij,raj->rai", moved[:, :3, :3], rest[held]) + moved[:, None, :3, 3]


def energy(x, target):
    F = np.einsum("tai,taj->tij", x[tets], shape)
    J = np.linalg.det(F)
    if J.min() <= 0:
        return np.inf
    log, pull = np.log(J), x[held] - target
    flesh = mu / 2 * ((F ** 2).sum((1, 2)) - 3) - mu * log + lam / 2 * log ** 2
    return volume @ flesh + np.einsum("rab,rai,rbi->", K, pull, pull) / 2


def newton_step(x, target, is_projected):
    """The step, and the slope of the energy along it. The Hessian of each tet may be projected to be positive
    semi-definite."""
    F = np.einsum("tai,taj->tij", x[tets], shape)
    inverse, log = np.linalg.inv(F), np.log(np.linalg.det(F))
    P = mu * F + (lam * log - mu)[:, None, None] * np.swapaxes(inverse, 1, 2)
    H = np.einsum("t,tjk,tli->tijkl", mu - lam * log, inverse,
                  inverse) + lam * np.einsum("tji,tlk->tijkl", inverse, inverse)
    H = H.reshape(-1, 9, 9) + mu * np.eye(9)
    if is_projected:
        value, vector = np.linalg.eigh(H)
        H = vector * np.maximum(value, 0)[:, None] @ np.swapaxes(vector, 1, 2)
    H = np.einsum("t,tijkl,taj,tbl->taibk", volume, H.reshape(-1, 3, 3, 3, 3), shape, shape, optimize=True)
    gradient = np.zeros_like(x)
    np.add.at(gradient, tets, np.einsum("t,tij,taj->tai", volume, P, shape))
    np.add.at(gradient, held, np.einsum("rab,rbi->rai", K, x[held] - target))
    blocks = [(H, tets), (np.einsum("rab,ik->raibk", K, np.eye(3)), held)]
    dofs = [(3 * corners[:, :, None] + np.arange(3)).reshape(-1, 12) for _, corners in blocks]
    row = np.concatenate([np.repeat(of, 12, 1).ravel() for of in dofs])
    column = np.concatenate([np.tile(of, (1, 12)).ravel() for of in dofs])
    matrix = sparse.csc_matrix((np.concatenate([block.ravel() for block, _ in blocks]), (row, column)),
                               shape=(x.size, x.size))
    step = splu(matrix, permc_spec="MMD_AT_PLUS_A",
                options={"SymmetricMode": True}).solve(-gradient.ravel()).reshape(x.shape)
    return step, (gradient * step).sum()


# 3. The bones go to the pose in stages of at most 15 degrees; Newton's method with a line search follows them.
x = rest.copy()
largest_turn = max(Rotation.from_matrix(transform[:3, :3]).magnitude() for transform in transforms)
stages = max(1, int(np.ceil(np.degrees(largest_turn) / 15)))
for stage in range(1, stages + 1):
    target = targets(stage / stages)
    tolerance_m = 1e-7 if stage == stages else 1e-3  # the stages before the last one give it an initial state
    for iteration in range(200):
        step, slope = newton_step(x, target, False)
        if slope >= 0:
            step, slope = newton_step(x, target, True)
        before, length = energy(x, target), 1.0
        while energy(x + length * step, target) > before + 1e-4 * length * slope and length > 1e-10:
            length /= 2
        x += length * step
        if np.abs(step).max() < tolerance_m:
            break
    print(f"stage {stage} of {stages}: {iteration + 1} steps, energy {energy(x, target):.6f} J", flush=True)

# 4. The file of the body with these points.
points = next(node for node in body.iter("DataArray") if node.get("Name") == "points")
points.text = "\n".join(" ".join(map(repr, map(float, point))) for point in x)
body.write(frame)
